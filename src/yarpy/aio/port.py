"""A port whose messages are read in an event loop, each once and in order.

Rules: what the loop has not read yet waits in a list of the loop's own; beyond its length senders
wait.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import AsyncIterator, Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from yarpy.aio.base import BasePort
from yarpy.aio.inbox import Arrival, Door
from yarpy.data.stamp import Stamp
from yarpy.errors import PortClosed, Timeout
from yarpy.link.inbound import Inbound
from yarpy.names.base import NameClient
from yarpy.port.assembly import open_hub
from yarpy.port.connection import ConnectionEvent
from yarpy.port.port import MessagePort
from yarpy.wire.message import Message
from yarpy.wire.stream import DEFAULT_LIMIT

if TYPE_CHECKING:
    from numpy.typing import DTypeLike, NDArray


class Port(BasePort["_Port"]):
    """A port for one event loop. Opens on `async with` or `await port.open()`.

    Every message is read once, in order. `queue` is how many may wait unread; beyond that a sender
    waits, and nothing is lost. With `latest` only the newest waits, older ones are dropped and
    counted, in `drops` and on their connection. A question may be answered by any task, at any
    time; one that is discarded unanswered gets an empty answer. Other parameters as
    `yarpy.Port`.
    """

    def __init__(
        self,
        name: str,
        *,
        names: NameClient | None = None,
        tcp_port: int = 0,
        port_type: str = "",
        queue: int = 256,
        latest: bool = False,
        limit: int = DEFAULT_LIMIT,
        on_connection: Callable[[ConnectionEvent], object] | None = None,
    ) -> None:
        super().__init__(name, on_connection)
        self._open_hub = partial(
            open_hub, name, Door(self._take), names,
            tcp_port=tcp_port, port_type=port_type, limit=limit, on_connection=self._tell,
        )  # fmt: skip
        self._limit = 1 if latest else max(1, queue)
        self._latest = latest
        self._inbox: deque[Arrival] = deque()
        self._arrived = asyncio.Event()
        self._asked: set[Arrival] = set()  # questions that were read and not answered yet
        self._closed = False
        self.drops = 0

    def _make(self) -> _Port:
        self._closed = False
        return _Port(self._open_hub())

    async def close(self) -> None:
        """Close the port; a waiting `read` raises PortClosed."""
        port, self._port = self._port, None
        self._closed = True
        if port is not None:
            self._arrived.set()
            for arrival in self._inbox:
                arrival.drop()
            for arrival in self._asked:
                arrival.release()
            self._inbox.clear()
            self._asked.clear()
            await asyncio.to_thread(port.close)

    # -- messages ---------------------------------------------------------------------------------

    async def read(self, timeout: float | None = None) -> Message:
        """The next message. Raises Timeout after `timeout` seconds, PortClosed."""
        try:
            async with asyncio.timeout(timeout):
                while True:
                    if self._inbox:
                        return self._next()
                    _ = self.port
                    self._arrived.clear()
                    await self._arrived.wait()
        except TimeoutError:
            raise Timeout(f'nothing came to "{self.name}" within {timeout} s') from None

    def prepare(self, shape: int | tuple[int, ...], dtype: DTypeLike = "u1") -> NDArray[Any]:
        """A new array to fill and write that programs on this computer get without a copy; see
        `yarpy.Port.prepare`."""
        return self.port.prepare(shape, dtype)

    async def write(
        self,
        value: object,
        stamp: Stamp | str | None = None,
        *,
        wait: bool = False,
        timeout: float | None = None,
    ) -> int:
        """Send `value` to every connected port; see `yarpy.Port.write`.

        The loop keeps running while this waits for a slow reader.
        """
        port = self.port
        return await asyncio.to_thread(port.write, value, stamp, wait=wait, timeout=timeout)

    async def flush(self, timeout: float | None = None) -> bool:
        """Wait until every message was sent and, where readers acknowledge, taken."""
        return await asyncio.to_thread(self.port.flush, timeout)

    async def __aiter__(self) -> AsyncIterator[Message]:
        """Messages until the port is closed."""
        while True:
            try:
                message = await self.read()
            except PortClosed:
                return
            yield message

    # -- from the threads of connections ----------------------------------------------------------

    def _take(self, link: Inbound, message: Message) -> bool:
        """A message came, in its connection's thread, which waits while the inbox is full."""
        loop = self._loop
        assert loop is not None
        arrival = Arrival(link, message)
        try:
            loop.call_soon_threadsafe(self._put, arrival)
        except RuntimeError:
            return False  # the loop is closed
        arrival.wait()
        return True

    def _put(self, arrival: Arrival) -> None:
        """In the loop: keep the message, and let its connection go on if there is room."""
        if self._closed:
            arrival.drop()
            return
        if self._latest:
            while self._inbox:
                self._inbox.popleft().drop()
                self.drops += 1
        self._inbox.append(arrival)
        if len(self._inbox) <= self._limit:
            arrival.go_on()
        self._arrived.set()

    def _next(self) -> Message:
        arrival = self._inbox.popleft()
        arrival.go_on()
        self._asked = {asked for asked in self._asked if not asked.done}
        if not arrival.done:
            self._asked.add(arrival)
        if len(self._inbox) >= self._limit:
            self._inbox[self._limit - 1].go_on()
        return arrival.hand_out()


class _Port(MessagePort):
    """The port underneath, with a mailbox that leads to the loop."""
