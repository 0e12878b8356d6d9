"""Every method of every kind of port, in each of its callbacks: it returns, and does not wait for
itself."""

from __future__ import annotations

import threading
import time
import urllib.request
from collections.abc import Callable
from functools import partial
from typing import Any

import pytest
from support.lasted import lasted
from support.wait import HANG

from yarpy import network
from yarpy.data.stamp import Stamp
from yarpy.errors import NotAllowed, PortClosed, YarpError
from yarpy.nameserver.local import LocalNames
from yarpy.port.base import BasePort
from yarpy.port.port import BufferedPort, Port
from yarpy.port.rpc import RpcClient, RpcServer
from yarpy.qos import Qos


def _methods_of_no_service(client: RpcClient[Any]) -> None:
    with pytest.raises(TypeError):
        client.remote  # noqa: B018


# What is called, for each public name of a port.
CALLS: dict[str, Callable[[Any], object]] = {
    "address": lambda port: port.address,
    "ask": lambda port: port.ask("question", timeout=4.0),
    "attach": lambda port: port.attach("in", {"monitor": "throttleDown"}),
    "call": lambda port: port.call("question", timeout=4.0),
    "close": lambda port: port.close(),
    "closed": lambda port: port.closed,
    "connect": lambda port: port.connect("/sink", "tcp"),
    "contact": lambda port: port.contact,
    "detach": lambda port: port.detach("in"),
    "disconnect": lambda port: port.disconnect("/sink"),
    "flush": lambda port: port.flush(1.0),
    "inputs": lambda port: [link.close() for link in port.inputs],
    "interrupt": lambda port: port.interrupt(),
    "listen_to": lambda port: port.listen_to("/other", "tcp"),
    "name": lambda port: port.name,
    "on_admin": lambda port: port.on_admin(None),
    "on_connection": lambda port: port.on_connection(None),
    "on_deadline": lambda port: port.on_deadline(None),
    "on_page": lambda port: port.on_page(None),
    "outputs": lambda port: [link.close() for link in port.outputs],
    "poll": lambda port: port.poll(),
    "prepare": lambda port: port.prepare(3),
    "read": lambda port: port.read(timeout=0.05),
    "read_strictly": lambda port: port.read_strictly(True),
    "remote": lambda port: _methods_of_no_service(port),
    "resume": lambda port: port.resume(),
    "stats": lambda port: port.stats,
    "strict": lambda port: port.strict,
    "tell": lambda port: port.tell("news", timeout=4.0),
    "wait_for_inputs": lambda port: port.wait_for_inputs(2, timeout=0.05),
    "wait_for_outputs": lambda port: port.wait_for_outputs(2, timeout=0.05),
    "waiting": lambda port: port.waiting,
    "write": lambda port: port.write([1], timeout=4.0),
}


OPEN: dict[type[BasePort], Callable[..., BasePort]] = {
    Port: lambda names, heard: Port("/port", names=names, callback=heard),
    BufferedPort: lambda names, heard: BufferedPort("/port", names=names, callback=heard),
    RpcClient: lambda names, heard: RpcClient(name="/port", names=names),
    RpcServer: lambda names, heard: RpcServer("/port", heard, names=names),
}


def methods(kind: type[BasePort]) -> set[str]:
    return {name for name in dir(kind) if not name.startswith("_")}


def test_nothing_public_is_left_out() -> None:
    assert set(CALLS) == set[str]().union(*map(methods, OPEN))


class World:
    """A port with one kind of callback, and others around it."""

    def __init__(
        self, kind: str, act: Callable[[Any], object], port: type[BasePort] = Port
    ) -> None:
        self.names = LocalNames()
        self.done = threading.Event()
        self.took = 0.0
        self.error: BaseException | None = None
        self._act = act
        self._begun = False
        self.sink = Port("/sink", names=self.names, callback=lambda message: None)
        self.other = Port("/other", names=self.names)
        self.source = Port("/source", names=self.names)
        on_message = self._call if kind == "message" else lambda message: None
        self.port = OPEN[port](self.names, on_message)
        if port is not RpcServer:  # it has no outputs
            self.port.connect("/sink", "tcp")

    def _call(self, *arguments: Any) -> Any:
        if self._begun:  # what we do has callbacks, too
            return None
        self._begun = True
        begun = time.monotonic()
        try:
            self._act(self.port)
        except BaseException as error:
            self.error = error
        self.took = lasted(begun)
        self.done.set()
        return None

    def message(self) -> None:
        self.source.connect("/port", "tcp")
        self.source.write([1], timeout=HANG)

    def connection(self) -> None:
        self.port.on_connection(self._call)
        self.source.connect("/port", "tcp")

    def end(self) -> None:
        self.source.connect("/port", "tcp")
        self.port.wait_for_inputs(timeout=HANG)
        self.port.on_connection(lambda event: None if event.created else self._call())
        self.source.disconnect("/port")

    def deadline(self) -> None:
        self.port.on_deadline(self._call)
        self.source.connect("/port", "tcp")
        self.port.wait_for_inputs(timeout=HANG)
        self.port.inputs[0].qos = Qos(deadline=60)
        self.source.write([1], Stamp(1, time.time() - 100), timeout=HANG)

    def admin(self) -> None:
        self.port.on_admin(self._call)
        threading.Thread(target=self._ask, daemon=True).start()

    def _ask(self) -> None:
        try:
            network.admin("/port", "dance", names=self.names)
        except YarpError:
            pass  # the port may be closed before it answers

    def page(self) -> None:
        self.port.on_page(self._call)
        url = f"http://{self.port.address}/"
        threading.Thread(target=partial(_get, url), daemon=True).start()

    def close(self) -> None:
        for port in (self.source, self.other, self.port, self.sink):
            port.close()


def _get(url: str) -> None:
    try:
        with urllib.request.urlopen(url, timeout=HANG) as answer:
            answer.read()
    except OSError:
        pass  # the port may be closed before it answers


KINDS = ["message", "connection", "end", "deadline", "admin", "page"]
# After these the others have nothing more to do.
LAST = ("inputs", "outputs", "disconnect", "interrupt", "close")


def happens(kind: str, act: Callable[[Any], object], port: type[BasePort] = Port) -> World:
    """Return what came of `act` in a callback of this kind."""
    world = World(kind, act, port)
    try:
        getattr(world, kind)()
        assert world.done.wait(HANG), "it waits for itself"
        return world
    finally:
        world.close()


@pytest.mark.parametrize("method", [name for name in CALLS if hasattr(Port, name)])
@pytest.mark.parametrize("kind", KINDS)
def test_every_method_in_every_callback(kind: str, method: str) -> None:
    world = happens(kind, CALLS[method])
    if isinstance(world.error, PortClosed):
        assert method in ("read", "poll")  # there is nothing to read beside a callback
    else:
        assert world.error is None
    assert world.took < 5.0
    if method in ("close", "inputs"):
        assert world.took < 0.9  # it does not wait for the thread that it is called in


@pytest.mark.parametrize("port", [kind for kind in OPEN if kind is not Port])
@pytest.mark.parametrize("kind", KINDS)
def test_all_methods_of_other_ports_one_after_another(kind: str, port: type[BasePort]) -> None:
    if port is RpcClient and kind in ("message", "deadline"):
        pytest.skip("a client takes no messages but the answers to its questions")
    done: list[str] = []

    def all_of_them(port: BasePort) -> None:
        found = methods(type(port))
        for method in [*sorted(found.difference(LAST)), *LAST]:
            try:
                CALLS[method](port)
            except PortClosed:
                assert method in ("read", "poll")  # there is nothing to read beside a callback
            except NotAllowed:
                assert (type(port), method) == (RpcServer, "connect")  # it has no outputs
            done.append(method)

    world = happens(kind, all_of_them, port)
    assert world.error is None, f"in what follows {done[-1:]}"
    assert set(done) == methods(port)
