"""The part that all ports of an event loop share: open, close, connect, call back.

Rules: callbacks of the program run in the loop. What may wait is awaited, and runs in a thread; a
task that is cancelled there ends it. What cannot wait is a plain method, as of other ports. A port
whose opening is cancelled is closed again.
"""

from __future__ import annotations

import asyncio
import concurrent.futures
import threading
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from inspect import isawaitable
from types import TracebackType
from typing import Any, Final, Generic, Self, TypeVar

from yarpy import linger
from yarpy.aio.thread import THREADS, Turn, in_thread
from yarpy.aio.wakeup import Wakeup
from yarpy.callback_thread import in_callback_of
from yarpy.contact import Contact
from yarpy.errors import PortClosed, YarpError
from yarpy.port import base
from yarpy.port.answer.monitoring import Side
from yarpy.port.connection import ConnectionEvent, PortConnection
from yarpy.port.deadline import DeadlineEvent
from yarpy.port.mailbox import Mailbox
from yarpy.port.options import PortOptions
from yarpy.port.stats import PortStats
from yarpy.wire.message import Message

P = TypeVar("P", bound=base.BasePort)
E = TypeVar("E")

LOOK: Final = 1.0  # seconds between looks whether the loop of a callback still exists


class BasePort(Generic[P]):
    """The base of the ports of an event loop: they open, close, and have connections.

    It opens on `async with` or `await port.open()`. Callbacks are called in the loop; those that
    answer may be coroutine functions. Once closed it stays closed.
    """

    def __init__(self, name: str, options: PortOptions) -> None:
        self._name = name
        self._port: P | None = None
        self._closed = False
        self._loop: asyncio.AbstractEventLoop | None = None
        self._opening = Turn()
        self._wakeup = Wakeup()  # a message came, a connection came or went, somebody interrupted
        self._on_connection = options.get("on_connection")
        self._options: PortOptions = {**options, "on_connection": self._tell}

    def _make(self) -> P:
        """Open the port underneath, in a thread."""
        raise NotImplementedError

    def _belled(self, mailbox: Mailbox) -> Mailbox:
        """A mailbox that tells the loop of messages, and of its end."""
        mailbox.notify = self._wakeup.notify
        return mailbox

    # -- opening and closing ----------------------------------------------------------------------

    async def open(self) -> Self:
        """Open and register. Raises AddressError, NoNameServer, PortClosed once it was closed."""
        if self._port is None:
            await self._opening.wait()
            if self._port is None and not self._closed:
                await self._open()
            else:
                self._opening.release()
        if self._closed:
            raise PortClosed(f'"{self.name}" is closed; make another one')
        return self

    async def _open(self) -> None:
        """Open the port underneath, in our turn, which ends when that is done or has failed."""
        self._loop = asyncio.get_running_loop()
        made: list[P] = []
        wanted = True
        linger.hear()  # the thread below cannot

        def after() -> None:
            for port in made:
                if wanted:
                    self._port = port
                else:
                    THREADS.start(port.close)
            if self._port is not None:
                linger.hear()  # once more: another port may have closed meanwhile
            else:
                linger.hear_no_more()
            self._opening.release()

        opening = asyncio.ensure_future(in_thread(lambda: made.append(self._make()), after))
        # If it fails after this was cancelled, nobody wants to hear of it.
        opening.add_done_callback(lambda task: task.cancelled() or task.exception())
        try:
            # What is half open would have to be closed in a call that is over: let it open first.
            await asyncio.shield(opening)
        except asyncio.CancelledError:
            wanted = False
            if self._port is not None:  # it was open already
                THREADS.start(self._port.close)
                self._port = None
            raise

    async def close(self, timeout: float | None = None) -> None:
        """Close the port: say goodbye on each connection, give the name back; see
        `yarpy.Port.close`."""
        await self._opening.wait()
        self._closed = True
        self._opening.release()
        if self._port is not None:
            await in_thread(partial(self._port.close, timeout))
        linger.hear_no_more()

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
        """The name, complete once it is open: what `...` became, prefix included."""
        return self._port.name if self._port is not None else self._name

    @property
    def contact(self) -> Contact:
        """The address where the port listens."""
        return self.port.contact

    @property
    def address(self) -> str:
        """`host:port` of the listening socket."""
        return self.port.address

    @property
    def inputs(self) -> list[PortConnection]:
        """The connections that bring messages here."""
        return self.port.inputs

    @property
    def outputs(self) -> list[PortConnection]:
        """The connections that take messages away."""
        return self.port.outputs

    @property
    def stats(self) -> PortStats:
        """The counts of every connection; see `yarpy.Port.stats`."""
        return self.port.stats

    def __repr__(self) -> str:
        state = "closed" if self.closed else "not open" if self._port is None else self.address
        return f"<aio.{type(self).__name__} {self.name or '...'} ({state})>"

    @property
    def closed(self) -> bool:
        """Return whether `close` was called."""
        return self._closed or (self._port is not None and self._port.closed)

    # -- connections ------------------------------------------------------------------------------

    async def connect(
        self, target: str, carrier: str = "", timeout: float | None = None
    ) -> PortConnection:
        """Send what this port writes to `target`; see `yarpy.Port.connect`."""
        port = self.port
        return await in_thread(partial(port.connect, target, carrier, timeout), undo=_end)

    async def disconnect(self, target: str, timeout: float | None = None) -> bool:
        """End the connections to `target`; whether there were any. See `yarpy.Port.disconnect`."""
        return await in_thread(partial(self.port.disconnect, target, timeout))

    async def listen_to(self, source: str, carrier: str = "", timeout: float | None = None) -> None:
        """Ask the port `source` to send here; see `yarpy.Port.listen_to`."""
        await in_thread(partial(self.port.listen_to, source, carrier, timeout))

    async def wait_for_outputs(self, count: int = 1, timeout: float | None = None) -> bool:
        """Wait until at least `count` ports receive what this one writes; False if time is over."""
        return await self._until(base.at_least(count, lambda: self.outputs), timeout)

    async def wait_for_inputs(self, count: int = 1, timeout: float | None = None) -> bool:
        """Wait until at least `count` ports write to this one; False if time is over."""
        return await self._until(base.at_least(count, lambda: self.inputs), timeout)

    async def _until(self, condition: Callable[[], bool], timeout: float | None) -> bool:
        port = self.port

        def look() -> bool | None:
            if condition():
                return True
            port._check_open()
            return None

        return bool(await self._wakeup.wait_for(look, timeout))

    async def attach(self, side: Side, parameters: Mapping[str, Any]) -> None:
        """Let a monitor ride on all that goes "in" or "out"; see `yarpy.Port.attach`."""
        await in_thread(partial(self.port.attach, side, parameters))

    async def detach(self, side: Side) -> None:
        """Let nothing ride on it any more."""
        await in_thread(partial(self.port.detach, side))

    def interrupt(self) -> None:
        """Stop reading and writing: what waits raises PortClosed; connections stay."""
        self.port.interrupt()

    def resume(self) -> None:
        """Undo `interrupt`."""
        self.port.resume()

    # -- callbacks --------------------------------------------------------------------------------

    def on_connection(self, callback: Callable[[ConnectionEvent], object] | None) -> None:
        """Call `callback` in the loop whenever a connection comes or goes."""
        self._on_connection = callback

    def on_deadline(self, callback: Callable[[DeadlineEvent], object] | None) -> None:
        """Call `callback` in the loop whenever a message comes after the deadline of its
        connection, or none comes that should; see `yarpy.Port.on_deadline`."""
        self.port.on_deadline(callback and partial(self._call_soon, callback))

    def on_admin(self, callback: Callable[[Message], object] | None) -> None:
        """Let `callback` answer administrative messages; see `yarpy.Port.on_admin`."""
        self.port.on_admin(callback and self._ask_loop(callback))

    def on_page(self, callback: Callable[[str, Mapping[str, str]], Any] | None) -> None:
        """Let `callback(path, fields)` show pages to browsers; see `yarpy.Port.on_page`."""
        self.port.on_page(callback and self._ask_loop(callback))

    def _tell(self, event: ConnectionEvent) -> None:
        """A connection came or went, in its thread."""
        self._wakeup.notify()
        if self._on_connection is not None:
            self._call_soon(self._on_connection, event)

    def _call_soon(self, callback: Callable[[E], object], event: E) -> None:
        """Call `callback` in the loop; the thread of the connection does not wait."""
        assert self._loop is not None
        try:
            self._loop.call_soon_threadsafe(callback, event)
        except RuntimeError:
            pass  # the loop is closed

    def _ask_loop(self, callback: Callable[..., Any]) -> Callable[..., Any]:
        """`callback`, for a connection's thread: it runs in the loop, the thread waits. That raises
        PortClosed when the loop has ended."""
        loop = self._loop
        assert loop is not None

        async def run(thread: threading.Thread, arguments: tuple[object, ...]) -> Any:
            with in_callback_of(thread):
                found = callback(*arguments)
                return await found if isawaitable(found) else found

        def ask(*arguments: object) -> Any:
            coroutine = run(threading.current_thread(), arguments)
            try:
                asked = asyncio.run_coroutine_threadsafe(coroutine, loop)
            except RuntimeError:
                coroutine.close()
                raise PortClosed(ENDED) from None
            while not loop.is_closed():
                concurrent.futures.wait([asked], LOOK)
                if asked.done():
                    break
            try:
                return asked.result(0)
            except (concurrent.futures.CancelledError, TimeoutError):
                if asked.done() and not asked.cancelled():
                    raise  # by the callback itself
                raise PortClosed(ENDED) from None

        return ask


def _end(connection: PortConnection) -> None:
    """End a connection that came when nobody wanted it any more."""
    with suppress(YarpError):
        connection.close()


ENDED: Final = "the event loop of this port has ended"
