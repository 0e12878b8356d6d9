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
from collections.abc import AsyncIterator, Callable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from inspect import isawaitable
from types import TracebackType
from typing import Any, Final, Generic, Self, TypeVar

from yarpy.contact import Contact
from yarpy.data.bottle import Bottle
from yarpy.data.stamp import Stamp
from yarpy.data.value import Vocab
from yarpy.errors import PortClosed, Timeout
from yarpy.link.inbound import Inbound
from yarpy.names.base import NameClient
from yarpy.port import base, rpc
from yarpy.port.assembly import open_hub
from yarpy.port.connection import ConnectionEvent, PortConnection
from yarpy.port.mailbox import Mailbox
from yarpy.port.port import MessagePort
from yarpy.wire.message import Answer, Message
from yarpy.wire.stream import DEFAULT_LIMIT

P = TypeVar("P", bound=base.BasePort)

_POLL: Final = 0.005  # seconds between looks while waiting for connections


class BasePort(Generic[P]):
    """What every port of an event loop can do: open, close, have connections.

    It opens on `async with` or `await port.open()`. Callbacks are called in the loop; those that
    answer may be coroutine functions.
    """

    def __init__(
        self, name: str, on_connection: Callable[[ConnectionEvent], object] | None = None
    ) -> None:
        self._name = name
        self._port: P | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._opening = asyncio.Lock()
        self._on_connection = on_connection

    def _make(self) -> P:
        """Open the port underneath, in a thread."""
        raise NotImplementedError

    # -- opening and closing ----------------------------------------------------------------------

    async def open(self) -> Self:
        """Open and register. Raises AddressError, NoNameServer."""
        async with self._opening:
            if self._port is None:
                self._loop = asyncio.get_running_loop()
                self._port = await _opened(self._make)
        return self

    async def close(self) -> None:
        """Close the port."""
        port, self._port = self._port, None
        if port is not None:
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
    def port(self) -> P:
        """The port underneath. Raises PortClosed before it was opened."""
        if self._port is None:
            raise PortClosed(f'"{self._name}" is not open: use `async with` or `await port.open()`')
        return self._port

    @property
    def name(self) -> str:
        """The name."""
        return self._port.name if self._port is not None else self._name

    @property
    def contact(self) -> Contact:
        """Where the port listens."""
        return self.port.contact

    @property
    def inputs(self) -> list[PortConnection]:
        """The connections that bring messages here."""
        return self.port.inputs

    @property
    def outputs(self) -> list[PortConnection]:
        """The connections that take messages away."""
        return self.port.outputs

    @property
    def stats(self) -> dict[str, Any]:
        """Counters of every connection; see `yarpy.Port.stats`."""
        return self.port.stats

    # -- connections ------------------------------------------------------------------------------

    async def connect(
        self, target: str, carrier: str = "tcp", timeout: float | None = None
    ) -> PortConnection:
        """Send what this port writes to `target`; see `yarpy.Port.connect`."""
        return await asyncio.to_thread(self.port.connect, target, carrier, timeout)

    async def disconnect(self, target: str) -> bool:
        """End the connections to `target`; whether there were any."""
        return await asyncio.to_thread(self.port.disconnect, target)

    async def listen_to(self, source: str, carrier: str = "tcp") -> None:
        """Ask the port `source` to send here; see `yarpy.Port.listen_to`."""
        await asyncio.to_thread(self.port.listen_to, source, carrier)

    async def wait_for_outputs(self, count: int = 1, timeout: float | None = None) -> bool:
        """Wait until at least `count` ports receive what this one writes; False if time is over."""
        return await _until(lambda: len(self.outputs) >= count, timeout)

    async def wait_for_inputs(self, count: int = 1, timeout: float | None = None) -> bool:
        """Wait until at least `count` ports write to this one; False if time is over."""
        return await _until(lambda: len(self.inputs) >= count, timeout)

    # -- callbacks --------------------------------------------------------------------------------

    def on_connection(self, callback: Callable[[ConnectionEvent], object] | None) -> None:
        """Call `callback` in the loop whenever a connection comes or goes."""
        self._on_connection = callback

    def on_admin(self, callback: Callable[[Message], object] | None) -> None:
        """Let `callback` answer administrative messages; see `yarpy.Port.on_admin`."""
        self.port.on_admin(callback and self._ask_loop(callback))

    def on_page(self, callback: Callable[[str, Mapping[str, str]], Any] | None) -> None:
        """Let `callback(path, fields)` show pages to browsers; see `yarpy.Port.on_page`."""
        self.port.on_page(callback and self._ask_loop(callback))

    def _tell(self, event: ConnectionEvent) -> None:
        """A connection came or went, in its thread, which does not wait."""
        if self._on_connection is None:
            return
        assert self._loop is not None
        try:
            self._loop.call_soon_threadsafe(self._on_connection, event)
        except RuntimeError:
            pass  # the loop is closed

    def _ask_loop(self, callback: Callable[..., Any]) -> Callable[..., Any]:
        """`callback`, for a connection's thread: it runs in the loop, the thread waits."""
        loop = self._loop
        assert loop is not None

        async def run(arguments: tuple[object, ...]) -> Any:
            found = callback(*arguments)
            return await found if isawaitable(found) else found

        def ask(*arguments: object) -> Any:
            return asyncio.run_coroutine_threadsafe(run(arguments), loop).result()

        return ask


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
            open_hub, name, _Door(self._take), names,
            tcp_port=tcp_port, port_type=port_type, limit=limit, on_connection=self._tell,
        )  # fmt: skip
        self._limit = 1 if latest else max(1, queue)
        self._latest = latest
        self._inbox: deque[_Arrival] = deque()
        self._arrived = asyncio.Event()
        self._asked: set[_Arrival] = set()  # questions that were read and not answered yet
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

    async def write(
        self, value: object, stamp: Stamp | str | None = None, *, wait: bool = False
    ) -> int:
        """Send `value` to every connected port; see `yarpy.Port.write`.

        The loop keeps running while this waits for a slow reader.
        """
        port = self.port
        return await asyncio.to_thread(port.write, value, stamp, wait=wait)

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


async def _until(condition: Callable[[], bool], timeout: float | None) -> bool:
    try:
        async with asyncio.timeout(timeout):
            while not condition():
                await asyncio.sleep(_POLL)
    except TimeoutError:
        return False
    return True


async def _opened(make: Callable[[], P]) -> P:
    """What `make` opens, in a thread. When cancelled meanwhile it leaves nothing open."""
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


class _Port(MessagePort):
    """The port underneath, with a mailbox that leads to the loop."""


class _Arrival:
    """A message and the connection's thread that may be waiting for room, or for a reply."""

    def __init__(self, link: Inbound, message: Message) -> None:
        self._link = link
        self._keep = message.wants_reply  # a question: its connection waits for the answer
        self._done = threading.Event()
        self._message: Message | None = message
        answer = message.answer
        if answer is not None:
            # The reader gets a copy, since the connection's thread holds on to the original. Once
            # the copy is garbage, nobody is left who could answer.
            reply = _Reply(answer.give, self._done.set)
            self._message = message.replaced(message.payload)
            self._message.spelling, self._message.answer = message.spelling, reply

    def hand_out(self) -> Message:
        """The message, once: from now on it is the reader's."""
        message, self._message = self._message, None
        assert message is not None
        return message

    def drop(self) -> None:
        """It will not be read: count it as dropped."""
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


class RpcServer(BasePort[rpc.RpcServer]):
    """Answers every message with what `handler(message)` returns, which may be a coroutine
    function.

    Handlers run in the loop, those of different clients side by side. What one raises is answered
    as `[fail] "reason"` and logged; those still at work when the server closes are cancelled.
    Parameters as `yarpy.RpcServer`.
    """

    def __init__(
        self,
        name: str,
        handler: Callable[[Message], object],
        *,
        names: NameClient | None = None,
        tcp_port: int = 0,
        port_type: str = "",
        limit: int = DEFAULT_LIMIT,
        on_connection: Callable[[ConnectionEvent], object] | None = None,
    ) -> None:
        super().__init__(name, on_connection)
        self._handler = handler
        self._working: set[asyncio.Task[object]] = set()
        self._open_server = partial(
            rpc.RpcServer, name, names=names,
            tcp_port=tcp_port, port_type=port_type, limit=limit, on_connection=self._tell,
        )  # fmt: skip

    def _make(self) -> rpc.RpcServer:
        return self._open_server(handler=self._ask_loop(self._answer))

    async def _answer(self, message: Message) -> object:
        task = asyncio.current_task()
        assert task is not None
        self._working.add(task)
        try:
            found = self._handler(message)
            return await found if isawaitable(found) else found
        except asyncio.CancelledError:
            return Bottle([Vocab("fail"), "the server was closed meanwhile"])
        finally:
            self._working.discard(task)

    async def close(self) -> None:
        """Close the server; handlers that are still at work are cancelled."""
        for task in tuple(self._working):
            task.cancel()
        await super().close()


class RpcClient(BasePort[rpc.RpcClient]):
    """Asks the server called `target` without blocking the loop.

    One call at a time goes over the connection; more wait their turn. It opens with the first call
    at the latest. Parameters as `yarpy.RpcClient`.
    """

    def __init__(
        self,
        target: str = "",
        *,
        name: str = "",
        carrier: str = "tcp",
        names: NameClient | None = None,
        tcp_port: int = 0,
        limit: int = DEFAULT_LIMIT,
        on_connection: Callable[[ConnectionEvent], object] | None = None,
    ) -> None:
        super().__init__(name, on_connection)
        self._make_client = partial(
            rpc.RpcClient, target, name=name, carrier=carrier, names=names,
            tcp_port=tcp_port, limit=limit, on_connection=self._tell,
        )  # fmt: skip
        self._turn = asyncio.Lock()

    def _make(self) -> rpc.RpcClient:
        return self._make_client()

    async def __aenter__(self) -> Self:
        return self

    async def call(self, *args: object, timeout: float | None = None) -> Any:
        """Ask, and return the answer's value; see `yarpy.RpcClient.call`."""
        async with self._turn:
            client = (await self.open()).port
            return await asyncio.to_thread(lambda: client.call(*args, timeout=timeout))
