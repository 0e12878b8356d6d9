"""rpc_monitor: the copies that C++ YARP sends, and that nobody is held up by them."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.capture import load_capture
from support.monitor import place
from support.wait import HANG, wait_until

import yarpy
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.network.rpc_monitor import RpcMonitor

load = pytest.importorskip("yarpy.kits.thrift.library").load


@pytest.fixture
def server(names: yarpy.LocalNames) -> Iterator[yarpy.RpcServer]:
    def answer(message: yarpy.Message) -> Bottle:
        return Bottle([Vocab("ok"), "echo", message.value])

    with yarpy.RpcServer("/srv", answer, names=names) as made:
        yield made


def test_copies(names: yarpy.LocalNames, server: yarpy.RpcServer) -> None:
    with (
        yarpy.BufferedPort("/monitor", strict=True, names=names) as monitor,
        yarpy.RpcClient(name="/client", names=names) as client,
    ):
        client.connect("/srv", "tcp+send.rpc_monitor")
        assert client.call([1, "ping"]) == [Vocab("ok"), "echo", [1, "ping"]]
        asked, answered = monitor.read(timeout=HANG), monitor.read(timeout=HANG)
        assert asked is not None and answered is not None
        assert asked.source == "/client/monitor"
        ends = ["/client", "/srv"]
        empty: list[object] = []
        assert asked.value[1:] == [*ends, "command", "client", "RpcMonitor", ["1"], [1, "ping"], []]
        reply = [Vocab("ok"), "echo", [1, "ping"]]
        assert answered.value[1:] == [
            *ends,
            "reply",
            "rpc client",
            "RpcMonitor",
            empty,
            empty,
            reply,
        ]
        assert asked.value[0] <= answered.value[0]


def test_bytes_of_cpp() -> None:
    """All but the time."""
    names = yarpy.LocalNames()
    capture = load_capture("rpc_monitor_output")
    recorded = [step.data for step in capture.steps if step.sender == "a"][1:5]

    def answer(message: yarpy.Message) -> Bottle:
        return Bottle([Vocab("ok"), "echo", message.value])

    with (
        yarpy.RpcServer("/cap/srv3", answer, names=names),
        yarpy.BufferedPort("/monitor", strict=True, names=names) as monitor,
        yarpy.RpcClient(name="/cap/rc3", names=names) as client,
    ):
        client.connect("/cap/srv3", "tcp+send.rpc_monitor")
        for question in ([1, "ping"], ["hello"]):
            client.call(question)
        for data in recorded:
            copy = monitor.read(timeout=HANG)
            assert copy is not None
            payload = bytearray(copy.to_bytes())
            payload[12:20] = data[-len(payload) :][12:20]  # the time
            assert data.endswith(payload)


def test_another_port_looks_on(names: yarpy.LocalNames, server: yarpy.RpcServer) -> None:
    with (
        yarpy.BufferedPort("/eyes", strict=True, names=names) as monitor,
        yarpy.RpcClient(names=names) as client,
    ):
        client.connect("/srv", "tcp+send.rpc_monitor+monitor./eyes")
        client.call("hi")
        assert monitor.read(timeout=HANG)


def test_streams_are_copied_too_and_what_is_no_bottle_is_not(names: yarpy.LocalNames) -> None:
    with (
        yarpy.BufferedPort("/monitor", strict=True, names=names) as monitor,
        yarpy.BufferedPort("/in", strict=True, names=names) as in_,
        yarpy.Port("/out", names=names) as out,
    ):
        out.connect("/in", "tcp+send.rpc_monitor")
        sound = yarpy.Sound(np.arange(5))
        out.write(sound)
        out.write(["hi"])
        first = in_.read(timeout=HANG)
        assert first is not None and first.value == sound
        copies: list[Any] = [monitor.read(timeout=HANG) for _ in range(2)]
        assert [copy.value[6] for copy in copies] == [["[unknown]"], ["hi"]]


def test_nobody_looks_on(names: yarpy.LocalNames, server: yarpy.RpcServer) -> None:
    with yarpy.RpcClient(names=names) as client:
        with pytest.raises(yarpy.LocalProtocolError, match=r'no port "/monitor"'):
            client.connect("/srv", "tcp+send.rpc_monitor")
        client.connect("/srv")
        assert client.call("hi")


def test_who_looks_on_may_go_away(
    names: yarpy.LocalNames, server: yarpy.RpcServer, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.ERROR)
    with yarpy.RpcClient(names=names) as client:
        with yarpy.BufferedPort("/monitor", names=names):
            client.connect("/srv", "tcp+send.rpc_monitor")
            assert client.call("hi", timeout=HANG)
        for _ in range(5):
            assert client.call("hi", timeout=HANG)


def test_who_looks_on_without_reading_holds_nobody_up(
    names: yarpy.LocalNames, server: yarpy.RpcServer
) -> None:
    with yarpy.Port("/monitor", names=names), yarpy.RpcClient(names=names) as client:
        client.connect("/srv", "tcp+send.rpc_monitor")
        [monitor] = client._hub.outputs.links[0].chain.monitors  # type: ignore[union-attr]
        asked = 0
        while not monitor.parameters()["drops"]:
            assert client.call("hi", timeout=HANG)
            asked += 1
            assert asked < 5000
        assert 2 * asked > 1000


def test_only_at_the_callers_end() -> None:
    with pytest.raises(yarpy.LocalProtocolError, match="caller's end"):
        RpcMonitor(place())


def test_nothing_is_left_when_the_connection_ends(
    names: yarpy.LocalNames, server: yarpy.RpcServer
) -> None:
    with (
        yarpy.BufferedPort("/monitor", names=names) as monitor,
        yarpy.RpcClient(names=names) as client,
    ):
        client.connect("/srv", "tcp+send.rpc_monitor")
        wait_until(lambda: monitor.inputs)
        assert client.disconnect("/srv")
        wait_until(lambda: not monitor.inputs)


def test_calls_of_thrift(
    names: yarpy.LocalNames, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "camera.thrift").write_text(
        "service Camera { bool set_speed(1: double speed), void stop() } (yarp.monitor = 'true')"
    )
    monkeypatch.chdir(tmp_path)
    camera = load(tmp_path / "camera.thrift")

    class Camera(camera.Camera):  # type: ignore[misc, name-defined]
        def set_speed(self, speed: float) -> bool:
            return speed < 100

    with (
        yarpy.BufferedPort("/monitor", strict=True, names=names) as monitor,
        yarpy.RpcServer("/cam", Camera(), names=names),
        camera.connect("", name="/client", names=names) as client,
    ):
        client._port.connect("/cam", "tcp+send.rpc_monitor+interface.camera")
        assert client.set_speed(1.5) is True
        heard = [monitor.read(timeout=HANG) for _ in range(4)]
        assert heard[0] is not None and heard[0].value[7][0] == "getRemoteProtocolVersion"
        assert [message and message.value[3:] for message in heard[2:]] == [
            ["command", "client", "Camera", ["set_speed"], [1.5], []],
            ["reply", "rpc client", "Camera", ["set_speed"], [], ["ok"]],
        ]
        client._port.call("something", "else")
        heard = [monitor.read(timeout=HANG) for _ in range(2)]
        assert heard[0] is not None and heard[0].value[5:] == [
            "RpcMonitor",
            ["[unknown]"],
            ["something", "else"],
            [],
        ]


def test_interfaces_that_cannot_be_had(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bad.thrift").write_text("struct {}")
    for name, error in (("none", 'no file "none.thrift"'), ("bad", "bad.thrift:1:8: expected")):
        with pytest.raises(yarpy.LocalProtocolError, match=error):
            RpcMonitor(place(f"interface.{name}", sending=True))
    foreign = replace(place("interface.bad", sending=True), foreign=True)
    with pytest.raises(yarpy.LocalProtocolError, match="is for the program that owns the port"):
        RpcMonitor(foreign)
