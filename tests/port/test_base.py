"""What every kind of port can do."""

from __future__ import annotations

import copy
import gc
import pickle
import threading
import time
import warnings
import weakref

import pytest
from support.lasted import lasted
from support.wait import HANG, wait_until

from yarpy import network
from yarpy.errors import (
    LinkClosed,
    LocalProtocolError,
    PortClosed,
    UnknownName,
    UnknownPlugin,
)
from yarpy.nameserver.local import LocalNames
from yarpy.port.base import BasePort
from yarpy.port.port import BufferedPort, Port
from yarpy.port.rpc import RpcClient, RpcServer
from yarpy.wire.message import Message


def make(kind: str, names: LocalNames) -> BasePort:
    if kind == "Port":
        return Port("/it", names=names)
    if kind == "BufferedPort":
        return BufferedPort("/it", names=names)
    if kind == "RpcServer":
        return RpcServer("/it", lambda message: None, names=names)
    return RpcClient(name="/it", names=names)


@pytest.mark.parametrize("kind", ["Port", "BufferedPort", "RpcServer", "RpcClient"])
def test_every_kind_is_a_port(kind: str, names: LocalNames) -> None:
    with make(kind, names) as port:
        assert isinstance(port, BasePort)
        assert port.name == "/it"
        assert port.address == f"127.0.0.1:{port.contact.port}"
        assert repr(port) == f"<{kind} /it ({port.address})>"
        assert (port.inputs, port.outputs, port.closed) == ([], [], False)
        assert network.exists("/it", names=names)
        assert network.ping("/it", names=names)[0] == f"This is /it at tcp://{port.address}/"
    assert port.closed
    assert repr(port) == f"<{kind} /it (closed)>"
    port.close()
    assert not network.exists("/it", names=names)


@pytest.mark.parametrize("kind", ["Port", "BufferedPort", "RpcServer", "RpcClient"])
def test_a_port_is_not_copied(kind: str, names: LocalNames) -> None:
    """Whoever dropped the copy would close the port."""
    with make(kind, names) as port:
        for attempt in (copy.copy, copy.deepcopy, pickle.dumps):
            with pytest.raises(TypeError, match=r'"/it" can be neither copied nor pickled: .*name'):
                attempt(port)
        gc.collect()
        assert not port.closed


# ---------------------------------------------------------------------------------- connecting


def test_connecting_in_every_spelling(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        address = f"127.0.0.1:{in_.contact.port}"
        for target, carrier, seen in (
            ("/in", "tcp", ("/in", "tcp")),
            ("/in", "fast_tcp", ("/in", "fast_tcp")),
            ("udp://in", "tcp", ("/in", "udp")),
            (f"/{address}", "tcp", (f"/{address}/", "tcp")),
            (f"tcp://{address}/", "tcp", (f"/{address}/", "tcp")),
            (address, "fast_tcp", (f"/{address}/", "fast_tcp")),
        ):
            made = out.connect(target, carrier)
            (connection,) = out.outputs
            assert (made.target, made.carrier) == seen
            assert (connection.target, connection.carrier) == seen
            assert in_.wait_for_inputs(timeout=HANG)
            out.write([target])
            assert in_.read(timeout=HANG).value == [target]
            assert out.disconnect(target)
            wait_until(lambda: not in_.inputs)
        assert not out.disconnect("/in")


def test_what_can_go_wrong_says_what_to_do(names: LocalNames) -> None:
    with (
        Port("/out", names=names) as out,
        Port("/in", names=names),
        RpcServer("/server", lambda m: None, names=names) as server,
    ):
        with pytest.raises(UnknownName, match='did you mean "/in"'):
            out.connect("/inn")
        with pytest.raises(UnknownName, match="yarpy name list"):
            out.connect("/nothing/like/it")
        with pytest.raises(UnknownPlugin, match='did you mean "tcp"'):
            out.connect("/in", "tpc")
        with pytest.raises(LinkClosed):
            out.connect("/127.0.0.1:1")
        with pytest.raises(LocalProtocolError, match="Outputs not allowed"):
            server.connect("/in")
        assert out.outputs == []


def test_failed_connect_keeps_the_others(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names):
        out.connect("/in")
        with pytest.raises(UnknownName):
            out.connect("/none")
        with pytest.raises(UnknownPlugin):
            out.connect("/in", "nosuch")
        assert [o.target for o in out.outputs] == ["/in"]


def test_waiting_for_a_port_that_comes_later(names: LocalNames) -> None:
    with Port("/out", names=names) as out:
        started = time.monotonic()
        with pytest.raises(UnknownName):
            out.connect("/in", timeout=0.1)
        assert time.monotonic() - started > 0.05  # a clock of Windows ticks every 16 ms
        assert lasted(started) < 10
        later: list[Port] = []
        threading.Timer(0.1, lambda: later.append(Port("/in", names=names))).start()
        out.connect("/in", timeout=HANG)
        assert out.write([1]) == 1
        wait_until(lambda: later)  # it is there before its constructor has ended
        assert later[0].read(timeout=HANG).value == [1]
        later[0].close()


def test_asking_somebody_to_send_here(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        in_.listen_to("/out", "fast_tcp")
        assert [(o.target, o.carrier) for o in out.outputs] == [("/in", "fast_tcp")]
        out.write([1])
        assert in_.read(timeout=HANG).value == [1]
        with pytest.raises(UnknownName):
            in_.listen_to("/none")
        with (
            RpcServer("/server", lambda m: None, names=names),
            pytest.raises(LocalProtocolError, match="Outputs not allowed"),
        ):
            in_.listen_to("/server")


def test_waiting_for_connections(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        assert not out.wait_for_outputs(timeout=0.02)
        assert not in_.wait_for_inputs(timeout=0.02)
        later = threading.Timer(0.05, out.connect, ("/in",))
        later.start()
        assert in_.wait_for_inputs(timeout=HANG)
        assert out.wait_for_outputs(timeout=HANG)
        later.join()
        assert not out.wait_for_outputs(2, timeout=0.02)
        for wrong in ("1", None, 1.5):
            with pytest.raises(TypeError, match="`count` is a number of connections, not"):
                in_.wait_for_inputs(wrong)


def test_connection_to_oneself_can_be_made_and_ended(names: LocalNames) -> None:
    """Deleting such a connection deadlocks the C++ port."""
    with BufferedPort("/it", strict=True, names=names) as port:
        port.connect("/it")
        port.write([1])
        assert port.read(timeout=HANG).value == [1]
        assert network.disconnect("/it", "/it", names=names)
        wait_until(lambda: not port.inputs and not port.outputs)
        port.connect("/it")
        started = time.monotonic()
    assert lasted(started) < 10


# ---------------------------------------------------------------------------------- administration


def test_own_administrative_commands(names: LocalNames) -> None:
    with Port("/it", names=names) as port:
        asked: list[Message] = []

        def answer(message: Message) -> object:
            asked.append(message)
            return ["mine", message.value[0]] if message.value[0] == "known" else None

        port.on_admin(answer)
        assert network.admin("/it", "known", 1, names=names) == ["mine", "known"]
        assert network.admin("/it", "unknown", names=names)[0] == "fail"
        assert network.admin("/it", "ver", names=names)[0] == "ver"
        assert len(asked) == 2
        port.on_admin(None)
        assert network.admin("/it", "known", names=names)[0] == "fail"


def test_closed_port_refuses(names: LocalNames) -> None:
    port = Port("/it", names=names)
    port.close()
    with pytest.raises(PortClosed, match='"/it" is closed'):
        port.write([1])
    with Port("/in", names=names), pytest.raises(PortClosed):
        port.connect("/in")
    assert port.outputs == []


@pytest.mark.parametrize("kind", [Port, BufferedPort])
def test_dropped_port_is_closed_and_named(
    kind: type[Port] | type[BufferedPort], names: LocalNames
) -> None:
    port = kind("/dropped", names=names)
    with pytest.warns(ResourceWarning, match='port "/dropped" was dropped without being closed'):
        del port
        gc.collect()
    wait_until(lambda: names.query("/dropped") is None)


def test_closed_port_may_be_dropped(names: LocalNames) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with Port("/it", names=names) as port:
            pass
        del port
        gc.collect()


class Program:
    """Has a port whose callback is a method of its own, as programs do."""

    def __init__(self, kind: str, names: LocalNames) -> None:
        if kind == "callback":
            self.port: BasePort = Port("/dropped", names=names, callback=self.take)
        elif kind == "buffered callback":
            self.port = BufferedPort("/dropped", names=names, callback=self.take)
        elif kind == "server":
            self.port = RpcServer("/dropped", self.take, names=names)
        elif kind == "on_connection":
            self.port = Port("/dropped", names=names, on_connection=self.take)
        else:
            self.port = BufferedPort("/dropped", names=names)
            for call in (self.port.on_page, self.port.on_admin, self.port.on_deadline):
                call(self.take)  # type: ignore[operator]

    def take(self, *what: object) -> None:
        pass


@pytest.mark.parametrize(
    "kind", ["callback", "buffered callback", "server", "on_connection", "on all others"]
)
def test_a_port_whose_callbacks_know_it_is_dropped_too(kind: str, names: LocalNames) -> None:
    program = Program(kind, names)
    with Port("/writer", names=names) as writer:
        writer.connect("/dropped")
        alive = weakref.ref(program)
        with pytest.warns(ResourceWarning, match='port "/dropped" was dropped without being'):
            del program
            # A thread of the connection may be at work with it still.
            wait_until(lambda: gc.collect() >= 0 and alive() is None)
        wait_until(lambda: names.query("/dropped") is None)


def test_a_callback_that_nobody_else_knows_is_kept(names: LocalNames) -> None:
    class Hearer:
        __slots__ = ("came",)  # takes no weak references

        def __init__(self, came: list[object]) -> None:
            self.came = came

        def __call__(self, message: object) -> None:
            self.came.append(message)

    came: list[object] = []
    with (
        Port("/in", names=names, callback=Hearer(came)),
        Port("/also", names=names, callback=lambda message: came.append(message)),
        Port("/out", names=names) as out,
    ):
        gc.collect()
        for target in ("/in", "/also"):
            out.connect(target)
        out.write([1], wait=True)
        wait_until(lambda: len(came) == 2)
