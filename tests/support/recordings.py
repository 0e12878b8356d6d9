"""Recordings made by hand: for tests of what reads them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import yarpy
from yarpy.data import codec
from yarpy.kits.record.mcap.writer import McapWriter

START = 1_795_000_000_000_000_000  # nanoseconds since 1970
STEP = 10_000_000  # nanoseconds between messages


def payload_of(value: object) -> bytes:
    """The bytes of YARP for a value."""
    return b"".join(map(bytes, codec.encode(value)))


def fill(writer: McapWriter, count: int = 10, ports: tuple[str, ...] = ("/a", "/b")) -> None:
    """Message n is the list of n, stamped `n N.5`, 10 ms behind the one before it."""
    for n in range(count):
        port = ports[n % len(ports)]
        writer.add(port, f"{n} {n}.5", START + n * STEP, payload_of([n]))


def recorded(path: Path, count: int = 10, compression: str = "none", plain: bool = False) -> Path:
    """A finished file with `fill` in chunks of five messages."""
    with McapWriter(path, compression, plain=plain) as writer:
        for n in range(count):
            port = "/a" if n % 2 == 0 else "/b"
            writer.add(port, f"{n} {n}.5", START + n * STEP, payload_of([n]))
            if n % 5 == 4:
                writer.flush()
    return path


def episode(path: Path, frames: int, base: int = 0) -> Path:
    """A finished file: an arm, a goal and a camera of 100 Hz, for so many frames at 10 a second."""
    with McapWriter(path) as writer:
        for n in range(frames * 10 - 9):
            time = START + n * STEP
            writer.add("/arm", f"{n} {n}.5", time, payload_of(yarpy.Vector([base + n, -n])))
            writer.add("/goal", "", time, payload_of([base + n]))
            image = yarpy.Image(np.full((4, 6, 3), n, "u1"))
            writer.add("/cam", "", time, payload_of(image))
    return path
