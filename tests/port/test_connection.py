"""What a user sees of a connection, and hears of one that comes or goes."""

from __future__ import annotations

import logging
import socket
import time

import pytest
from support.wait import HANG, wait_until

from yarpy import network
from yarpy.nameserver.local import LocalNames
from yarpy.port.connection import ConnectionEvent
from yarpy.port.port import Port


def test_who_over_what_and_how_it_is_doing(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in", "tcp+peer_timeout.9")
        out.write([1], wait=False)
        in_.read(timeout=HANG)
        (output,) = out.outputs
        (input_,) = in_.inputs
        for connection in (output, input_):
            assert (connection.source, connection.target) == ("/out", "/in")
            assert connection.carrier == "tcp+peer_timeout.9"
            assert repr(connection) == "<Connection /out -> /in (tcp+peer_timeout.9)>"
            stats = connection.stats
            assert stats.messages == 1
            assert stats.drops == 0
            assert stats.bytes > 0
            assert stats.rate == 0.0  # after one message there is none
        assert output.name == "/in"
        assert input_.name == "/out"


def test_rate_and_jitter_are_measured(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in")
        for number in range(50):
            out.write([number])
            in_.read(timeout=HANG)
        for connection in (*out.outputs, *in_.inputs):
            stats = connection.stats
            assert 0 < stats.rate <= 1 / stats.period
            assert stats.jitter >= 0


def test_either_side_may_end_it(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in")
        assert in_.wait_for_inputs(timeout=HANG)
        out.outputs[0].close()
        assert out.outputs == []
        wait_until(lambda: not in_.inputs)
        out.connect("/in")
        assert in_.wait_for_inputs(timeout=HANG)
        in_.inputs[0].close()
        wait_until(lambda: not in_.inputs)
        assert out.outputs == []  # its sender was told,
        time.sleep(0.7)
        assert in_.inputs == []  # and does not dial again


# ---------------------------------------------------------------------------------- events

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
        assert out.wait_for_outputs(timeout=HANG)
        # The output is there a moment before it is told.
        wait_until(lambda: len(seen) == 2)
        assert [(e.incoming, e.created) for e in seen] == [(True, True), (False, True)]
        assert out.inputs == []
        assert out.outputs[0].target == "/reader"
        assert out.outputs[0].source == "/out"
