"""The life of a program, row by row: each of these again and again, on one core and under load.

    python tests/life/rows.py              the rows
    python tests/life/rows.py ROW [TIMES]  the tests of a row, 20 times; `all` for every row

Rules: all of it, with a busy loop of another program beside, runs on a single processor. The first
run that fails ends it, with what it said.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Final

TESTS: Final = Path(__file__).parents[1]
sys.path.insert(0, str(TESTS))

from support.busy import LOOP  # noqa: E402

#: What the tests of a row are, as pytest takes them.
ROWS: Final = {
    "interrupted-read": ["life/test_interrupting.py", "life/test_reading.py"],
    "end-of-program": ["life/test_program_end.py"],
    "sigterm": ["life/test_program_end.py", "test_linger.py"],
    "close-in-a-handler": ["life/test_sending.py", "life/test_signals.py"],
    "callbacks": ["life/test_callbacks.py", "life/test_aio_callbacks.py"],
    "interrupt-and-close": ["life/test_closing.py", "life/test_calls.py", "-k", "end or close"],
    "time-limits": ["life/test_time_limits.py"],
    "one-client-two-threads": ["life/test_calls.py", "-k", "question"],
    "exception-of-a-server": ["life/test_calls.py", "-k", "exception"],
    "asyncio": ["life/test_asyncio.py"],
    "stopped-reader": ["life/test_closing.py", "port/test_buffered.py", "-k", "takes or slow"],
    "spinning": ["life/test_reading.py", "-k", "spinning"],
    "busy-writer": ["port/test_buffered.py", "-k", "writer"],
    "one-name-twice": ["life/test_names.py"],
}


def run(row: str, times: int) -> int:
    """Run the tests of a row; the exit code of the first run that fails, or 0."""
    paths = [str(TESTS / one) if one.endswith(".py") else one for one in ROWS[row]]
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:xdist", "-p", "no:cacheprovider"]
    started = time.monotonic()
    for number in range(1, times + 1):
        done = subprocess.run([*command, *paths], capture_output=True, text=True, cwd=TESTS.parent)
        if done.returncode:
            print(f"{row}: run {number} of {times} fails\n{done.stdout}{done.stderr}", flush=True)
            return done.returncode
    print(f"{row}: {times} runs, {time.monotonic() - started:.0f} s", flush=True)
    return 0


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("row", nargs="?", choices=[*ROWS, "all"])
    parser.add_argument("times", nargs="?", type=int, default=20)
    options = parser.parse_args()
    if options.row is None:
        print("\n".join(ROWS))
        return 0
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})  # children have it, too
    busy = subprocess.Popen([sys.executable, "-c", LOOP, str(os.getpid())])
    try:
        rows = [*ROWS] if options.row == "all" else [options.row]
        return max(run(row, options.times) for row in rows)
    finally:
        busy.kill()
        busy.wait()


if __name__ == "__main__":
    sys.exit(main())
