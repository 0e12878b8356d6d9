"""Every method of a port, in each of its callbacks: it returns, and does not wait for itself."""

from __future__ import annotations

import threading
import time
import urllib.request
from collections.abc import Callable
from functools import partial
from typing import Any

import pytest
from support.wait import HANG

from yarpy import network
from yarpy.data.stamp import Stamp
from yarpy.errors import PortClosed, YarpError
from yarpy.nameserver.local import LocalNames
from yarpy.port.port import Port
from yarpy.qos import Qos

# What is called, for each public name of a port.
CALLS: dict[str, Callable[[Port], object]] = {
    "address": lambda port: port.address,
    "ask": lambda port: port.ask("question", timeout=0.2),
    "attach": lambda port: port.attach("in", {"monitor": "throttleDown"}),
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
    "resume": lambda port: port.resume(),
    "stats": lambda port: port.stats,
    "wait_for_inputs": lambda port: port.wait_for_inputs(2, timeout=0.05),
    "wait_for_outputs": lambda port: port.wait_for_outputs(2, timeout=0.05),
    "waiting": lambda port: port.waiting,
    "write": lambda port: port.write([1], timeout=1.0),
}


def test_nothing_public_is_left_out() -> None:
    assert set(CALLS) == {name for name in dir(Port) if not name.startswith("_")}


class World:
    """A port with one kind of callback, and others around it."""

    def __init__(self, kind: str, act: Callable[[Port], object]) -> None:
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
        self.port = Port("/port", names=self.names, callback=on_message)
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
        self.took = time.monotonic() - begun
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
        urllib.request.urlopen(url, timeout=HANG).read()
    except OSError:
        pass  # the port may be closed before it answers


@pytest.mark.parametrize("method", CALLS)
@pytest.mark.parametrize("kind", ["message", "connection", "end", "deadline", "admin", "page"])
def test_every_method_in_every_callback(kind: str, method: str) -> None:
    world = World(kind, CALLS[method])
    try:
        getattr(world, kind)()
        assert world.done.wait(HANG), "it waits for itself"
        if isinstance(world.error, PortClosed):
            assert method in ("read", "poll")  # there is nothing to read beside a callback
        else:
            assert world.error is None
        assert world.took < 5.0
        if method in ("close", "inputs"):
            assert world.took < 0.9  # it does not wait for the thread that it is called in
    finally:
        world.close()
