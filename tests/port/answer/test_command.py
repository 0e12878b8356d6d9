"""Port commands: how destinations are understood, and what becomes of connections."""

from __future__ import annotations

import socket

import pytest
from support.listener import listening
from support.wait import HANG

from yarpy.nameserver.local import LocalNames
from yarpy.port.answer import command
from yarpy.port.port import Port
from yarpy.port.rpc import RpcServer

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
        done, said = command.connect(out._hub, text)
        assert not done
        assert said.partition(": ")[0] == line
        assert out.outputs == []


def test_refusal_says_what_a_peer_does_not_like(names: LocalNames) -> None:
    """Where somebody answers, it is known why; and nobody sees the password."""
    said = {b"HTTP/1.1 500 No\r\n\r\n": "Cannot connect to", b"HTTP/1.1 401 \r\n\r\n": "Not admit"}
    for answer, begins in said.items():

        def serve(sock: socket.socket, answer: bytes = answer) -> None:
            with sock:
                sock.recv(1000)
                sock.sendall(answer)

        with listening(serve) as (port, _), Port("/out", names=names) as out:
            address = f"127.0.0.1:{port}"
            done, line = command.connect(out._hub, f"mjpeg+user.a+password.b://{address}")
            assert not done
            assert line.startswith(begins)
            assert f"mjpeg+user.a+password.***://{address}: " in line


def test_description_lists_every_connection(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        assert command.describe(out._hub) == [
            f"This is /out at tcp://{out.address}/",
            "There are no outgoing connections",
            "There are no incoming connections",
        ]
        out.connect("/in", "udp")
        assert in_.wait_for_inputs(timeout=HANG)
        assert command.describe(out._hub)[1] == (
            "There is an output connection from /out to /in using udp"
        )
        # Its sender may be asking at this moment how much came, over a connection of its own.
        assert "There is an input connection from /out to /in using udp" in command.describe(
            in_._hub
        )


def test_name_that_is_too_long_is_told_so(names: LocalNames) -> None:
    with Port("/in", names=names) as in_:
        with socket.create_connection(("127.0.0.1", in_.contact.port)) as sock:
            sock.settimeout(5)
            sock.sendall(b"CONNECT " + b"x" * 3000 + b"\r\n")
            assert sock.makefile("rb").read() == b"* Error. A name has at most 1000 bytes.\r\n"
        assert in_.inputs == []


def test_port_without_outputs(names: LocalNames) -> None:
    with RpcServer("/server", lambda m: None, names=names) as server, Port("/in", names=names):
        assert command.connect(server._hub, "/in") == (False, "Outputs not allowed")
        # a connection for the log is allowed
        _, line = command.connect(server._hub, "tcp+log.in://in")
        assert "will forward messages and replies" in line
