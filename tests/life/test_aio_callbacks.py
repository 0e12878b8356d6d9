"""Every method of the ports of an event loop, awaited in each of their callbacks: none waits for
itself."""

from __future__ import annotations

import asyncio
import contextlib
import threading
import time
import urllib.request
from collections.abc import Awaitable, Callable
from inspect import isawaitable
from typing import Any

import pytest
from life.test_callbacks import CALLS, LAST, methods
from support.lasted import lasted
from support.wait import HANG

from yarpy import aio, network
from yarpy.data.stamp import Stamp
from yarpy.errors import NotAllowed, PortClosed, YarpError
from yarpy.nameserver.local import LocalNames
from yarpy.port.port import Port
from yarpy.qos import Qos
from yarpy.wire.message import Message

Act = Callable[[Any], Awaitable[None]]

OPEN: dict[type[aio.base.BasePort[Any]], Callable[..., Any]] = {
    aio.Port: lambda names, heard: aio.Port("/port", names=names, callback=heard),
    aio.BufferedPort: lambda names, heard: aio.BufferedPort("/port", names=names, callback=heard),
    aio.RpcClient: lambda names, heard: aio.RpcClient(name="/port", names=names),
    aio.RpcServer: lambda names, heard: aio.RpcServer("/port", heard, names=names),
}

# What ports of an event loop have besides; `port` is the one underneath.
MORE: dict[str, Callable[[Any], object]] = {
    "open": lambda port: port.open(),
    "port": lambda port: port.port,
}
KINDS = ["message", "connection", "end", "deadline", "admin", "page"]


class World:
    """A port of an event loop with one kind of callback, and others around it."""

    def __init__(self, kind: str, act: Act, port: type[aio.base.BasePort[Any]]) -> None:
        self.names = LocalNames()
        self._act = act
        self._done: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._begun = False
        self._tasks: list[asyncio.Task[None]] = []
        self.sink = Port("/sink", names=self.names, callback=lambda message: None)
        self.other = Port("/other", names=self.names)
        self.source = Port("/source", names=self.names)
        heard = self._call if kind == "message" else _nothing
        self.port = OPEN[port](self.names, heard)

    async def _call(self, *arguments: Any) -> Any:
        if self._begun:  # what we do has callbacks, too
            return
        self._begun = True
        try:
            await self._act(self.port)
        except BaseException as error:
            self._done.set_exception(error)
        else:
            self._done.set_result(None)

    def _begin(self, *arguments: Any) -> None:
        """For callbacks that are no coroutine functions."""
        self._tasks.append(asyncio.create_task(self._call()))

    async def message(self) -> None:
        self._in_thread(self.source.write, [1], timeout=HANG)

    async def connection(self) -> None:
        self.port.on_connection(self._begin)
        self._in_thread(self.source.connect, "/port", "tcp")

    async def end(self) -> None:
        self.port.on_connection(lambda event: None if event.created else self._begin())
        self._in_thread(self.source.disconnect, "/port")

    async def deadline(self) -> None:
        self.port.on_deadline(self._begin)
        self.port.inputs[0].qos = Qos(deadline=60)
        self._in_thread(self.source.write, [1], Stamp(1, time.time() - 100), timeout=HANG)

    async def admin(self) -> None:
        self.port.on_admin(self._call)
        self._in_thread(network.admin, "/port", "dance", names=self.names)

    async def page(self) -> None:
        self.port.on_page(self._call)
        self._in_thread(_get, f"http://{self.port.address}/")

    def _in_thread(self, function: Callable[..., object], *words: Any, **named: Any) -> None:
        """Call it in a thread; the port may be closed before it returns."""

        def call() -> None:
            with contextlib.suppress(YarpError, OSError):
                function(*words, **named)

        threading.Thread(target=call, daemon=True).start()

    async def happens(self, kind: str) -> None:
        try:
            await self.port.open()
            if not isinstance(self.port, aio.RpcServer):  # it has no outputs
                await self.port.connect("/sink", "tcp")
            if kind != "connection":
                await asyncio.to_thread(self.source.connect, "/port", "tcp")
                await self.port.wait_for_inputs(timeout=HANG)
            await getattr(self, kind)()
            await asyncio.wait_for(self._done, HANG)
        finally:
            await self.port.close()
            for port in (self.source, self.other, self.sink):
                await asyncio.to_thread(port.close)


async def _nothing(message: object) -> None:
    pass


def _get(url: str) -> None:
    with urllib.request.urlopen(url, timeout=HANG) as answer:
        answer.read()


def happens(kind: str, act: Act, port: type[aio.base.BasePort[Any]]) -> None:
    """Let `act` be done in a callback of this kind."""

    async def main() -> None:
        await World(kind, act, port).happens(kind)

    asyncio.run(main())


@pytest.mark.parametrize("port", OPEN)
@pytest.mark.parametrize("kind", KINDS)
def test_all_methods_one_after_another(
    kind: str, port: type[aio.base.BasePort[Any]], monkeypatch: pytest.MonkeyPatch
) -> None:
    if port is aio.RpcClient and kind in ("message", "deadline"):
        pytest.skip("a client takes no messages but the answers to its questions")
    monkeypatch.setenv("YARPY_LINGER", "10")  # for so long it would wait for itself
    calls = CALLS | MORE
    took: dict[str, float] = {}

    async def all_of_them(port: aio.base.BasePort[Any]) -> None:
        for method in [*sorted(methods(type(port)).difference(LAST)), *LAST]:
            begun = time.monotonic()
            try:
                found = calls[method](port)
                if isawaitable(found):
                    await found
            except PortClosed:
                assert method in ("read", "poll")  # there is nothing to read beside a callback
            except NotAllowed:
                assert (type(port), method) == (aio.RpcServer, "connect")  # it has no outputs
            took[method] = lasted(begun)

    happens(kind, all_of_them, port)
    assert set(took) == methods(port)
    # Neither waits for the thread that waits for the callback.
    assert took["close"] < 2.5
    assert took["inputs"] < 0.9


def test_a_handler_that_closes_its_server_is_not_cancelled() -> None:
    """Those of other questions are."""
    ended: list[str] = []

    async def main() -> None:
        names = LocalNames()
        other, over = asyncio.Event(), asyncio.Event()

        async def handle(message: Message) -> object:
            try:
                if message.value == ["wait"]:
                    other.set()
                    await asyncio.Event().wait()
                await server.close()
                ended.append("closed")
            except asyncio.CancelledError:
                ended.append("cancelled")
                raise
            finally:
                if message.value != ["wait"]:
                    over.set()
            return None

        server = await aio.RpcServer("/server", handle, names=names).open()
        async with aio.RpcClient("/server", names=names) as one:
            waiting = asyncio.create_task(one.call("wait"))
            await other.wait()
            async with aio.RpcClient("/server", names=names) as two:
                with contextlib.suppress(YarpError):  # its answer may still come, or not
                    await two.call("close", timeout=HANG)
                with contextlib.suppress(YarpError):
                    await asyncio.wait_for(waiting, HANG)
        await over.wait()  # the loop cancels what is still at work at its own end

    asyncio.run(asyncio.wait_for(main(), HANG))
    assert sorted(ended) == ["cancelled", "closed"]
