"""Waiting for what other threads and programs do.

Rules: a test waits for a fact, never for a time. `HANG` is the one number of seconds after which
something that does not come is said to hang: a wait ends as soon as the fact is there, so it costs
nothing, and a busy machine needs no other. What is expected *not* to happen is waited for in some
other way: by something that happens after it would have.
"""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable
from typing import Final

HANG: Final = 30.0


def wait_until(condition: Callable[[], object], timeout: float = HANG, what: str = "") -> None:
    """Return as soon as `condition` holds; AssertionError if it does not in time."""
    deadline = time.monotonic() + timeout
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError(f"after {timeout} s still not: {what or condition}")
        time.sleep(0.002)


def runs(function: str, thread: int = 0) -> bool:
    """Return whether a thread, or the one with that number, is inside `function` (its qualified
    name)."""
    frames = sys._current_frames()
    for frame in [frames.get(thread)] if thread else frames.values():
        while frame is not None:
            if frame.f_code.co_qualname == function:
                return True
            frame = frame.f_back
    return False


def inside(function: str, act: Callable[[], object]) -> threading.Thread:
    """Call `act` in a thread as soon as the calling thread is inside `function` (its qualified
    name), and return that thread, started."""
    caller = threading.get_ident()

    def run() -> None:
        wait_until(lambda: runs(function, caller), what=f"inside {function}")
        act()

    thread = threading.Thread(target=run)
    thread.start()
    return thread
