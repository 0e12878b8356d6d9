"""Devices of C++ YARP and ours, each with the client of the other: how long a call takes.

    YARPY_CPP_YARP=/opt/yarp python bench/device_peers.py [--calls 1000] [--seconds 2] [--rounds 3]
        [--only IBattery ...] [--write]

For every interface that has a server, a client and a simulated device in C++ 3.9 or 4.0: the median
time of a call from a client of C++ to our server, from our client to a server of C++, and from C++
to C++ as the yardstick; and how often and how late values stream in. The three take turns, and the
least disturbed round counts. `--write` keeps the figures in `device_peers.json`, of which
tests/support/device_times.py makes the table in docs/devices.md.

Rules: nothing here says how fast is fast enough. A pair that is not there says why.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import platform
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "tests"))

import pytest  # noqa: E402
from device_rows import BOTH, ROWS, Row  # noqa: E402
from support.cpp import CppYarp  # noqa: E402
from support.cpp_device import DEVICES, cpp_device  # noqa: E402
from support.cpp_link import linked  # noqa: E402
from support.process import Process  # noqa: E402

import yarpy  # noqa: E402

KEPT = HERE / "device_peers.json"
PAIRS = ("C++ to C++", "C++ to yarpy", "yarpy to C++")
LIBRARIES = ["YARP_dev", "YARP_sig", "YARP_math", "YARP_os", "YARP_init"]

#: What one pair said: microseconds of a call; values a second and their age in microseconds.
Figures = dict[str, float]


class Bench:
    """One C++ YARP with a name server, and how much is asked of it."""

    def __init__(self, cpp: CppYarp, calls: int, seconds: float) -> None:
        self._cpp, self._calls, self._seconds = cpp, calls, seconds
        source = (HERE / "device_client.cpp").read_text(encoding="utf-8")
        self._client = linked(cpp, "device-client", source, DEVICES, LIBRARIES)

    @contextlib.contextmanager
    def _served(self, row: Row, by_cpp: bool) -> Iterator[None]:
        if not by_cpp:
            with row.ours():
                yield
            return
        device, given = row.server
        newer = self._cpp.version >= (4, 0)
        options = {
            name: value[newer] if isinstance(value, tuple) else value
            for name, value in given.items()
        }
        with cpp_device(self._cpp, device, **options) as process:
            if "not available" in process.stdout + process.stderr:
                raise RuntimeError(f"C++ does not open {device}: {process.stderr[-300:]}")
            yield

    def figures(self, row: Row, pair: str) -> Figures:
        """Measure one row of one pair once."""
        asks, _, serves = pair.partition(" to ")
        with row.beside(), self._served(row, serves == "C++"):
            return self._asked_by_cpp(row) if asks == "C++" else self._asked_by_us(row)

    def _asked_by_cpp(self, row: Row) -> Figures:
        words = [str(self._client), "--ask", row.name, "--calls", str(self._calls)]
        words += ["--seconds", str(self._seconds)]
        for name, value in row.client(self._cpp.version).items():
            words += [f"--{name}", str(value)]
        found: Figures = {}
        with Process(words, env=self._cpp.environment, cwd=self._cpp.home) as process:
            end = process.wait_line("^(done|refused|not available)", timeout=60)
            if end[1] != "done":
                raise RuntimeError(f"{end[1]}: {process.stderr[-300:]}")
            for line in process.stdout.splitlines():
                match line.split():
                    case ["call", took]:
                        found["call"] = float(took)
                    case ["stream", rate, age]:
                        found |= {"rate": float(rate), "age": float(age)}
        return found

    def _asked_by_us(self, row: Row) -> Figures:
        found: Figures = {}
        with row.connect() as client:
            time.sleep(1.0)
            if row.ask is not None:
                row.ask(client)  # its first call learns of whom it asks
                took = []
                for _ in range(self._calls):
                    begin = time.perf_counter()
                    row.ask(client)
                    took.append(time.perf_counter() - begin)
                found["call"] = statistics.median(took) * 1e6
            if row.seen is not None:
                found |= self._streamed(row.seen, client)
        return found

    def _streamed(self, seen: Callable[[Any], float], client: Any) -> Figures:
        ages: list[float] = []
        arrivals: list[float] = []
        last = seen(client)
        end = time.monotonic() + self._seconds
        while time.monotonic() < end:
            when = seen(client)
            if when != last:
                last = when
                arrivals.append(time.monotonic())
                ages.append(time.time() - when)
            time.sleep(0.0002)
        if len(ages) < 3:
            return {}  # it does not say when
        rate = (len(ages) - 1) / (arrivals[-1] - arrivals[0])
        return {"rate": rate, "age": statistics.median(ages) * 1e6}


def least(rounds: list[Figures]) -> Figures:
    """The least disturbed of some rounds: the shortest call, the most and youngest values."""
    found: Figures = {}
    if any("call" in each for each in rounds):
        found["call"] = round(min(each["call"] for each in rounds), 1)
    if streamed := [each for each in rounds if "age" in each]:
        found["rate"] = round(max(each["rate"] for each in streamed), 1)
        found["age"] = round(min(each["age"] for each in streamed), 1)
    return found


def main() -> None:
    """Measure, print, and keep the figures if wanted."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--calls", type=int, default=1000)
    parser.add_argument("--seconds", type=float, default=2.0)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--only", nargs="*", default=[])
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    measured: dict[str, Any] = {}
    with tempfile.TemporaryDirectory() as home, CppYarp.prepare(Path(home)).server() as cpp:
        os.environ["YARP_CONFIG_HOME"] = cpp.environment["YARP_CONFIG_HOME"]
        version = cpp.run("version").stdout.split()[-1].partition("~")[0]
        if cpp.version not in BOTH:
            sys.exit(f"C++ YARP {version} is not 3.9 or 4.0: name one of them in YARPY_CPP_YARP")
        bench = Bench(cpp, options.calls, options.seconds)
        for row in ROWS:
            if options.only and row.interface not in options.only:
                continue
            if cpp.version not in row.versions:
                continue
            rounds: dict[str, list[Figures]] = {pair: [] for pair in PAIRS}
            try:
                for _ in range(options.rounds):
                    for pair in PAIRS:
                        rounds[pair].append(bench.figures(row, pair))
            except (RuntimeError, AssertionError, yarpy.YarpError, pytest.skip.Exception) as error:
                print(f"{row.interface}: {pair}: {type(error).__name__} {error}", flush=True)
                continue
            found = {pair: least(each) for pair, each in rounds.items()}
            asked = {"function": row.function, "streams": row.streams}
            measured[row.interface] = {**asked, **found}
            print(f"{version} {row.interface}: {found}", flush=True)
    if options.write:
        kept = json.loads(KEPT.read_text(encoding="utf-8")) if KEPT.exists() else {}
        before = kept[version]["rows"] if options.only and version in kept else {}
        kept[version] = {
            "date": time.strftime("%Y-%m-%d"),
            "machine": f"{os.cpu_count()} cores, {platform.system()} {platform.machine()}",
            "python": platform.python_version(),
            **{name: getattr(options, name) for name in ("calls", "seconds", "rounds")},
            "rows": {**before, **measured},
        }
        KEPT.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
