"""Soak: an hour of writing and reading, after which memory and descriptors are what they were.

    make soak                               an hour
    python tests/chaos/soak.py SECONDS

Rules: one port that writes to a strict reader and to one that wants the latest, two questions a
millisecond's rest apart, and now and then a connection that comes and goes. What grows steadily is
a leak: the second half of the run may use no more than the first did, and a little.
"""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

import yarpy

ROOM = 8.0  # megabytes that memory may grow between the halves: caches, fragments
HERTZ = 1000.0


def memory() -> float:
    """Megabytes."""
    with open("/proc/self/statm", encoding="utf-8") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


def descriptors() -> int:
    return len(os.listdir("/proc/self/fd"))


@contextmanager
def traffic() -> Iterator[dict[str, int]]:
    """Everything that runs; what is counted."""
    counts = {"written": 0, "strict": 0, "latest": 0, "calls": 0, "connections": 0}
    ended = threading.Event()
    names = yarpy.LocalNames()
    with (
        yarpy.BufferedPort("/out", strict=True, names=names) as out,
        yarpy.BufferedPort("/strict", strict=True, names=names) as strict,
        yarpy.BufferedPort("/latest", names=names) as latest,
        yarpy.RpcServer("/server", lambda message: message.value, names=names) as _,
        yarpy.RpcClient("/server", names=names) as client,
        yarpy.Port("/guest", names=names) as guest,
    ):
        out.connect("/strict")
        out.connect("/latest", "fast_tcp")

        def repeat(step: object, pause: float) -> None:
            while not ended.wait(pause):
                step()  # type: ignore[operator]

        def write() -> None:
            out.write([counts["written"], "x" * (counts["written"] % 3000)])
            counts["written"] += 1

        def read_strict() -> None:
            number = strict.read(timeout=5.0).value[0]
            assert number == counts["strict"], f"{number} came after {counts['strict'] - 1}"
            counts["strict"] += 1

        def read_latest() -> None:
            latest.read(timeout=5.0)
            counts["latest"] += 1

        def call() -> None:
            assert client.call("ping", counts["calls"], timeout=5.0) == ["ping", counts["calls"]]
            counts["calls"] += 1

        def come_and_go() -> None:
            guest.connect("/latest", ("tcp", "udp", "text_ack")[counts["connections"] % 3])
            guest.write(["hello"])
            guest.disconnect("/latest")
            counts["connections"] += 1

        failed: list[BaseException] = []

        def guarded(step: object, pause: float) -> None:
            try:
                repeat(step, pause)
            except BaseException as error:
                if not ended.is_set():
                    failed.append(error)

        steps = [
            (write, 1 / HERTZ),
            (read_strict, 0.0),
            (read_latest, 0.002),
            (call, 0.001),
            (come_and_go, 0.5),
        ]
        threads = [threading.Thread(target=guarded, args=step, daemon=True) for step in steps]
        for thread in threads:
            thread.start()
        try:
            yield counts
        finally:
            ended.set()
            for thread in threads:
                thread.join(10)
            if failed:
                raise failed[0]


def soak(seconds: float) -> int:
    """Run so long; how many things grew."""
    with traffic() as counts:
        samples = []
        started = time.monotonic()
        for part in range(1, 13):
            while (left := started + seconds * part / 12 - time.monotonic()) > 0:
                time.sleep(left)
            samples.append((memory(), descriptors()))
            print(
                f"{seconds * part / 12:6.0f} s  {samples[-1][0]:6.1f} MB  {samples[-1][1]:3d} files"
                f"  {threading.active_count():2d} threads  "
                + "  ".join(f"{count} {name}" for name, count in counts.items()),
                flush=True,
            )
    first, second = samples[3:7], samples[8:]
    grown = max(size for size, _ in second) - max(size for size, _ in first)
    more = min(count for _, count in second) - max(count for _, count in first)
    print(f"memory grew by {grown:.1f} MB from the first half to the second, files by {more}")
    return int(grown > ROOM) + int(more > 0)


if __name__ == "__main__":
    sys.exit(soak(float(sys.argv[1]) if len(sys.argv) > 1 else 3600.0))
