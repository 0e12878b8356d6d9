"""TimedQueue: a queue between threads whose readers may stop waiting.

Rules: what is taken is in the reader's list in the same call into C, so that an exception out of a
signal handler loses nothing. A wait ends in time: `SimpleQueue.get` of Python 3.11 and 3.12 waits
for ever where a signal handler is still busy at the moment when the time is over, so a wait with a
limit is one for a lock here; on Windows, where `get` lets no handler run, every wait is. Whoever
puts something in wakes all of those, who look themselves.
"""

from __future__ import annotations

import math
import sys
import time
from _thread import LockType, allocate_lock, get_ident
from queue import Empty, SimpleQueue
from typing import Final, Generic, TypeVar

T = TypeVar("T")

_AGAIN: Final = 0.05  # seconds until a reader looks by itself: who woke it may have been cut


class TimedQueue(Generic[T]):
    """First in, first out. Any thread may call anything."""

    __slots__ = ("_items", "_waiting", "empty", "get_nowait", "qsize")

    def __init__(self) -> None:
        self._items: SimpleQueue[T] = SimpleQueue()
        self._waiting: dict[int, LockType] = {}  # by thread: one that was cut leaves no more
        self.empty = self._items.empty
        self.qsize = self._items.qsize
        self.get_nowait = self._items.get_nowait

    def put(self, item: T) -> None:
        """Add an item, and wake who waits for one."""
        self._items.put(item)
        if self._waiting:
            for lock in tuple(self._waiting.values()):
                try:
                    lock.release()
                except RuntimeError:
                    pass  # it is awake

    def take(self, into: list[T], timeout: float | None = None) -> None:
        """Move the next item to the end of a list. Raises Empty once `timeout` seconds are over;
        None waits for ever."""
        get = self._items.get
        if sys.platform != "win32" and (
            timeout is None or (sys.version_info >= (3, 13) and timeout > 0.0)
        ):
            into.extend(map(get, (True,), (timeout,)))
            return
        try:
            into.extend(map(get, (False,)))
            return
        except Empty:
            if timeout is not None and timeout <= 0.0:
                raise
        until = math.inf if timeout is None else time.monotonic() + timeout
        lock = allocate_lock()
        lock.acquire()
        try:
            self._waiting[get_ident()] = lock
            while True:
                try:
                    into.extend(map(get, (False,)))
                    return
                except Empty:
                    left = until - time.monotonic()
                    if left <= 0.0:
                        raise
                lock.acquire(timeout=min(left, _AGAIN))
        finally:
            self._waiting.pop(get_ident(), None)
