"""Ports that are read and written in an event loop: Port and BufferedPort.

Rules: reading takes from the mailbox of the port underneath, in the loop. What leaves without
waiting is written there too; the rest of it is done in a thread. Messages leave one after the
other, in the order of the calls.
"""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar, Unpack

from yarpy.aio.base import BasePort
from yarpy.aio.mailbox import TaskRendezvous
from yarpy.aio.thread import Turn, in_thread, left_until
from yarpy.aio.wakeup import LONGEST_RUN
from yarpy.data.stamp import Stamp
from yarpy.errors import PortClosed, Timeout
from yarpy.port import port
from yarpy.port.assembly import open_hub
from yarpy.port.hub import Hub
from yarpy.port.mailbox import Callback, Fifo, Latest, Mailbox
from yarpy.port.options import PortOptions
from yarpy.port.typed import of_type
from yarpy.scope import moment
from yarpy.wire.message import Message, T

if TYPE_CHECKING:
    from numpy.typing import DTypeLike, NDArray

M = TypeVar("M", bound=port.MessagePort)


class MessagePort(BasePort[M], Generic[M, T]):
    """A port that is read from and written to. Subclasses choose the mailbox of its hub; as other
    ports they may be for one type of message, `aio.Port[Image]`."""

    _type: ClassVar[Any] = None  # that of its messages; None: any

    if not TYPE_CHECKING:

        def __class_getitem__(cls, type_):
            return cls if cls is MessagePort else of_type(cls, type_)

    def __init__(
        self,
        name: str,
        callback: Callable[[Message[T]], object] | None,
        options: PortOptions,
    ) -> None:
        super().__init__(name, options)
        self._callback = callback
        self._turn = Turn()  # of writing
        self._run = 0  # messages that left at once, one after the other

    def _open_hub(self, kind: Callable[[], Mailbox]) -> Hub:
        """Open the hub; messages wait in that kind of mailbox, unless a callback takes them."""
        callback = self._callback
        if callback is None:
            mailbox = kind()
        else:
            mailbox = Callback(self._ask_loop(callback), type_=self._type)
        return open_hub(self._name, self._belled(mailbox), **self._options)

    async def read(self, timeout: float | None = None) -> Message[T]:
        """The next message, waiting for one if needed.

        Raises Timeout after `timeout` seconds, PortClosed if the port is closed or interrupted.
        """
        # With a callback there is nothing to read: the port underneath says so.
        look = self.port.poll if self._callback is None else partial(self.port.read, 0.0)
        message = await self._wakeup.wait_for(look, timeout)
        if message is None:
            raise Timeout(f'nothing came to "{self.name}" within {timeout} s')
        return message if self._type is None else message.typed(self._type)

    def poll(self) -> Message[T] | None:
        """A message that is already there, or None."""
        message = self.port.poll()
        return message if message is None or self._type is None else message.typed(self._type)

    @property
    def waiting(self) -> int:
        """Messages that came and were not read yet."""
        return self.port.waiting

    async def __aiter__(self) -> AsyncIterator[Message[T]]:
        """Messages until the port is closed or interrupted."""
        while True:
            try:
                message = await self.read()
            except PortClosed:
                return
            yield message

    def prepare(self, shape: int | tuple[int, ...], dtype: DTypeLike = "u1") -> NDArray[Any]:
        """A new array to fill and write that programs on this computer get without a copy; see
        `yarpy.Port.prepare`."""
        return self.port.prepare(shape, dtype)

    async def write(
        self,
        value: T,
        stamp: Stamp | str | None = None,
        *,
        wait: bool = False,
        timeout: float | None = None,
    ) -> int:
        """Send `value` to every connected port; see `yarpy.Port.write`.

        Messages of several tasks leave in the order of their calls, and `timeout` counts while this
        waits for its turn. The loop keeps running while this waits for a slow reader. Of a task
        that is cancelled meanwhile the message is a drop where it has not begun to leave.
        """
        port = self.port
        if not self._turn.take():
            until = moment(timeout)
            if not await self._turn.wait(until):
                return port._drop()
            timeout = None if until is None else left_until(until)
        begun: int | Callable[[], int]
        try:
            self._run += 1
            if self._run >= LONGEST_RUN:
                self._run = 0
                await asyncio.sleep(0)
            if wait:
                begun = partial(port.write, value, stamp, wait=True, timeout=timeout)
            else:
                begun = port._begin_write(value, stamp, timeout)
        except BaseException:
            self._turn.release()
            raise
        if isinstance(begun, int):
            self._turn.release()
            return begun
        self._run = 0
        return await in_thread(begun, self._turn.release)

    async def flush(self, timeout: float | None = None) -> bool:
        """Wait until every message was sent and, where readers acknowledge, taken."""
        return await in_thread(partial(self.port.flush, timeout))


class Port(MessagePort["_Port", T]):
    """A port for one event loop: every message is read once, and its sender waits until it was.

    Opens on `async with` or `await port.open()`. A question may be answered by any task, at any
    time; one that is discarded unanswered gets an empty answer. `callback` is called with each
    message, in the loop, and may be a coroutine function. Other parameters as `yarpy.Port`.
    """

    def __init__(
        self,
        name: str,
        *,
        callback: Callable[[Message[T]], object] | None = None,
        **options: Unpack[PortOptions],
    ) -> None:
        super().__init__(name, callback, options)

    def _make(self) -> _Port:
        return _Port(self._open_hub(TaskRendezvous))

    async def ask(self, value: object, timeout: float | None = None) -> list[Message]:
        """Ask every connected port, one after the other; the answers of those that give one. See
        `yarpy.Port.ask`."""
        return await self._turn.run(partial(self.port.ask, value), timeout)


class BufferedPort(MessagePort["_BufferedPort", T]):
    """A port between loops that run at their own pace, for one event loop.

    Reading gives the newest message, older ones are dropped and counted; with `strict` every
    message comes, in order. Opens on `async with` or `await port.open()`. Other parameters as
    `Port`.
    """

    def __init__(
        self,
        name: str,
        *,
        strict: bool = False,
        callback: Callable[[Message[T]], object] | None = None,
        **options: Unpack[PortOptions],
    ) -> None:
        super().__init__(name, callback, options)
        self._strict = strict

    def _make(self) -> _BufferedPort:
        return _BufferedPort(self._open_hub(Fifo if self._strict else Latest), self._strict)

    @property
    def strict(self) -> bool:
        """Return whether a writer waits for slow readers; else the newest message wins."""
        return self._strict if self._port is None else self._port.strict

    @strict.setter
    def strict(self, strict: bool) -> None:
        self._strict = strict
        if self._port is not None:
            self._port.strict = strict

    def read_strictly(self, strict: bool = True) -> None:
        """From now on every message comes, in order; or the newest only. What has come is kept."""
        self.port.read_strictly(strict)


class _Port(port.Port):
    """The port underneath, with a mailbox that wakes the loop."""

    def __init__(self, hub: Hub) -> None:
        port.MessagePort.__init__(self, hub)


class _BufferedPort(port.BufferedPort):
    """The port underneath, with a mailbox that wakes the loop."""

    def __init__(self, hub: Hub, strict: bool) -> None:
        port.MessagePort.__init__(self, hub)
        self.strict = strict
