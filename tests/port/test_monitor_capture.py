"""Recorded dialogues about monitors: priority, and portmonitor with a small plug-in of the tests.

The plug-in of the recording, `capmon`, appended a word to each Bottle, dropped those that began
with "drop", and remembered its parameters.
"""

from __future__ import annotations

import logging
import socket
import threading
from collections.abc import Iterator
from typing import Any

import pytest
from support.capture import Capture, groups, load_capture
from support.live import World, hear, nothing_more, replay, say
from support.wait import HANG, wait_until

from yarpy import registry
from yarpy.data.bottle import Property
from yarpy.monitors.base import Place
from yarpy.port.port import Port
from yarpy.wire.message import Message


class Capmon:
    def __init__(self, place: Place) -> None:
        self._word = "mon-send" if place.sending else "mon-recv"
        self._parameters: dict[str, Any] = {"level": 1}

    def accept(self, message: Message) -> bool:
        return bool(message.value[0] != "drop")

    def update(self, message: Message) -> object:
        return [*message.value, self._word]

    def configure(self, parameters: Property) -> None:
        self._parameters.update(parameters)

    def parameters(self) -> dict[str, Any]:
        return self._parameters


@pytest.fixture(autouse=True)
def capmon(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.chdir(tmp_path)
    registry.monitors.add("capmon", Capmon)
    yield
    registry.monitors.remove("capmon")


PLUGIN = "portmonitor+type.dll+file"
CARRIERS = {
    "priority_recv": "tcp+recv.priority",
    "priority_recv_ex": "fast_tcp+recv.priority+ex.(/cap/out2,-10)",
    "priority_recv_params": "tcp+recv.priority+tc.0.5+tr.0.1+st.10+bs.20+virtual.1",
    "portmonitor_recv": f"tcp+recv.{PLUGIN}.capmon",
    "portmonitor_recv_dll": f"tcp+recv.{PLUGIN}.rpc_monitor",
    "portmonitor_send": f"tcp+send.{PLUGIN}.capmon",
    "portmonitor_send_dll": f"tcp+send.{PLUGIN}.rpc_monitor",
    "portmonitor_lua": "tcp+recv.portmonitor+type.lua+file.x+context.ctx",
}
MESSAGES = [[1, "ping", 3.14], ["drop", "this"], [2]]


def administrative(base: str) -> list[str]:
    """What was asked about that connection, in order; the first made it."""
    names = groups()["priority"] + groups()["portmonitor"]
    return sorted(name for name in names if name.startswith(f"{base}_admin_"))


def ask(world: World, capture: Capture) -> None:
    with world.dial(capture.roles["b"].split()[-1]) as sock:
        replay(sock, capture, 0)
        nothing_more(sock)


@pytest.mark.parametrize("base", CARRIERS)
def test_questions_about_a_connection(base: str) -> None:
    with World() as world:
        world.port("/cap/in")
        source = world.port("/cap/out")
        assert isinstance(source, Port)
        asked = administrative(base)
        assert asked
        if not asked[0].endswith("_1"):
            source.connect("/cap/in", CARRIERS[base])
        for name in asked:
            ask(world, load_capture(name))
            if name.endswith("_admin_1") and source.outputs:
                assert source.outputs[0].carrier == CARRIERS[base]


def test_monitor_of_a_port() -> None:
    capture = load_capture("portmonitor_attach_port")
    with World() as world:
        for number in range(1 + max(step.connection for step in capture.steps)):
            steps = [step for step in capture.steps if step.connection == number]
            with world.dial("/cap/am") as sock:
                for said, answered in zip(steps[::2], steps[1::2], strict=True):
                    say(sock, said.data, 0)
                    assert hear(sock, len(answered.data)) == answered.data


@pytest.mark.parametrize("piece", [0, 1], ids=["whole", "bytewise"])
@pytest.mark.parametrize(
    ("name", "heard"),
    [
        ("priority_recv", MESSAGES[:1]),
        ("priority_recv_ex", MESSAGES[:1]),
        ("priority_recv_params", []),
        ("portmonitor_recv", [[1, "ping", 3.14, "mon-recv"], [2, "mon-recv"]]),
        ("portmonitor_missing", []),
        ("portmonitor_recv_dll", []),
        ("portmonitor_lua", []),
    ],
)
def test_messages_that_come(
    name: str, heard: list[object], piece: int, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.WARNING)
    capture = load_capture(name)
    with World() as world:
        with world.dial("/cap/in") as sock:
            replay(sock, capture, piece)
            nothing_more(sock)
        wait_until(lambda: not world.port("/cap/in").inputs)
        assert [message.value for message in world.heard] == heard
        # C++ hangs up with the first message, and tells its reader no more than we do.
        refused = name in ("portmonitor_missing", "portmonitor_recv_dll", "portmonitor_lua")
        if refused:
            wait_until(lambda: "refused: " in caplog.text)  # said once the peer has been told
    assert ("refused: " in caplog.text) is refused


def test_messages_that_go() -> None:
    """What our sender says to the recorded receiver, byte for byte."""
    capture = load_capture("portmonitor_send")
    with socket.create_server(("127.0.0.1", 0)) as server, World() as world:
        server.settimeout(HANG)
        source = world.port("/cap/out")
        assert isinstance(source, Port)
        world.names.register("/cap/in", "tcp", "127.0.0.1", server.getsockname()[1])
        said: list[bytes] = []

        def receive() -> None:
            server.accept()[0].close()  # who is there, it is asked first: it cannot say
            sock, _ = server.accept()
            with sock:
                sock.settimeout(HANG)
                for step in capture.steps:
                    if step.sender == "a":
                        said.append(hear(sock, len(step.data)))
                    else:
                        say(sock, step.data, 0)

        thread = threading.Thread(target=receive)
        thread.start()
        source.connect("/cap/in", CARRIERS["portmonitor_send"])
        for value in MESSAGES:
            assert source.write(value) == (value[0] != "drop")
        source.disconnect("/cap/in")
        thread.join(HANG)
        assert said == [step.data for step in capture.steps if step.sender == "a"]
