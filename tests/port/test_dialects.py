"""Readers of YARP 3 and of YARP 4 at one port: each gets its own, nothing before it is known."""

import threading

import pytest
from support.guest import guest
from support.wait import HANG, wait_until
from support.yarp4 import administer_as_yarp4

from yarpy.data.bottle import Bottle
from yarpy.data.stamp import Stamp
from yarpy.data.yarp4 import to_yarp4
from yarpy.errors import LinkClosed, Timeout
from yarpy.nameserver.local import LocalNames
from yarpy.port import port as port_module
from yarpy.port.dialects import Dialects
from yarpy.port.port import BufferedPort, Port
from yarpy.port.rpc import RpcClient, RpcServer


@pytest.fixture
def source(names: LocalNames):
    with BufferedPort("/out", names=names) as port:
        yield port


def test_ports_of_yarpy_are_of_yarp_3(source: BufferedPort, names: LocalNames) -> None:
    dialects = Dialects(source)
    assert not dialects and dialects.write(list, list) == 0
    with Port("/in", names=names) as reader:
        source.connect("/in")
        wait_until(lambda: bool(dialects))
        sent = dialects.write(lambda: [1.5], lambda: pytest.fail("not asked for"), Stamp(3, 4.5))
        assert sent == 1
        message = reader.read(HANG)
        assert message.value == [1.5] and message.stamp == Stamp(3, 4.5)
    source.disconnect("/in")
    wait_until(lambda: not dialects)


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "udp"])
def test_a_plain_port_writes_as_its_reader_reads(carrier: str, names: LocalNames) -> None:
    """A reader of YARP 3 beside one of YARP 4."""
    with (
        Port("/out", names=names) as out,
        BufferedPort("/old", strict=True, names=names) as old,
        BufferedPort("/new", strict=True, names=names) as new,
    ):
        out.connect("/old", carrier)
        out.connect("/new", carrier)
        out._hub.outputs.links[1].route.yarp4 = True
        for value in ([1.5], ["the same"]):
            out.write(value)
            assert old.read(HANG).to_bytes() == Bottle(value).to_bytes()
            assert new.read(HANG).to_bytes() == to_yarp4(Bottle(value).to_bytes())
        assert to_yarp4(Bottle([1.5]).to_bytes()) != Bottle([1.5]).to_bytes()


def test_a_group_whose_readers_are_all_of_yarp_4(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    older, newer = Bottle([1.5]).to_bytes(), to_yarp4(Bottle([1.5]).to_bytes())
    with (
        Port("/out", names=names) as out,
        BufferedPort("/one", strict=True, names=names) as one,
        BufferedPort("/two", strict=True, names=names) as two,
    ):
        with monkeypatch.context() as patch:
            administer_as_yarp4(patch)
            out.connect("/one", "mcast")
        out.write([1.5])
        assert one.read(HANG).to_bytes() == newer
        out.connect("/two", "mcast")  # of YARP 3
        out.write([1.5])
        assert one.read(HANG).to_bytes() == two.read(HANG).to_bytes() == older
        out.disconnect("/two")
        out.write([1.5])
        assert one.read(HANG).to_bytes() == newer


def test_questions_too(names: LocalNames) -> None:
    asked: list[bytes] = []
    with (
        RpcServer("/server", lambda message: asked.append(message.to_bytes()), names=names),
        RpcClient("/server", names=names) as client,
    ):
        client._hub.outputs.links[0].route.yarp4 = True
        client.call(1.5, timeout=HANG)
    assert asked == [to_yarp4(Bottle([1.5]).to_bytes())]


def test_who_knows_no_yarp_is_not_asked_which(
    source: BufferedPort, names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    guest("zmq")
    asked: list[str] = []
    monkeypatch.setattr(
        port_module.MessagePort, "_is_yarp4", lambda port, target: asked.append(target)
    )
    dialects = Dialects(source)
    with BufferedPort("/socket", names=names) as socket:
        source.connect("/socket", "zmq+push")
        wait_until(lambda: dialects.write(lambda: ["3"], lambda: pytest.fail("not asked for")) == 1)
        assert socket.read(HANG).value == ["3"]
    assert asked == []


def test_each_reader_gets_its_own(
    source: BufferedPort, names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[str] = []
    go_on = threading.Event()

    def is_yarp4(port: object, target: str) -> bool:
        asked.append(target)
        if target == "/slow":
            go_on.wait()
            raise Timeout("it is silent")
        return target == "/four"

    monkeypatch.setattr(port_module.MessagePort, "_is_yarp4", is_yarp4)
    dialects = Dialects(source)
    with (
        BufferedPort("/three", names=names) as three,
        BufferedPort("/four", names=names) as four,
        BufferedPort("/slow", names=names) as slow,
        BufferedPort("/text", names=names) as text,
    ):
        for target in ("/three", "/four", "/slow"):
            source.connect(target)
        source.connect("/text", "text")
        made: list[int] = []
        wait_until(lambda: dialects.write(lambda: made.append(3) or ["3"], lambda: ["4"]) == 3)
        assert three.read(HANG).value == ["3"] and four.read(HANG).value == ["4"]
        assert text.read(HANG).value == ["3"]
        assert made and sorted(asked) == ["/four", "/slow", "/three"]
        assert slow.poll() is None
        go_on.set()
        wait_until(lambda: dialects.write(lambda: ["3"], lambda: ["4"]) == 4)
        assert slow.read(HANG).value == ["3"]
        assert len(asked) == 3


def test_how_it_is_found_out(
    source: BufferedPort, names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    with Port("/in", names=names):
        assert source._is_yarp4("/in") is False
        administer_as_yarp4(monkeypatch)
        assert source._is_yarp4("/in") is True
    with pytest.raises(LinkClosed):
        source._is_yarp4("/127.0.0.1:9")
    assert source._is_yarp4("/nobody") is False
