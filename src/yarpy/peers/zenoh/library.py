"""Zenoh as a library: loading it, what it says in errors, and threads that wait in it.

Rules: a thread that waits in the library when Python ends aborts the program: put `with CALLS:`
around what waits in threads that may outlive the main one (`Subscriber.recv`, replies of `get`).
Use `Callback(f, indirect=False)` of `zenoh.handlers` for subscribers: it needs no thread of Python.
"""

from __future__ import annotations

import re
import threading
import time
from collections.abc import Callable
from typing import Any, Final
from weakref import WeakSet

from yarpy.errors import UnknownPlugin

ENDING: Final = "the program ends"
WAKE: Final = b"yarpy: look again"  # beside a delete that only wakes a reader of this process
SHUTDOWN_GRACE: Final = 2.0  # seconds for threads to come back from Zenoh when the program ends


def load() -> Any:
    """The library. Raises UnknownPlugin if it is not installed."""
    try:
        import zenoh
    except ImportError as error:
        raise UnknownPlugin(
            f'Zenoh is not installed here ({error}): `pip install "yarpy[zenoh]"`'
        ) from error
    return zenoh


def plain(error: Exception) -> str:
    """Return the text of an error of Zenoh, without the places in its sources."""
    return re.sub(r"\s+at \S+\.rs:\d+\.?", "", str(error)).strip(" .!")[:300]


class Calls:
    """Threads that wait in Zenoh: the interpreter may not end meanwhile. To be used as `with
    CALLS:` around what waits there. `waking` are called when the program ends.

    Where one thread at a time waits, and often, a lock of its own (`new_lock`) costs less: it is
    held meanwhile, by whoever has seen that it is not `over`.
    """

    def __init__(self) -> None:
        self.waking: list[Callable[[], object]] = []
        self._waiting = 0
        self.over = False
        self._lock = threading.RLock()
        self._locks = WeakSet[threading.Lock]()

    def __enter__(self) -> None:
        with self._lock:
            if self.over:
                raise ConnectionAbortedError(ENDING)
            self._waiting += 1

    def __exit__(self, *details: object) -> None:
        with self._lock:
            self._waiting -= 1

    def new_lock(self) -> threading.Lock:
        """A lock for one thread at a time."""
        lock = threading.Lock()
        with self._lock:
            self._locks.add(lock)
        return lock

    def refuse(self) -> None:
        """Nobody may wait any more."""
        with self._lock:
            self.over = True
        for wake in self.waking:
            wake()

    def wait(self) -> None:
        """Wait until everybody has come back, but not for ever."""
        deadline = time.monotonic() + SHUTDOWN_GRACE
        with self._lock:
            locks = [*self._locks]
        while self._waiting or any(lock.locked() for lock in locks):
            if time.monotonic() > deadline:
                return
            time.sleep(0.001)

    def start_over(self) -> None:
        """In a forked process: those threads are not here."""
        self._waiting, self._lock, self._locks = 0, threading.RLock(), WeakSet()


CALLS: Final = Calls()
