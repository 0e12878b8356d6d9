"""Messages go to the port they were meant for, whoever listens at its number by now."""

from __future__ import annotations

import logging
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from support.listener import listening
from support.port import free_port
from support.wait import HANG, wait_until

import yarpy
from yarpy import BufferedPort, Port, RpcClient, RpcServer
from yarpy.contact import Contact
from yarpy.errors import LinkClosed, Timeout, WrongPort
from yarpy.nameserver.local import LocalNames
from yarpy.port.connect import identity, probe
from yarpy.route import Route

SETTLED = 1.5  # seconds in which a connection that is dialled again would be there long since


def move(names: LocalNames, name: str, port: Port | BufferedPort | RpcServer) -> None:
    """What a name service remembers of `name` is the number of `port`."""
    names.register(name, "tcp", "127.0.0.1", port.contact.port)
    names.set(name, "process", 1)  # as ports say, and nobody by hand


def break_inputs(port: BufferedPort | RpcServer) -> None:
    """As a crash would: without a goodbye."""
    for link in port._hub.inputs.links:
        link.driver.transport.interrupt()


@contextmanager
def speaking(answer: bytes) -> Iterator[Contact]:
    """Something that takes connections, says `answer`, and is no port of YARP."""

    def serve(sock: socket.socket) -> None:
        if answer:
            with sock:
                sock.recv(100)
                sock.sendall(answer)

    with listening(serve) as (port, _):
        yield Contact("tcp", "", "127.0.0.1", port)


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "text", "unix_stream", "local"])
def test_a_broken_connection_is_not_dialled_to_another_port(
    carrier: str, names: LocalNames, caplog: pytest.LogCaptureFixture
) -> None:
    with (
        Port("/camera", names=names) as camera,
        BufferedPort("/viewer", names=names) as viewer,
        BufferedPort("/motor", names=names) as motor,
    ):
        camera.connect("/viewer", carrier)
        move(names, "/viewer", motor)
        break_inputs(viewer)
        deadline = time.monotonic() + SETTLED
        while time.monotonic() < deadline:
            camera.write(["for the viewer"])
            time.sleep(0.01)
        assert not motor.inputs and motor.poll() is None
        move(names, "/viewer", viewer)
        assert camera.wait_for_outputs(timeout=HANG)
        assert [link.name for link in camera.outputs] == ["/viewer"]


@pytest.mark.parametrize("carrier", ["tcp", "udp", "mcast", "text", "unix_stream", "mjpeg"])
def test_a_name_with_the_number_of_another_port_is_not_connected(
    carrier: str, names: LocalNames
) -> None:
    with BufferedPort("/camera", names=names) as camera, BufferedPort("/motor", names=names) as m:
        move(names, "/viewer", m)
        with pytest.raises(WrongPort, match=r'"/motor" listens .*, not "/viewer"'):
            camera.connect("/viewer", carrier)
        assert not m.inputs and not camera.outputs and not camera.inputs and not m.outputs


def test_a_port_is_asked_by_its_own_name_too(names: LocalNames) -> None:
    """`yarpy connect` of ports that cannot ask, such as those of C++, asks for them."""
    with Port("/motor", names=names) as motor, BufferedPort("/viewer", names=names) as viewer:
        move(names, "/camera", motor)
        with pytest.raises(WrongPort, match='not "/camera"'):
            viewer.listen_to("/camera")
        with pytest.raises(WrongPort, match='not "/camera"'):
            yarpy.connect("/camera", "/viewer", names=names)
        with pytest.raises(WrongPort, match='not "/camera"'):
            yarpy.connect("/viewer", "/camera", names=names)
        assert not motor.outputs and not motor.inputs


def test_a_question_is_not_asked_of_another_server(names: LocalNames) -> None:
    asked: list[object] = []
    with RpcServer("/arm", lambda m: asked.append(m.value), names=names) as arm:
        with RpcServer("/hand", lambda m: ["hand"], names=names):
            client = RpcClient("/hand", names=names)
            assert client.call("open") == ["hand"]
        move(names, "/hand", arm)
        wait_until(lambda: not client.outputs)
        with pytest.raises(WrongPort, match='not "/hand"'):
            client.call("down")
        assert not asked
        with RpcServer("/other", lambda m: ["hand again"], names=names) as other:
            names.register("/hand", "tcp", "127.0.0.1", other.contact.port)  # an alias, by hand
            with pytest.raises(WrongPort, match='not "/hand"'):
                client.call("down")
            client.connect("/hand")
            assert client.call("open") == ["hand again"]
        client.close()


def test_an_address_leads_to_the_same_port_again_or_nowhere(names: LocalNames) -> None:
    with Port("/camera", names=names) as camera:
        number = free_port()
        viewer = BufferedPort("/viewer", names=names, tcp_port=number)
        camera.connect(f"/127.0.0.1:{number}")
        wait_until(lambda: camera._hub.outputs.links[0].route.peer == "/viewer")
        crash(viewer)
        with BufferedPort("/motor", names=names, tcp_port=number) as motor:
            wait_until(lambda: not camera.write(["for the viewer"]))
            time.sleep(SETTLED)
            assert not motor.inputs and motor.poll() is None
        with BufferedPort("/viewer2", names=names):
            names.unregister("/viewer")
        with BufferedPort("/viewer", names=names, tcp_port=number) as viewer:
            assert camera.wait_for_outputs(timeout=HANG)
            assert viewer.wait_for_inputs(timeout=HANG)


def crash(port: BufferedPort) -> None:
    """End a port without a goodbye, and leave its name behind."""
    hub = port._hub
    hub.life.closing = True  # nothing is dialled again, nobody is told
    hub.reception.close()
    break_inputs(port)
    wait_until(lambda: not hub.inputs.links)


def test_a_name_given_by_hand_may_lead_anywhere(names: LocalNames) -> None:
    """`yarpy name register /alias tcp HOST PORT`: there is no port that calls itself like that."""
    with Port("/out", names=names) as out, BufferedPort("/in", names=names) as in_:
        names.register("/alias", "tcp", "127.0.0.1", in_.contact.port)
        out.connect("/alias")
        out.write(["by its alias"])
        assert in_.read(timeout=HANG).value == ["by its alias"]
        before = out._hub.outputs.links
        break_inputs(in_)
        wait_until(
            lambda: out._hub.outputs.links not in ((), before), 10, "the same port as before"
        )
        with BufferedPort("/other", names=names) as other:
            names.register("/alias", "tcp", "127.0.0.1", other.contact.port)
            break_inputs(in_)
            time.sleep(SETTLED)
            assert not other.inputs, "once it led to /in"


def test_who_cannot_say_its_name_is_not_dialled_again(
    names: LocalNames, caplog: pytest.LogCaptureFixture
) -> None:
    with speaking(b"I am a toaster\r\n") as toaster, Port("/out", names=names) as out:
        names.register("/toaster", "text", toaster.host, toaster.port)
        with caplog.at_level(logging.WARNING, "yarpy.port"):
            for target in ("/toaster", f"/{toaster.address}"):
                caplog.clear()
                out.connect(target, "text")
                wait_until(lambda: not (out.write(["hello"]) or out.outputs))
                wait_until(lambda: "is not dialled again by itself" in caplog.text)
                assert toaster.address in caplog.text or target in caplog.text
        time.sleep(0.5)
        assert not out.outputs


def test_what_breaks_while_its_listener_is_asked_comes_back(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The answer comes from a busy machine, after the connection has broken."""
    introduce, asked = probe.introduce, threading.Event()

    def late(*arguments: Any) -> probe.Listener:
        assert asked.wait(HANG)
        return introduce(*arguments)

    monkeypatch.setattr(probe, "introduce", late)
    # The receiver, which knows no other names, asks for nothing.
    with BufferedPort("/in", names=LocalNames()) as in_, Port("/out", names=names) as out:
        out.connect(f"/{in_.address}")
        wait_until(lambda: in_.inputs)
        break_inputs(in_)
        wait_until(lambda: not out.outputs)
        time.sleep(0.3)
        assert not out.outputs, "nobody knows yet who answers there"
        asked.set()
        assert out.wait_for_outputs(timeout=HANG)


def test_a_silent_program_at_a_port_s_number_gets_nothing(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A program that is stopped, and nobody knows which."""
    monkeypatch.setattr(identity, "TIMEOUT", 0.2)
    with speaking(b"") as stopped, Port("/out", names=names) as out:
        names.register("/viewer", "tcp", stopped.host, stopped.port)
        names.set("/viewer", "process", 1)
        with pytest.raises(LinkClosed, match="does not say who it is"):
            out.connect("/viewer", "text")
        names.set("/viewer", "process")  # no port told that it is there
        out.connect("/viewer", "text")


def test_confirming(names: LocalNames) -> None:
    with Port("/here", names=names) as port:
        contact = port.contact
        assert identity.confirm(contact, names.get, b"") == ("/here", False)
        assert identity.confirm(Contact("mjpeg", "/here", "127.0.0.1", 1), names.get, b"") == (
            "",
            False,
        )
        assert identity.confirm(Contact("tcp", "", "127.0.0.1", 1), names.get, b"") == ("", False)
        route = Route("/x", "/here", "tcp", peer="/here")
        identity.confirm_again(contact, route, b"")
        route.peer = "/there"
        with pytest.raises(WrongPort, match=r'"/here" listens .*, not "/there"'):
            identity.confirm_again(contact, route, b"")
    with pytest.raises(LinkClosed):
        identity.confirm(contact, names.get, b"")
    with speaking(b"") as silent, pytest.raises(Timeout, match="may be stopped"):
        identity.confirm_again(silent, route, b"", timeout=0.2)
