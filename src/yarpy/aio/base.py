"""What every port of an event loop can do: open, close, have connections, call back.

Rules: callbacks of the program run in the loop. A port whose opening is cancelled is closed again.
"""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from inspect import isawaitable
from types import TracebackType
from typing import Any, Final, Generic, Self, TypeVar

from yarpy.contact import Contact
from yarpy.errors import PortClosed
from yarpy.port import base
from yarpy.port.connection import ConnectionEvent, PortConnection
from yarpy.port.deadline import DeadlineEvent
from yarpy.wire.message import Message

P = TypeVar("P", bound=base.BasePort)
E = TypeVar("E")

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
        self, target: str, carrier: str = "", timeout: float | None = None
    ) -> PortConnection:
        """Send what this port writes to `target`; see `yarpy.Port.connect`."""
        return await asyncio.to_thread(self.port.connect, target, carrier, timeout)

    async def disconnect(self, target: str) -> bool:
        """End the connections to `target`; whether there were any."""
        return await asyncio.to_thread(self.port.disconnect, target)

    async def listen_to(self, source: str, carrier: str = "") -> None:
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
        """`callback`, for a connection's thread: it runs in the loop, the thread waits."""
        loop = self._loop
        assert loop is not None

        async def run(arguments: tuple[object, ...]) -> Any:
            found = callback(*arguments)
            return await found if isawaitable(found) else found

        def ask(*arguments: object) -> Any:
            return asyncio.run_coroutine_threadsafe(run(arguments), loop).result()

        return ask


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
