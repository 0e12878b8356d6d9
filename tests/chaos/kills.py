"""Kills: writers and readers of shared memory that are killed in the middle of large messages, and
what is left behind.

    python tests/chaos/kills.py [COUNT]     COUNT (1000) of each carrier, `memory` and `shmem`

Rules: half of those who are killed write, half read. The port that they talk to goes on, and the
pictures that it gets are whole. What the system still has of them is counted before and after.
"""

from __future__ import annotations

import gc
import os
import random
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from glob import glob

import numpy as np

import yarpy

SIDE = 600  # pixels: 360 kB
CARRIERS = ("memory", "shmem")


def left() -> dict[str, int]:
    """What there is of shared memory, and of this process's descriptors."""
    with open("/proc/sysvipc/shm", encoding="utf-8") as file:
        segments = len(file.readlines()) - 1  # the first line is a heading
    return {
        "files in /dev/shm": len(os.listdir("/dev/shm")),
        "segments (ipcs -m)": segments,
        "files SHMEM_*": len(glob(os.path.join(tempfile.gettempdir(), "SHMEM_*"))),
        "memory of ours": len(_ours("maps")),
        "descriptors": len(os.listdir("/proc/self/fd")),
    }


def settled(before: dict[str, int]) -> dict[str, int]:
    """Return what is left once the last threads of closed ports have ended, or after 30 s."""
    until = time.monotonic() + 30
    while True:
        after = left()
        ours = ("memory of ours", "descriptors")
        if all(after[what] == before[what] for what in ours) or time.monotonic() > until:
            return after
        time.sleep(0.01)
        gc.collect()


def _ours(table: str) -> list[str]:
    with open(f"/proc/self/{table}", encoding="utf-8") as file:
        return [line for line in file if "memfd:yarpy" in line]


def be_killed(role: str, number: int, carrier: str) -> None:
    """A program that does nothing but read, or write, pictures."""
    if role == "reads":
        kept = []
        with yarpy.BufferedPort(f"/kills/reader{number}", strict=True) as port:
            for message in port:
                kept = [*kept[-5:], message.value.array]
    else:
        picture = np.full((SIDE, SIDE), 7, np.uint8)
        with yarpy.Port(f"/kills/writer{number}") as port:
            port.connect("/kills/sink", carrier)
            while True:
                port.write(picture)


@contextmanager
def nursery(carrier: str) -> Iterator[tuple[Callable[[str], None], Callable[[str, int], int]]]:
    """Starts such programs within a millisecond: by a process that has imported everything. Yields
    a function that tells it the address of the name server, and one that starts."""
    here, there = os.pipe(), os.pipe()
    mother = os.fork()
    if mother == 0:
        os.close(here[1])
        signal.signal(signal.SIGCHLD, signal.SIG_IGN)
        orders = os.fdopen(here[0])
        os.environ["YARPY_SERVER"] = orders.readline().strip()
        for line in orders:
            role, number = line.split()
            child = os.fork()
            if child == 0:
                try:
                    be_killed(role, int(number), carrier)
                except yarpy.YarpError as error:
                    print(f"{role} {number}: {error}", file=sys.stderr)
                finally:
                    os._exit(0)
            os.write(there[1], f"{child}\n".encode())
        os._exit(0)
    os.close(here[0])
    os.close(there[1])
    answers = os.fdopen(there[0])

    def tell(server: str) -> None:
        os.write(here[1], f"{server}\n".encode())

    def start(role: str, number: int) -> int:
        os.write(here[1], f"{role} {number}\n".encode())
        return int(answers.readline())

    try:
        yield tell, start
    finally:
        os.close(here[1])
        answers.close()
        os.waitpid(mother, 0)


def kill(count: int, carrier: str) -> tuple[int, int]:
    """Kill so many; how many readers were connected, and how many whole pictures came of writers.
    Raises AssertionError for one that is not whole."""
    chance = random.Random(1)
    came = connected = 0
    picture = np.full((SIDE, SIDE), 7, np.uint8)

    def take(message: yarpy.Message) -> None:
        nonlocal came
        assert (message.value.array == 7).all(), "a picture is not whole"
        came += 1

    with (
        nursery(carrier) as (tell, start),  # before there is any thread here: a fork has none
        yarpy.NameServer() as server,
        yarpy.Port("/kills/out") as out,
        yarpy.BufferedPort("/kills/sink", callback=take),
    ):
        tell(server.address)
        for number in range(count // 2):
            victims = [start(role, number) for role in ("reads", "writes")]
            deadline = time.monotonic() + 30
            while time.monotonic() < deadline:
                try:
                    out.connect(f"/kills/reader{number}", carrier)
                except yarpy.YarpError:
                    time.sleep(0.01)
                    continue
                connected += 1
                break
            until = time.monotonic() + chance.random() * 0.05
            while time.monotonic() < until:
                out.write(picture)
            for victim in victims:
                os.kill(victim, signal.SIGKILL)
            out.disconnect(f"/kills/reader{number}")
    gc.collect()
    return connected, came


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    for carrier in CARRIERS:
        before, began = left(), time.monotonic()
        connected, came = kill(count, carrier)
        seconds = time.monotonic() - began
        print(
            f"{carrier}: {count} killed in {seconds:.0f} s; {connected} readers were connected, "
            f"{came} whole pictures came"
        )
        after = settled(before)
        for what, number in before.items():
            print(f"  {what:20} {number:5} before {after[what]:5} after")


if __name__ == "__main__":
    main()
