"""The inbox of an endpoint: threads of a middleware put there what comes, a connection takes it.

Rules: what comes has a `size`, in bytes. There is a limit, in messages and in bytes; the oldest go
first, and are counted. What is read first is the endpoint itself: carriers are greeted with it.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from queue import Empty
from typing import Any, Final

from yarpy.errors import YarpError
from yarpy.platform.timed_queue import TimedQueue
from yarpy.transports.base import ObjectTransport

MOST_BYTES: Final = 1 << 28  # of messages that wait to be read
_END: Final = object()  # only wakes who waits


class Inbox(ObjectTransport):
    """The half of an endpoint that all have in common. `dropped` counts what was lost."""

    name = ""
    clock: Callable[[], float] = staticmethod(time.time)  # in seconds

    def __init__(self) -> None:
        self.dropped = 0
        self._greeted = False
        self._inbox: TimedQueue[Any] = TimedQueue()
        self._bytes = 0  # of what waits there
        self._over = False
        self._counting = threading.RLock()
        self._timeout: float | None = None

    @property
    def waiting(self) -> int:
        """The number of messages that wait to be read."""
        return self._inbox.qsize()

    def put(self, item: Any, most: int) -> None:
        """Something came; the oldest go where there are too many. In a thread of the middleware."""
        inbox = self._inbox
        with self._counting:
            self._bytes += item.size
            while inbox.qsize() >= most or self._bytes > MOST_BYTES:
                try:
                    self._bytes -= inbox.get_nowait().size
                except Empty:
                    break
                self.dropped += 1
        inbox.put(item)

    def receive(self, wait: bool = True) -> tuple[object] | None:
        if not self._greeted:
            self._greeted = True
            return (self,)  # what `greet` reads
        if self._over:
            return None
        came: list[Any] = []
        try:
            self._inbox.take(came, self._timeout if wait else 0.0)
        except Empty:
            raise BlockingIOError("nothing has come") from None
        (item,) = came
        if self._over:
            return None
        with self._counting:
            self._bytes -= item.size
        return (item,)

    def limit_waiting(self, seconds: float | None, sends: bool = True) -> None:
        self._timeout = seconds

    def interrupt(self) -> None:
        self._over = True
        self._inbox.put(_END)
        self._inbox.put(_END)  # a reader and the thread of the connection may wait

    def send(self, buffers: Sequence[Any]) -> None:
        if self._over:
            raise BrokenPipeError("it is closed")
        for item in buffers:
            try:
                self.give(item)
            except YarpError:
                raise
            except Exception as error:
                raise BrokenPipeError(f"it cannot be sent: {error}") from error

    def give(self, item: Any) -> None:
        """Send a message."""
        raise NotImplementedError
