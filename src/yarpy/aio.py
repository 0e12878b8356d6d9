"""The asyncio face of ports: the same ports, awaited.

    async with yarpy.aio.Port("/listener") as port:
        async for message in port:
            print(message.value)

Rules: no second stack. Messages come in the threads of their connections, as always, and are
handed to the loop; what may block (opening, connecting, writing to a slow reader, closing) runs in
a thread.
"""

from __future__ import annotations

import asyncio
import threading
from collections import deque
from collections.abc import AsyncIterator, Callable
from concurrent.futures import Future, ThreadPoolExecutor
from types import TracebackType
from typing import Any, Self, TypeVar

from yarpy.data.stamp import Stamp
from yarpy.errors import PortClosed, Timeout
from yarpy.link.inbound import Inbound
from yarpy.names.base import NameClient
from yarpy.port import port as plain
from yarpy.port import rpc
from yarpy.port.assembly import open_hub
from yarpy.port.base import BasePort
from yarpy.port.connection import PortConnection
from yarpy.port.mailbox import Mailbox
from yarpy.port.port import MessagePort
from yarpy.wire.message import Answer, Message

P = TypeVar("P", bound=BasePort)


class Port:
    """A port for one event loop. Opens on `async with` or `await port.open()`.

    Every message is read once, in order. `queue` is how many may wait unread; beyond that a sender
    waits, and nothing is lost. With `latest` only the newest waits, older ones are dropped and
    counted, in `drops` and on their connection. A question may be answered by any task, at any
    time; one that everybody has forgotten unanswered gets an empty answer. Other parameters as
    `yarpy.Port`.
    """

    def __init__(
        self,
        name: str,
        *,
        names: NameClient | None = None,
        tcp_port: int = 0,
        queue: int = 256,
        latest: bool = False,
        **options: Any,
    ) -> None:
        self._arguments: dict[str, Any] = {"names": names, "tcp_port": tcp_port, **options}
        self._name = name
        self._limit = 1 if latest else max(1, queue)
        self._latest = latest
        self._inbox: deque[_Arrival] = deque()
        self._arrived = asyncio.Event()
        self._port: plain.Port | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._opening = asyncio.Lock()
        self._asked: set[_Arrival] = set()  # questions that were read and not answered yet
        self._closed = False
        self.drops = 0

    # -- opening and closing ----------------------------------------------------------------------

    async def open(self) -> Self:
        """Open and register. Raises AddressError, NoNameServer."""
        async with self._opening:
            if self._port is None:
                self._closed = False
                self._loop = asyncio.get_running_loop()
                self._port = await _opened(
                    lambda: _Port(self._name, _Door(self._take), **self._arguments)
                )
        return self

    async def close(self) -> None:
        """Close the port; who waits in `read` gets PortClosed."""
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

    async def __aenter__(self) -> Self:
        return await self.open()

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        await self.close()

    # -- what it is -------------------------------------------------------------------------------

    @property
    def port(self) -> plain.Port:
        """The port underneath. Raises PortClosed before it was opened."""
        if self._port is None:
            raise PortClosed(f'"{self._name}" is not open: use `async with` or `await port.open()`')
        return self._port

    @property
    def name(self) -> str:
        """The name."""
        return self._port.name if self._port is not None else self._name

    @property
    def inputs(self) -> list[PortConnection]:
        """The connections that bring messages here."""
        return self.port.inputs

    @property
    def outputs(self) -> list[PortConnection]:
        """The connections that take messages away."""
        return self.port.outputs

    async def connect(
        self, target: str, carrier: str = "tcp", timeout: float | None = None
    ) -> PortConnection:
        """Send what this port writes to `target`; see `yarpy.Port.connect`."""
        return await asyncio.to_thread(self.port.connect, target, carrier, timeout)

    async def disconnect(self, target: str) -> bool:
        """End the connections to `target`; whether there were any."""
        return await asyncio.to_thread(self.port.disconnect, target)

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

    async def write(
        self, value: object, stamp: Stamp | str | None = None, *, wait: bool = False
    ) -> int:
        """Send `value` to every connected port; see `yarpy.Port.write`.

        The loop goes on while a slow reader is waited for.
        """
        port = self.port
        return await asyncio.to_thread(port.write, value, stamp, wait=wait)

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
        arrival = _Arrival(link, message)
        try:
            loop.call_soon_threadsafe(self._put, arrival)
        except RuntimeError:
            return False  # the loop is closed
        arrival.wait()
        return True

    def _put(self, arrival: _Arrival) -> None:
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


async def _opened(make: Callable[[], P]) -> P:
    """What `make` opens, in a thread. Who is cancelled meanwhile leaves nothing open."""
    executor = ThreadPoolExecutor(1, "yarpy opening")
    opening = executor.submit(make)
    executor.shutdown(wait=False)
    try:
        return await asyncio.shield(asyncio.wrap_future(opening))
    except asyncio.CancelledError:
        opening.add_done_callback(_close_again)
        raise


def _close_again(opening: Future[P]) -> None:
    if opening.exception() is None:
        threading.Thread(target=opening.result().close, daemon=True).start()


class _Door(Mailbox):
    """Hands each message to the loop, in the thread of its connection."""

    def __init__(self, take: Callable[[Inbound, Message], bool]) -> None:
        super().__init__()
        self._take = take

    def put(self, link: Inbound, message: Message) -> None:
        if self.stopped or not self._take(link, message):
            with self._gate:
                self._drop(link)

    def take(self, timeout: float | None = None) -> Message | None:
        raise PortClosed("this port is read in its event loop")


class _Port(plain.Port):
    """The port underneath, with a mailbox that leads to the loop."""

    def __init__(
        self,
        name: str,
        mailbox: Mailbox,
        names: NameClient | None,
        spin: bool = False,
        **options: Any,
    ) -> None:
        MessagePort.__init__(self, open_hub(name, mailbox, names, **options), spin)


class _Arrival:
    """A message and the connection's thread that may be waiting for room, or for a reply."""

    def __init__(self, link: Inbound, message: Message) -> None:
        self._link = link
        self._keep = message.wants_reply  # a question: its connection waits for the answer
        self._done = threading.Event()
        self._message: Message | None = message
        answer = message.answer
        if answer is not None:
            # A message of the reader's own: the connection's thread holds on to the other one.
            # Once the reader forgets it nobody is left who could answer.
            reply = _Reply(answer.give, self._done.set)
            self._message = message.replaced(message.payload)
            self._message.spelling, self._message.answer = message.spelling, reply

    def hand_out(self) -> Message:
        """The message, once: from now on it is the reader's."""
        message, self._message = self._message, None
        assert message is not None
        return message

    def drop(self) -> None:
        """Nobody will read it; it is counted."""
        self._link.counter.drops += 1
        self.release()

    @property
    def done(self) -> bool:
        """Whether its connection may go on."""
        return self._done.is_set()

    def wait(self) -> None:
        """Wait, in the connection's thread, until it may go on."""
        self._done.wait()

    def go_on(self) -> None:
        """There is room; a question still waits for its answer."""
        if not self._keep:
            self._done.set()

    def release(self) -> None:
        """Nobody will answer or read it any more."""
        self._done.set()


class _Reply(Answer):
    """The way back of one question; its connection goes on when it is used or forgotten."""

    __slots__ = ()

    def __del__(self) -> None:
        if self.then is not None:
            self.then()


class RpcClient:
    """Asks the server called `target` without blocking the loop.

    One call at a time goes over the connection; more wait their turn. Parameters as
    `yarpy.RpcClient`.
    """

    def __init__(self, target: str, **options: Any) -> None:
        self._target = target
        self._options = options
        self._client: rpc.RpcClient | None = None
        self._turn = asyncio.Lock()

    async def call(self, *args: object, timeout: float | None = None) -> Any:
        """Ask, and return the answer's value; see `yarpy.RpcClient.call`."""
        async with self._turn:
            if self._client is None:
                self._client = await _opened(lambda: rpc.RpcClient(self._target, **self._options))
            client = self._client
            return await asyncio.to_thread(lambda: client.call(*args, timeout=timeout))

    async def close(self) -> None:
        """Close the connection."""
        client, self._client = self._client, None
        if client is not None:
            await asyncio.to_thread(client.close)

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(self, *details: object) -> None:
        await self.close()
