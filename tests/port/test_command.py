"""Port commands: how destinations are understood, and what becomes of connections."""

from __future__ import annotations

import socket
import threading

import pytest
from support.wait import wait_until

import yarpy
from yarpy.errors import LocalProtocolError, UnknownPlugin
from yarpy.nameserver.local import LocalNames
from yarpy.port import command
from yarpy.port.buffered import BufferedPort
from yarpy.port.port import Port
from yarpy.port.rpc import RpcServer

JOINED = [
    # destination, carrier, as one text
    ("/in", "", "/in"),
    ("/in", "tcp", "tcp://in"),
    ("/in", "tcp+recv.x", "tcp+recv.x://in"),
    ("udp://in", "tcp", "tcp://in"),
    ("/127.0.0.1:10002", "tcp", "tcp://127.0.0.1:10002"),
    ("tcp://127.0.0.1:10002/", "udp", "udp://127.0.0.1:10002"),
]


@pytest.mark.parametrize(("destination", "carrier", "text"), JOINED)
def test_destination_and_carrier_as_one(destination: str, carrier: str, text: str) -> None:
    assert command.joined(destination, carrier) == text


REFUSALS = [
    ("/none", "Do not know how to connect to /none"),
    ("", "Do not know how to connect to "),
    ("nosuch://in", "Cannot connect to nosuch://in"),
    ("tcp+log.out://in", "Logger configured as log.out, but only log.in is supported"),
    ("/127.0.0.1:99999999", "Do not know how to connect to /127.0.0.1:99999999"),
    ("/127.0.0.1:1", "Cannot connect to /127.0.0.1:1"),
    ("no_slash", "Do not know how to connect to no_slash"),
]


@pytest.mark.parametrize(("text", "line"), REFUSALS)
def test_refusals_are_the_lines_of_cpp(text: str, line: str, names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names):
        with pytest.raises(command.Refused) as caught:
            command.connect(out._hub, text)
        assert str(caught.value) == line
        assert out.outputs == []


def test_refusal_knows_more_for_programs(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names):
        with pytest.raises(command.Refused) as caught:
            command.connect(out._hub, "nosuch://in")
        assert isinstance(caught.value.__cause__, UnknownPlugin)


def test_refusal_says_what_a_peer_does_not_like(names: LocalNames) -> None:
    """Where somebody answers, it is known why; and nobody sees the password."""
    said = {b"HTTP/1.1 500 No\r\n\r\n": "Cannot connect to", b"HTTP/1.1 401 \r\n\r\n": "Not admit"}
    for answer, begins in said.items():
        with socket.create_server(("127.0.0.1", 0)) as camera, Port("/out", names=names) as out:

            def serve(camera: socket.socket = camera, answer: bytes = answer) -> None:
                for _ in range(2):
                    sock, _ = camera.accept()
                    with sock:
                        sock.recv(1000)
                        sock.sendall(answer)

            threading.Thread(target=serve, daemon=True).start()
            address = f"127.0.0.1:{camera.getsockname()[1]}"
            with pytest.raises(command.Refused) as caught:
                command.connect(out._hub, f"mjpeg+user.a+password.b://{address}")
            line = str(caught.value)
            assert line.startswith(begins)
            assert f"mjpeg+user.a+password.***://{address}: " in line
            assert line.endswith(str(caught.value.__cause__))


@pytest.mark.parametrize(
    ("carrier", "words"),
    [
        ("websocket+recv.throttleDown", "websocket does not tell the receiver of throttleDown"),
        ("xmlrpc+recv.a+recv.b", "xmlrpc does not tell the receiver of a, b"),
        ("mjpeg+send.throttleDown", "mjpeg does not tell the sender of throttleDown"),
    ],
)
def test_monitor_that_the_other_end_would_not_hear_of(
    carrier: str, words: str, names: LocalNames
) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names):
        with pytest.raises(LocalProtocolError, match=words):
            out.connect("/in", carrier)
        assert not out.outputs and not out.inputs


def test_what_stands_in_parentheses_is_the_parameter_of_a_monitor(names: LocalNames) -> None:
    carrier = "tcp+send.throttleDown+period_ms.1+(note a+log.in b)"
    with Port("/out", names=names) as out, BufferedPort("/in", names=names) as in_:
        out.connect("/in", carrier)
        assert [link.carrier for link in out.outputs] == [carrier]
        assert out.write([1]) == 1
        assert in_.read(timeout=5).value == [1]


def test_what_is_fetched_is_an_input_at_once_or_refused(names: LocalNames) -> None:
    """Who dials a camera is the receiver, and hears what is wrong with its own monitors."""
    with Port("/camera", names=names) as camera, Port("/view", names=names) as view:
        with pytest.raises(UnknownPlugin, match="nosuch"):
            view.connect("/camera", "mjpeg+recv.nosuch")
        assert not view.inputs
        view.connect("/camera", "mjpeg+recv.throttleDown+period_ms.5")
        assert [link.source for link in view.inputs] == ["/camera"]
        told = yarpy.admin("/view", "get", "in", "/camera", names=names)
        assert told == [[["period_ms", 5.0]]]
        wait_until(lambda: len(camera.outputs) == 1)


def test_description_lists_every_connection(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        assert command.describe(out._hub) == [
            f"This is /out at tcp://{out.address}/",
            "There are no outgoing connections",
            "There are no incoming connections",
        ]
        out.connect("/in", "udp")
        assert in_.wait_for_inputs(timeout=5)
        assert command.describe(out._hub)[1] == (
            "There is an output connection from /out to /in using udp"
        )
        assert command.describe(in_._hub)[2] == (
            "There is an input connection from /out to /in using udp"
        )


def test_connectionless_goodbye_reaches_the_receiver(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        for carrier in ("udp", "mcast"):
            out.connect("/in", carrier)
            assert in_.wait_for_inputs(timeout=5)
            assert command.disconnect_output(out._hub, "/in") == (
                True,
                "Removed connection from /out to /in",
            )
            assert in_.inputs == []  # it was asked, and has answered
        assert command.disconnect_output(out._hub, "/in") == (
            False,
            "Could not find an outgoing connection to /in",
        )


def test_inputs_are_removed_on_request(names: LocalNames) -> None:
    with Port("/in", names=names) as in_:
        socks = [socket.create_connection(("127.0.0.1", in_.contact.port)) for _ in range(2)]
        for sock in socks:
            sock.sendall(b"CONNECT visitor\r\n")
        wait_until(lambda: len(in_.inputs) == 2)
        assert command.disconnect_input(in_._hub, "visitor") == (
            True,
            "Removing connection from visitor to /in",
        )
        assert in_.inputs == []
        assert command.disconnect_input(in_._hub, "visitor") == (
            False,
            "Could not find an incoming connection from visitor",
        )
        for sock in socks:
            sock.settimeout(5)
            assert sock.recv(100) == b"Welcome visitor\r\n"
            assert sock.recv(100) == b""
            sock.close()


def test_port_without_outputs(names: LocalNames) -> None:
    with RpcServer("/server", lambda m: None, names=names) as server, Port("/in", names=names):
        with pytest.raises(command.Refused, match="Outputs not allowed"):
            command.connect(server._hub, "/in")
        # a connection for the log is allowed
        line = command.connect(server._hub, "tcp+log.in://in")
        assert "will forward messages and replies" in line


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "udp", "mcast", "text_ack"])
def test_nothing_is_lost_after_connecting(carrier: str, names: LocalNames) -> None:
    """What is written right after `connect` arrives, over datagrams too."""
    with (
        Port("/out", names=names) as out,
        BufferedPort("/in", strict=True, names=names) as in_,
    ):
        for turn in range(6):
            out.connect("/in", carrier)
            out.write([turn])
            assert in_.read(timeout=5).value == [turn]
