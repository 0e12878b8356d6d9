"""Waits that a signal handler in the main thread may end.

    Linux, macOS    a signal wakes the main thread, and Python calls the handler
    Windows         it sleeps on where it waits for a lock, or where the signal is not Ctrl-C: a
                    wait comes in slices, between which Python calls the handler

Rules: only for waits in which a main thread may be; no other one hears of signals.
"""

from __future__ import annotations

import sys
import threading
import time
from _thread import LockType, allocate_lock
from typing import Final

SLICE: Final = 0.25  # seconds
_MOST: Final = SLICE if sys.platform == "win32" else 1e6


def acquire(lock: LockType, until: float | None = None) -> bool:
    """Take a lock; False if it is still taken at that moment of time.monotonic. None: wait for
    ever."""
    if until is None and sys.platform != "win32":
        return lock.acquire()
    while True:
        left = _MOST if until is None else until - time.monotonic()
        if lock.acquire(timeout=max(0.0, min(left, _MOST))):
            return True
        if until is not None and left <= _MOST:
            return False


def wait(seconds: float | None = None) -> None:
    """Wait until so many seconds are over; None: so that only an exception out of a signal handler
    ends it. An Event of Python would not be whole where that comes between two of its steps."""
    lock = allocate_lock()
    lock.acquire()
    acquire(lock, None if seconds is None else time.monotonic() + seconds)


def happens(event: threading.Event, seconds: float) -> bool:
    """Return whether an event is set within so many seconds, as soon as it is."""
    until = time.monotonic() + seconds
    while True:
        left = until - time.monotonic()
        if event.wait(max(0.0, min(left, _MOST))):
            return True
        if left <= _MOST:
            return False
