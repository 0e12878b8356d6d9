"""Reports: a connection came or went, in the words of C++."""

from __future__ import annotations

import logging
import socket

import pytest
from support.wait import wait_until

from yarpy import network
from yarpy.nameserver.local import LocalNames
from yarpy.port.event import ConnectionEvent
from yarpy.port.port import Port

TEXTS = [
    ((True, True), "Receiving input from /a to /b using tcp"),
    ((True, False), "Removing input from /a to /b"),
    ((False, True), "Sending output from /a to /b using tcp"),
    ((False, False), "Removing output from /a to /b"),
]


@pytest.mark.parametrize(("what", "text"), TEXTS)
def test_words(what: tuple[bool, bool], text: str) -> None:
    assert str(ConnectionEvent(*what, "/a", "/b", "tcp")) == text
    assert str(ConnectionEvent(*what, "/a", "/b", "tcp", "why")) == f"{text} (why)"


def test_both_sides_are_told(names: LocalNames, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.INFO, "yarpy")
    seen: list[ConnectionEvent] = []
    heard: list[ConnectionEvent] = []
    with (
        Port("/out", names=names, on_connection=seen.append) as out,
        Port("/in", names=names, on_connection=heard.append) as in_,
    ):
        out.connect("/in", "fast_tcp")
        wait_until(lambda: heard)
        network.ping("/in", names=names)  # tools are not reported
        network.exists("/in", names=names)
        out.disconnect("/in")
        wait_until(lambda: len(heard) == 2)
        assert seen == [
            ConnectionEvent(False, True, "/out", "/in", "fast_tcp"),
            ConnectionEvent(False, False, "/out", "/in", "fast_tcp"),
        ]
        assert heard == [
            ConnectionEvent(True, True, "/out", "/in", "fast_tcp"),
            ConnectionEvent(True, False, "/out", "/in", "fast_tcp"),
        ]
        wait_until(lambda: not in_.inputs)
    for text in ("Receiving input from /out to /in", "Removing output from /out to /in"):
        assert text in caplog.text
    assert "ping" not in caplog.text
    assert "admin" not in caplog.text


def test_failure_has_a_reason(names: LocalNames) -> None:
    heard: list[ConnectionEvent] = []
    with Port("/in", names=names) as in_:
        in_.on_connection(heard.append)
        with socket.create_connection(("127.0.0.1", in_.contact.port)) as sock:
            sock.sendall(b"CONNECT /stranger\r\n")
            wait_until(lambda: heard)
        wait_until(lambda: len(heard) == 2)
        assert not heard[1].created
        assert "closed the connection" in heard[1].reason
        in_.on_connection(None)
        with socket.create_connection(("127.0.0.1", in_.contact.port)) as sock:
            sock.sendall(b"CONNECT /stranger\r\n")
            wait_until(lambda: in_.inputs)
        wait_until(lambda: not in_.inputs)
        assert len(heard) == 2


def test_reversed_connection_is_an_input_that_becomes_an_output(names: LocalNames) -> None:
    seen: list[ConnectionEvent] = []
    with (
        Port("/out", names=names, on_connection=seen.append) as out,
        socket.create_connection(("127.0.0.1", out.contact.port)) as sock,
    ):
        sock.sendall(b"CONNECT /reader\r\nr\r\n")
        assert out.wait_for_outputs(timeout=5)
        assert [(e.incoming, e.created) for e in seen] == [(True, True), (False, True)]
        assert out.inputs == []
        assert out.outputs[0].target == "/reader"
        assert out.outputs[0].source == "/out"
