"""Bytes in pieces, and protocol steps driven by hand.

Rules: pure. `chop` cuts bytes, `finish` runs steps whose bytes are all there, `measured` tells what
memory a block of code takes.
"""

from __future__ import annotations

import sys
import time
import tracemalloc
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

T = TypeVar("T")


def chop(data: bytes, size: int) -> list[bytes]:
    """`data` in pieces of `size` bytes; 0: in one piece."""
    if not size:
        return [data]
    return [data[start : start + size] for start in range(0, len(data), size)]


def finish(steps: Steps[T]) -> T:
    """The result of steps that need no more bytes."""
    try:
        effect = next(steps)
    except StopIteration as stop:
        value: T = stop.value
        return value
    raise AssertionError(f"the steps ask for {effect or 'more bytes'}")


def is_waiting(steps: Steps[Any]) -> bool:
    """Advance steps that shall not be done yet; whether they ask for more bytes."""
    return next(steps) is None


def output(stream: ByteStream) -> bytes:
    """Everything that was written to a stream since the last look."""
    return b"".join(bytes(piece) for piece in stream.take_output())


class Peak:
    """What a block of code held at most, in bytes above what was there before."""

    bytes = 0


@contextmanager
def measured() -> Iterator[Peak]:
    """The memory that the block takes at its peak. That of other threads counts as well, such as of
    what a runner of tests is told meanwhile; so they run while the block waits, and not in between.
    """
    peak = Peak()
    interval = sys.getswitchinterval()
    sys.setswitchinterval(60.0)
    time.sleep(0.01)  # in which those have their turn who wait for it already
    tracemalloc.start()
    try:
        before = tracemalloc.get_traced_memory()[0]
        tracemalloc.reset_peak()
        yield peak
        peak.bytes = tracemalloc.get_traced_memory()[1] - before
    finally:
        tracemalloc.stop()
        sys.setswitchinterval(interval)
