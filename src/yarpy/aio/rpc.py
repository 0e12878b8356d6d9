"""Questions and answers in an event loop: a server whose handlers run there, and a client.

Rules: handlers of different clients run side by side; a client has one question on its way at a
time.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial
from inspect import isawaitable
from typing import Any, Self

from yarpy.aio.base import BasePort
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.names.base import NameClient
from yarpy.port import rpc
from yarpy.port.connection import ConnectionEvent
from yarpy.wire.message import Message
from yarpy.wire.stream import DEFAULT_LIMIT


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
        server = self._open_server(handler=self._ask_loop(self._answer))
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
        timeout: float | None = None,
    ) -> None:
        super().__init__(name, on_connection)
        self._make_client = partial(
            rpc.RpcClient, target, name=name, carrier=carrier, names=names,
            tcp_port=tcp_port, limit=limit, on_connection=self._tell, timeout=timeout,
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

    async def ask(self, question: object, timeout: float | None = None) -> Message | None:
        """As `call` with one argument, but returns the whole Message; None if there is no reply."""
        async with self._turn:
            client = (await self.open()).port
            return await asyncio.to_thread(client.ask, question, timeout)

    async def tell(self, statement: object) -> None:
        """Send it without waiting for an answer."""
        async with self._turn:
            client = (await self.open()).port
            await asyncio.to_thread(client.tell, statement)
