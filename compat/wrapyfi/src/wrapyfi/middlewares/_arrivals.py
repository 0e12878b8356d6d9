"""Where things wait until the program takes them: values that threads of a library bring, requests.

Rules: all of them may be called in any thread; closing ends every wait.
"""

from __future__ import annotations

import queue
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import yarpy
from yarpy.kits.wrap.middleware import Failure, Received
from yarpy.kits.wrap.receive_queue import ReceiveQueue

#: pictures and sounds, or values, that a listener has not taken yet
KEPT = (10, 100)


class Arrivals:
    """Values that came to a listener by the threads of a library: `queue_size` of them are kept,
    without it `usual` or `KEPT`, and the oldest go."""

    def __init__(self, side: Any, usual: int | str = 0) -> None:
        self._came_to = side.in_topic
        keep = side.options.get("queue_size") or usual or KEPT[side.kind == "NativeObject"]
        self._queue = ReceiveQueue(max(int(keep), 1))

    def arrived(self, came: Any) -> None:
        with suppress(yarpy.PortClosed):
            self._queue.put(Received(came))

    def wait(self, seconds: float) -> bool:
        """Publishers are not waited for, as it was."""
        return True

    def receive(self, timeout: float | None) -> Any:
        try:
            return self._queue.take(timeout).value
        except yarpy.Timeout:
            raise yarpy.Timeout(f'nothing came from "{self._came_to}"') from None

    @property
    def closed(self) -> bool:
        return self._queue.closed

    def close(self) -> None:
        self._queue.close()


class RequestQueue:
    """Where requests wait, each in the thread that brought it, until the program takes them."""

    def __init__(self, topic: str) -> None:
        self._topic = topic
        self._asked: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._closed = False

    def ask(self, came: Any) -> Any:
        """Return the program's answer: spelled, or a Failure."""
        answered: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._asked.put((came, answered.put))
        if self._closed:
            self.close()
        return answered.get()

    def take(self) -> tuple[Any, Callable[[Any], None]]:
        """The next request, and what takes its answer. Raises PortClosed."""
        found: tuple[Any, Callable[[Any], None]] | None = self._asked.get()
        if found is None:
            self._asked.put(None)
            raise yarpy.PortClosed(f'"{self._topic}" was closed')
        return found

    def close(self) -> None:
        """Refuse whatever waits, and what comes."""
        self._closed = True
        failure = Failure("PortClosed", "the server was closed")
        try:
            while True:
                found = self._asked.get_nowait()
                if found is not None:
                    found[1](failure)
        except queue.Empty:
            self._asked.put(None)
