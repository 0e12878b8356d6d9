"""The modes: what runs in place of a method, once somebody has chosen a side for it.

    mode        the body runs    what it returns is sent    listens
    publish     yes              yes
    listen                                                  to what it would return
    serve       for clients      to the client
    call                         (its arguments are)        to the answer
    relay       yes              yes                        first, to its first parameters
    exchange    yes              yes                        then, to what it would return
    receive     yes                                         first, to its first parameters
    off
    plain       yes

Rules: a mode waits for others only where its name says so. `timeout` is the method's, unless a call
gives another; a parameter of that name is the method's own. In a coroutine nothing blocks the loop.
"""

from __future__ import annotations

import asyncio
import inspect
import threading
import weakref
from collections.abc import AsyncIterator, Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, ClassVar

from yarpy.errors import LocalProtocolError, PortClosed
from yarpy.kits.wrap.flow import Inlets, Outlets
from yarpy.kits.wrap.method import Method, Output, middleware_of
from yarpy.kits.wrap.middleware import Client, Failure, Item, Received, Server
from yarpy.kits.wrap.value.shape import Shape
from yarpy.log import logger

log = logger("yarpy.wrap")

Function = Callable[..., Any]


class Mode:
    """A chosen side. `stop` is set once it has ended."""

    name: ClassVar[str] = ""
    streams: ClassVar[bool] = True  # whether a generator can have it

    def __init__(self, method: Method, instance: Any, outputs: Sequence[Output]) -> None:
        if not outputs:
            raise LocalProtocolError(f"{method.qualname} has no decorator `wrap.on`")
        if not self.streams and method.kind.endswith("generator"):
            raise LocalProtocolError(
                f"{method.qualname} is a generator, which can be published and listened to; "
                f"{self.name} needs a function"
            )
        self.method = method
        self.bound = instance is not None
        self.outlets: Outlets | None = None
        self.inlets: Inlets | None = None
        self.stop = threading.Event()
        self.tie: Any = None  # to the object whose method it is
        self._own = "timeout" in method.signature.parameters
        self._single = len(outputs) == 1

    # -- what the decorator calls -----------------------------------------------------------------

    def run(self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        """In place of a function."""
        raise NotImplementedError

    async def run_async(self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        """In place of a coroutine function."""
        raise NotImplementedError

    def stream(
        self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]
    ) -> Iterator[Any]:
        """In place of a generator."""
        raise NotImplementedError

    def stream_async(
        self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]
    ) -> AsyncIterator[Any]:
        """In place of an asynchronous generator."""
        raise NotImplementedError

    # -- what the others share --------------------------------------------------------------------

    def timeout(self, kwargs: dict[str, Any]) -> float | None:
        """The timeout of this call, taken from its arguments."""
        if self._own or "timeout" not in kwargs:
            return self.method.timeout
        found: float | None = kwargs.pop("timeout")
        return found

    def listened(self, values: list[Any]) -> Any:
        """Return the result of a listening call: a value, or a tuple."""
        return values[0] if self._single else tuple(values)

    @property
    def last(self) -> list[Received | None]:
        return self.inlets.last if self.inlets is not None else []

    @property
    def stats(self) -> list[dict[str, Any]]:
        found = self.outlets.stats if self.outlets is not None else []
        return found + (self.inlets.stats if self.inlets is not None else [])

    def close(self) -> None:
        self.stop.set()
        if self.outlets is not None:
            self.outlets.close()
        if self.inlets is not None:
            self.inlets.close()


def _results(
    method: Method, outputs: Sequence[Output], source: bool = False
) -> list[tuple[Output, str, Shape]]:
    """Return the places to listen to for the results of a method."""
    return [
        (output, (output.source if source else "") or output.topic, shape)
        for output, shape in zip(outputs, method.shapes(), strict=True)
    ]


def _parameters(
    method: Method, outputs: Sequence[Output], bound: bool
) -> list[tuple[Output, str, Shape]]:
    """Return the places to listen to for the first parameters of a method."""
    shapes = method.inputs(bound)
    return [
        (output, output.source or output.topic, shape)
        for output, shape in zip(outputs, shapes, strict=True)
    ]


class Publish(Mode):
    name = "publish"

    def __init__(self, method: Method, instance: Any, outputs: Sequence[Output]) -> None:
        super().__init__(method, instance, outputs)
        self.outlets = Outlets(method, outputs)
        self._send = self.outlets.send
        # What may keep the sender waiting does not do so in an event loop.
        self._patient = bool(method.wait) or any(one.keep == "all" for one in outputs)

    def run(self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        value = func(*args, **kwargs)
        self._send(value)
        return value

    async def run_async(self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        value = await func(*args, **kwargs)
        await self._send_async(value)
        return value

    async def _send_async(self, value: Any) -> None:
        if self._patient:
            await asyncio.to_thread(self._send, value)
        else:
            self._send(value)

    def stream(
        self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]
    ) -> Iterator[Any]:
        for value in func(*args, **kwargs):
            self._send(value)
            yield value

    async def stream_async(
        self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]
    ) -> AsyncIterator[Any]:
        async for value in func(*args, **kwargs):
            await self._send_async(value)
            yield value


class Listen(Mode):
    name = "listen"

    def __init__(self, method: Method, instance: Any, outputs: Sequence[Output]) -> None:
        super().__init__(method, instance, outputs)
        self.inlets = Inlets(method, _results(method, outputs))
        self._listen = self.inlets.listen
        self._listen_to_one = self.inlets.listen_to_one
        self._listen_async = self.inlets.listen_async

    def run(self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        timeout = self.timeout(kwargs) if kwargs else self.method.timeout
        if self._single:
            return self._listen_to_one(timeout)
        return self.listened(self._listen(timeout))

    async def run_async(self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        return self.listened(await self._listen_async(self.timeout(kwargs)))

    def stream(
        self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]
    ) -> Iterator[Any]:
        return self.values(self.timeout(kwargs))

    def stream_async(
        self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]
    ) -> AsyncIterator[Any]:
        return self.values_async(self.timeout(kwargs))

    def values(self, timeout: float | None) -> Iterator[Any]:
        """Yield one value after the other, until this ends."""
        while True:
            try:
                yield self.listened(self._listen(timeout))
            except PortClosed:
                return

    async def values_async(self, timeout: float | None) -> AsyncIterator[Any]:
        """The same in an event loop."""
        while True:
            try:
                yield self.listened(await self._listen_async(timeout))
            except PortClosed:
                return


class Relay(Mode):
    """Listens, runs the body with what came, and publishes what that returns."""

    name = "relay"
    streams = False

    def __init__(self, method: Method, instance: Any, outputs: Sequence[Output]) -> None:
        super().__init__(method, instance, outputs)
        places = _parameters(method, outputs, self.bound)
        self._publishes(method, outputs)
        try:
            self.inlets = Inlets(method, places)
        except BaseException:
            self.close()
            raise

    def _publishes(self, method: Method, outputs: Sequence[Output]) -> None:
        self.outlets = Outlets(method, outputs)

    def run(self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        assert self.inlets is not None
        values = self.inlets.listen(self.timeout(kwargs))
        first = args[: self.bound]
        value = func(*first, *values, *args[self.bound :], **kwargs)
        if self.outlets is not None:
            self.outlets.send(value)
        return value

    async def run_async(self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        assert self.inlets is not None
        values = await self.inlets.listen_async(self.timeout(kwargs))
        first = args[: self.bound]
        value = await func(*first, *values, *args[self.bound :], **kwargs)
        if self.outlets is not None:
            await asyncio.to_thread(self.outlets.send, value)
        return value


class Receive(Relay):
    """Listens, and runs the body with what came."""

    name = "receive"

    def _publishes(self, method: Method, outputs: Sequence[Output]) -> None:
        pass


class Exchange(Mode):
    """Runs the body, publishes what it returns, and returns what others publish."""

    name = "exchange"
    streams = False

    def __init__(self, method: Method, instance: Any, outputs: Sequence[Output]) -> None:
        super().__init__(method, instance, outputs)
        for output in outputs:
            if not output.source:
                raise LocalProtocolError(
                    f'{method.qualname} would hear itself: give "{output.topic}" a source= to '
                    "listen to"
                )
        self.outlets = Outlets(method, outputs)
        try:
            self.inlets = Inlets(method, _results(method, outputs, source=True))
        except BaseException:
            self.close()
            raise

    def run(self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        assert self.outlets is not None and self.inlets is not None
        timeout = self.timeout(kwargs)
        self.outlets.send(func(*args, **kwargs))
        return self.listened(self.inlets.listen(timeout))

    async def run_async(self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        assert self.outlets is not None and self.inlets is not None
        timeout = self.timeout(kwargs)
        await asyncio.to_thread(self.outlets.send, await func(*args, **kwargs))
        return self.listened(await self.inlets.listen_async(timeout))


class Off(Mode):
    """Neither runs nor speaks: None, or a tuple of None."""

    name = "off"

    def run(self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        return None if self._single else (None,) * len(self.method.outputs)

    async def run_async(self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        return self.run(func, args, kwargs)

    def stream(
        self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]
    ) -> Iterator[Any]:
        return iter(())

    async def stream_async(
        self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]
    ) -> AsyncIterator[Any]:
        return
        yield


class Serve(Mode):
    """Runs the body for clients, in threads of their connections. Calls of this program run it
    too, as if nothing were."""

    name = "serve"
    streams = False

    def __init__(self, method: Method, instance: Any, outputs: Sequence[Output]) -> None:
        super().__init__(method, instance, outputs)
        self._exact = method.exact(self.bound)
        self._instance = instance if inspect.isclass(instance) else None
        self._reference = None if instance is self._instance else _weak(instance)
        try:
            self._loop: asyncio.AbstractEventLoop | None = asyncio.get_running_loop()
        except RuntimeError:
            self._loop = None
        self._servers: list[Server] = []
        try:
            for binding in outputs[0].bindings(outputs[0].topic, method.called(self.bound)):
                server = middleware_of(binding).server(binding, method.name, self.answer)
                self._servers.append(server)
        except BaseException:
            self.close()
            raise

    def answer(self, args: list[Any], kwargs: dict[str, Any]) -> Item | Failure:
        """Return a client's answer for these arguments."""
        method = self.method
        reference = self._reference
        instance = self._instance if reference is None else reference()
        try:
            if instance is None and reference is not None:
                raise PortClosed("the object whose method this is does not exist any more")
            if kwargs or tuple(map(type, args)) != self._exact:
                args, kwargs = method.load(instance, args, kwargs)
            if instance is None:
                value = method.func(*args, **kwargs)
            else:
                value = method.func(instance, *args, **kwargs)
            if method.kind == "coroutine":
                value = self._waited(value)
            shape = method.result
            plain = value if type(value) is shape.exact else shape.dump(value)
            return Item(plain, shape, source=method.qualname)
        except Exception as error:
            log.info("%s: %s: %s", method.qualname, type(error).__name__, error)
            return Failure.of(error)

    def _waited(self, coroutine: Any) -> Any:
        if self._loop is None or self._loop.is_closed():
            return asyncio.run(coroutine)
        return asyncio.run_coroutine_threadsafe(coroutine, self._loop).result()

    def run(self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        return func(*args, **kwargs)

    async def run_async(self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        return await func(*args, **kwargs)

    def close(self) -> None:
        super().close()
        for server in self._servers:
            server.close()


def _weak(instance: Any) -> Callable[[], Any]:
    """A reference that does not keep its object alive, where that is possible."""
    try:
        return weakref.ref(instance)
    except TypeError:
        return lambda: instance


class Call(Mode):
    """Asks a server, which runs the body."""

    name = "call"
    streams = False

    def __init__(self, method: Method, instance: Any, outputs: Sequence[Output]) -> None:
        super().__init__(method, instance, outputs)
        self._exact = method.exact(self.bound)
        binding = outputs[0].bindings(outputs[0].topic, method.called(self.bound))[0]
        self._client: Client = middleware_of(binding).client(binding, method.result)
        self._pool: ThreadPoolExecutor | None = None

    def run(self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        method = self.method
        asked = args[self.bound :]
        if not kwargs and tuple(map(type, asked)) == self._exact:
            return self._client.call(method.name, [*asked], kwargs, method.timeout)
        timeout = self.timeout(kwargs)
        instance = args[0] if self.bound else None
        return self._client.call(method.name, *method.dump(instance, asked, kwargs), timeout)

    async def run_async(self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        if self._pool is None:
            self._pool = ThreadPoolExecutor(64, f"yarpy wrap {self.method.name}")
        loop = asyncio.get_running_loop()
        return await loop.run_in_executor(self._pool, self.run, func, args, kwargs)

    def close(self) -> None:
        super().close()
        self._client.close()
        if self._pool is not None:
            self._pool.shutdown(wait=False)


class Plain(Mode):
    """As without a mode: what a file says of one object among others."""

    name = "plain"

    def run(self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        return func(*args, **kwargs)

    async def run_async(self, func: Function, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        return await func(*args, **kwargs)

    stream = stream_async = run


MODES = {
    kind.name: kind for kind in (Publish, Listen, Serve, Call, Relay, Exchange, Receive, Off, Plain)
}
