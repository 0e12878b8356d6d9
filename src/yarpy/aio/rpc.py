"""Questions and answers in an event loop: a server whose handlers run there, and a client.

Rules: handlers of different clients run side by side; a client has one question on its way at a
time.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial
from inspect import isawaitable
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Self, TypeVar, Unpack

from yarpy.aio.base import ENDED, BasePort
from yarpy.aio.thread import Turn
from yarpy.data.failure import answer_of
from yarpy.errors import PortClosed
from yarpy.port import rpc
from yarpy.port.connection import PortConnection
from yarpy.port.options import PortOptions
from yarpy.port.typed import of_type
from yarpy.wire.message import Message, T

R = TypeVar("R")


class RpcServer(BasePort[rpc.RpcServer]):
    """Answers every message with what `handler(message)` returns, which may be a coroutine
    function.

    Handlers run in the loop, those of different clients side by side. What one raises is answered
    as an error, which `call` raises as RemoteError, and logged; those still at work when the server
    closes are cancelled, and who asked gets LinkClosed.
    Parameters as `yarpy.RpcServer`.
    """

    def __init__(
        self,
        name: str,
        handler: Callable[[Message], object],
        **options: Unpack[PortOptions],
    ) -> None:
        super().__init__(name, options)
        self._handler = handler
        self._working: set[asyncio.Task[object]] = set()

    def _make(self) -> rpc.RpcServer:
        ask = self._ask_loop(self._answer)

        def answer(message: Message) -> object:
            try:
                return ask(message)
            except PortClosed as error:
                if str(error) != ENDED:
                    raise
                return answer_of(error)

        server = rpc.RpcServer(self._name, answer, **self._options)
        page = getattr(self._handler, "page", None)
        if page is not None:
            server.on_page(page)
        return server

    async def _answer(self, message: Message) -> object:
        task = asyncio.current_task()
        assert task is not None
        self._working.add(task)
        try:
            found = self._handler(message)
            return await found if isawaitable(found) else found
        except asyncio.CancelledError:
            if not task.cancelling():  # what the handler waited for was cancelled
                raise RuntimeError("the handler was cancelled") from None
            if message.answer is not None:
                message.answer.forsaken = True
            return None
        finally:
            self._working.discard(task)

    async def close(self, timeout: float | None = None) -> None:
        """Close the server; handlers that are still at work are cancelled, but for the one that
        closes it."""
        for task in self._working.difference({asyncio.current_task()}):
            task.cancel()
        await super().close(timeout)


class RpcClient(BasePort[rpc.RpcClient], Generic[T]):
    """Asks the server called `target` without blocking the loop.

    `RpcClient[Arm]("/arm/rpc").remote` has the methods of Arm, a service of a `.thrift` file.

    One call at a time goes over the connection; more wait their turn. A task that is cancelled ends
    its own call alone. It opens with the first call at the latest. Parameters as `yarpy.RpcClient`.
    """

    _type: ClassVar[Any] = None  # the service

    if not TYPE_CHECKING:

        def __class_getitem__(cls, service):
            return of_type(cls, service)

    def __init__(
        self,
        target: str = "",
        *,
        name: str = "",
        carrier: str = "",
        **options: Unpack[PortOptions],
    ) -> None:
        super().__init__(name, options)
        self._target = target
        self._carrier = carrier
        self._timeout = options.get("timeout")
        self._turn = Turn()

    def _make(self) -> rpc.RpcClient:
        return rpc.RpcClient(self._target, name=self._name, carrier=self._carrier, **self._options)

    async def __aenter__(self) -> Self:
        return self

    @property
    def remote(self) -> Any:
        """The methods of the service that this client is for, to be awaited; see
        `yarpy.RpcClient.remote`."""
        return rpc.methods_of(type(self), self, self._timeout, waits=True)

    async def connect(
        self, target: str, carrier: str = "", timeout: float | None = None
    ) -> PortConnection:
        """Choose the server to ask; see `yarpy.Port.connect`."""
        await self.open()
        return await super().connect(target, carrier, timeout)

    async def call(self, *args: object, timeout: float | None = None) -> Any:
        """Ask, and return the answer's value; see `yarpy.RpcClient.call`."""
        client = (await self.open()).port
        return await self._in_turn(lambda left: client.call(*args, timeout=left), timeout)

    async def ask(self, question: object, timeout: float | None = None) -> Message | None:
        """As `call` with one argument, but returns the whole Message; None if there is no reply."""
        client = (await self.open()).port
        return await self._in_turn(partial(client.ask, question), timeout)

    async def tell(self, statement: object, timeout: float | None = None) -> None:
        """Send it without waiting for an answer; see `yarpy.RpcClient.tell`."""
        client = (await self.open()).port
        await self._in_turn(partial(client.tell, statement), timeout)

    async def _in_turn(self, work: Callable[[float | None], R], timeout: float | None) -> R:
        """One question at a time. Where an earlier one takes all the time, the client underneath
        says so."""
        return await self._turn.run(work, self._timeout if timeout is None else timeout)
