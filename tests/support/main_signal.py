"""A signal that comes while the main thread waits.

Rules: it is sent again until its handler has been called. A signal that comes just before the
thread falls asleep wakes nobody: Python has looked for signals before, and sleeps until the next.
"""

from __future__ import annotations

import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from support.wait import HANG, inside

from yarpy.cli.signals import _wake_main_thread


@contextmanager
def signalled(function: str, number: int, handler: Callable[[], object]) -> Iterator[None]:
    """Call `handler` by a signal, once, as soon as the main thread is inside `function` (its
    qualified name), which must be in the block."""
    came = False

    def hear(*_: object) -> None:
        nonlocal came
        if not came:
            came = True
            handler()

    def send() -> None:
        until = time.monotonic() + HANG
        while not came and time.monotonic() < until:
            _wake_main_thread(number)
            time.sleep(0.05)

    before = signal.signal(number, hear)
    thread = inside(function, send)
    try:
        yield
    finally:
        thread.join()
        signal.signal(number, before)
