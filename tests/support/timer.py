"""A timer of the program, whose signals interrupt what its main thread waits for."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager

BEAT = 0.02  # seconds from one signal to the next


@contextmanager
def beating() -> Iterator[None]:
    """A handler that does nothing is called all the time. On Windows nothing interrupts a wait."""
    if not hasattr(signal, "setitimer"):
        yield
        return
    before = signal.signal(signal.SIGALRM, lambda number, frame: None)
    signal.setitimer(signal.ITIMER_REAL, BEAT, BEAT)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
