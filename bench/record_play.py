"""How punctual `yarpy play` is, and how much memory it takes. Part of `record.py`.

Rules: the player is a program of its own, and so is what it is compared with: a loop that writes to
a port and sleeps until the next message is due. Both are heard here, by the same kind of port.
"""

import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy

import yarpy
from yarpy.data import codec
from yarpy.kits.record.mcap.writer import McapWriter

RATE = 1000  # messages a second
BOUND = 300e6  # bytes of memory that a player may take
PAYLOAD = b"".join(map(bytes, codec.encode([])))
LOOP = """
import sys, time, yarpy
from yarpy.real_time import realtime
count, rate = map(int, sys.argv[1:])
with realtime(switch_interval=0.0005), yarpy.Port("/bench/played") as port:
    port.wait_for_outputs(timeout=60)
    began = time.monotonic()
    for number in range(count):
        time.sleep(max(0.0, began + number / rate - time.monotonic()))
        port.write([], yarpy.Stamp(number, 1.0))
"""


def punctual(folder: Path, seconds: float) -> str:
    """Return a row: how late messages are."""
    path, count = folder / "play.mcap", round(seconds * RATE)
    begin = time.time_ns()
    with McapWriter(path) as writer:
        for number in range(count):
            moment = begin + number * 10**9 // RATE
            writer.add("/bench/played", f"{number} 1", moment, PAYLOAD)
    player = _lateness([sys.executable, "-m", "yarpy", "play", "--wait", str(path)], count)
    loop = _lateness([sys.executable, "-c", LOOP, str(count), str(RATE)], count)
    path.unlink()
    return (
        f"| {count} messages played, {RATE} a second | late by {player[0]:.2f} ms, "
        f"p99 {player[1]:.2f} ms | {player[1] / loop[1]:.1f} x the p99 of a loop that sleeps |"
    )


def memory(folder: Path, size: int) -> str:
    """Return a row: the memory of a player of a file of that size."""
    path, image = folder / "great.mcap", yarpy.Image(numpy.zeros((1080, 1920, 3), "u1"))
    payload = b"".join(map(bytes, codec.encode(image)))
    count = max(size // len(payload), 1)
    with McapWriter(path) as writer:
        begin = time.time_ns()
        for number in range(count):
            writer.add("/bench/played", f"{number} 1", begin + number * 10**7, payload)
    written = path.stat().st_size
    words = [sys.executable, "-m", "yarpy", "play", "--wait", "-r", "1000", str(path)]
    most = 0
    with _heard(words, lambda message: None) as player:
        while player.poll() is None:
            most = max(most, _peak(player.pid))
            time.sleep(0.02)
    path.unlink()
    return (
        f"| {written / 1e9:.1f} GB played | {most / 1e6:.0f} MB of memory "
        f"| {most / BOUND:.2f} of {BOUND / 1e6:.0f} MB, {most / written:.2f} of the file |"
    )


def _lateness(words: list[str], count: int) -> tuple[float, float]:
    """Return by how many milliseconds messages are late, in the middle and p99; the most punctual
    one is not late."""
    times: list[float] = []
    with _heard(words, lambda message: times.append(time.perf_counter())) as sender:
        sender.wait()
        deadline = time.monotonic() + 10
        while len(times) < count and time.monotonic() < deadline:
            time.sleep(0.01)
    late = [at - number / RATE for number, at in enumerate(times)]
    first, late = min(late), sorted(late)
    half, most = (late[int((len(late) - 1) * part)] - first for part in (0.5, 0.99))
    return half * 1e3, most * 1e3


@contextmanager
def _heard(
    words: list[str], heard: Callable[[object], object]
) -> Iterator["subprocess.Popen[str]"]:
    """Start a program that opens /bench/played, and hear it."""
    program = subprocess.Popen(
        words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, text=True, env=os.environ
    )
    try:
        with yarpy.BufferedPort("/bench/reader", callback=heard, strict=True):
            yarpy.wait_for("/bench/played", timeout=60)
            yarpy.connect("/bench/played", "/bench/reader", "tcp")
            yield program
    finally:
        program.kill()
        program.wait()


def _peak(process: int) -> int:
    """Return the most memory that a program has had so far, in bytes."""
    try:
        text = Path(f"/proc/{process}/status").read_text(encoding="ascii")
    except OSError:
        return 0
    found = [line.split()[1] for line in text.splitlines() if line.startswith("VmHWM")]
    return int(found[0]) << 10 if found else 0
