"""Memory while ten million small messages pass: a writer, and a strict reader in another program.

    python bench/endurance.py [--messages 10000000] [--carrier tcp]

After the first hundredth, in which tables and caches fill, and after each tenth the two programs
say what the kernel holds for them (resident memory, MiB) and how many file descriptors are open.
The reader checks that no message is missing.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from typing import Any

import yarpy

READER = """
import json, os, sys, time, yarpy
names, carrier, count, marks = json.loads(sys.argv[1])
os.environ.update(names)
def used():
    with open("/proc/self/status") as lines:
        fields = dict(line.split(":", 1) for line in lines)
    return int(fields["VmRSS"].split()[0]) / 1024, len(os.listdir("/proc/self/fd"))
port = yarpy.BufferedPort("/endurance/in", strict=True)
yarpy.connect("/endurance/out", port.name, carrier)
marks = set(marks)
for number in range(count):
    message = port.read()
    assert message.value[0] == number, f"{message.value} is not number {number}"
    if number + 1 in marks:
        print(json.dumps([number + 1, *used(), time.process_time()]), flush=True)
port.close()
"""


def used() -> tuple[float, int]:
    """Resident memory in MiB, and open file descriptors."""
    with open("/proc/self/status", encoding="utf-8") as lines:
        fields = dict(line.split(":", 1) for line in lines)
    return int(fields["VmRSS"].split()[0]) / 1024, len(os.listdir("/proc/self/fd"))


def run(count: int, carrier: str) -> list[tuple[Any, ...]]:
    """(messages, the writer's memory, its descriptors and processor time, the reader's)."""
    marks = sorted({max(1, count // 100), *(count * part // 10 for part in range(1, 11))})
    rows = []
    with yarpy.NameServer() as server, yarpy.Port("/endurance/out") as port:
        what = json.dumps([server.environment, carrier, count, marks])
        command = [sys.executable, "-c", READER, what]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as reader:
            assert reader.stdout is not None
            while not port.links:
                time.sleep(0.01)
            sent = 0
            for mark in marks:
                for number in range(sent, mark):
                    port.write([number, 1.5])
                sent = mark
                own = (*used(), time.process_time())
                port.flush()
                line = reader.stdout.readline()
                assert line, "the reader ended"
                rows.append((mark, *own, *json.loads(line)[1:]))
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--messages", type=int, default=10_000_000)
    parser.add_argument("--carrier", default="tcp")
    options = parser.parse_args()
    started = time.perf_counter()
    rows = run(options.messages, options.carrier)
    seconds = time.perf_counter() - started
    print("| messages | writer, MiB | files | reader, MiB | files |")
    print("|--:|--:|--:|--:|--:|")
    for count, memory, files, _, other, others, _ in rows:
        print(f"| {count:,} | {memory:.1f} | {files} | {other:.1f} | {others} |")
    busy = [rows[-1][place] / options.messages * 1e6 for place in (3, 6)]
    print(
        f"\n{options.messages / seconds:,.0f} messages a second over {options.carrier}; processor "
        f"time for each: {busy[0]:.1f} us of the writer, {busy[1]:.1f} us of the reader"
    )


if __name__ == "__main__":
    main()
