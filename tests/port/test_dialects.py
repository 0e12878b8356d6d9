"""Readers of YARP 3 and of YARP 4 at one port: each gets its own, nothing before it is known."""

import threading
from types import SimpleNamespace

import pytest
from support.guest import guest
from support.wait import HANG, wait_until

from yarpy.data.stamp import Stamp
from yarpy.errors import LinkClosed, Timeout
from yarpy.nameserver.local import LocalNames
from yarpy.port import port as port_module
from yarpy.port.answer import admin
from yarpy.port.dialects import Dialects
from yarpy.port.port import BufferedPort, Port


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
        # YARP 4 has no commands of ROS.
        monkeypatch.setattr(admin, "graphs", SimpleNamespace(call=lambda name: None))
        assert source._is_yarp4("/in") is True
    with pytest.raises(LinkClosed):
        source._is_yarp4("/127.0.0.1:9")
    assert source._is_yarp4("/nobody") is False
