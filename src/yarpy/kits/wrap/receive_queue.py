"""Receive queues: what listeners heard and nobody has taken yet; threads and event loops wait.

Rules: with `keep="latest"` the newest replaces what was there, with a number so many are kept, the
oldest go; with "all" the one who delivers waits while `FULL` are there. What goes is counted.
"""

from __future__ import annotations

import asyncio
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Final

from yarpy.errors import PortClosed, Timeout
from yarpy.kits.wrap.middleware import Keep, Listener, Received

FULL: Final = 10_000


class ReceiveQueue:
    """Values from any number of listeners, or the errors that came in place of one."""

    def __init__(self, keep: Keep) -> None:
        self.drops = 0
        self._keep = keep
        self._room = FULL if keep == "all" else 1 if keep == "latest" else int(keep)
        self._items: deque[Received | Exception] = deque()
        self._changed = threading.Condition()
        self._closed = False
        self._wakers: set[Callable[[], None]] = set()

    def put(self, item: Received | Exception) -> None:
        """Deliver something. Raises PortClosed."""
        with self._changed:
            while self._keep == "all" and len(self._items) >= self._room and not self._closed:
                self._changed.wait()
            if self._closed:
                raise PortClosed("nobody listens any more")
            if len(self._items) >= self._room:
                self._items.popleft()
                self.drops += 1
            self._items.append(item)
            self._wake()

    def _wake(self) -> None:
        self._changed.notify_all()
        for waker in self._wakers:
            waker()

    def poll(self) -> Received | None:
        """Return the next value, None if there is none yet. Raises errors that arrived, and
        PortClosed."""
        with self._changed:
            if not self._items:
                if self._closed:
                    raise PortClosed("this was closed")
                return None
            item = self._items.popleft()
            self._changed.notify_all()
        if isinstance(item, Exception):
            raise item
        return item

    def take(self, timeout: float | None) -> Received:
        """The next. Raises Timeout, PortClosed, and what came as an error."""
        deadline = None if timeout is None else time.monotonic() + timeout
        while True:
            item = self.poll()
            if item is not None:
                return item
            with self._changed:
                left = None if deadline is None else deadline - time.monotonic()
                if left is not None and left <= 0:
                    raise Timeout(f"nothing came within {timeout:.3g} s")
                if not self._items and not self._closed:
                    self._changed.wait(left)

    @property
    def closed(self) -> bool:
        """True after nobody takes anything any more."""
        return self._closed

    async def take_async(self, timeout: float | None) -> Received:
        """The same in an event loop."""
        loop = asyncio.get_running_loop()
        arrived = asyncio.Event()

        def waker() -> None:
            try:
                loop.call_soon_threadsafe(arrived.set)
            except RuntimeError:  # the loop has ended
                pass

        with self._changed:
            self._wakers.add(waker)
        try:
            async with asyncio.timeout(timeout):
                while (item := self.poll()) is None:
                    await arrived.wait()
                    arrived.clear()
                return item
        except TimeoutError:
            raise Timeout(f"nothing came within {timeout:.3g} s") from None
        finally:
            with self._changed:
                self._wakers.discard(waker)

    def close(self) -> None:
        """Whoever waits gets PortClosed."""
        with self._changed:
            self._closed = True
            self._wake()


def pump(listener: Listener, queue: ReceiveQueue, name: str) -> threading.Thread:
    """A thread that brings what `listener` hears to `queue`, until one of them is closed."""

    def run() -> None:
        while True:
            try:
                found: Received | Exception = listener.listen(None)
            except PortClosed:
                return
            except Exception as error:
                found = error
            try:
                queue.put(found)
            except PortClosed:
                return

    thread = threading.Thread(target=run, name=f"yarpy wrap {name}", daemon=True)
    thread.start()
    return thread
