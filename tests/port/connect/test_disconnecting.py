"""Disconnecting: what becomes of both ends."""

from __future__ import annotations

import socket

import pytest
from support.wait import HANG, wait_until

from yarpy.nameserver.local import LocalNames
from yarpy.port.connect import disconnecting
from yarpy.port.port import BufferedPort, Port


def test_connectionless_goodbye_reaches_the_receiver(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        for carrier in ("udp", "mcast"):
            out.connect("/in", carrier)
            assert in_.wait_for_inputs(timeout=HANG)
            assert disconnecting.disconnect_output(out._hub, "/in") == (
                True,
                "Removed connection from /out to /in",
            )
            assert in_.inputs == []  # it was asked, and has answered
        assert disconnecting.disconnect_output(out._hub, "/in") == (
            False,
            "Could not find an outgoing connection to /in",
        )


def test_inputs_are_removed_on_request(names: LocalNames) -> None:
    with Port("/in", names=names) as in_:
        socks = [socket.create_connection(("127.0.0.1", in_.contact.port)) for _ in range(2)]
        for sock in socks:
            sock.sendall(b"CONNECT visitor\r\n")
        wait_until(lambda: len(in_.inputs) == 2)
        assert disconnecting.disconnect_input(in_._hub, "visitor") == (
            True,
            "Removing connection from visitor to /in",
        )
        assert in_.inputs == []
        assert disconnecting.disconnect_input(in_._hub, "visitor") == (
            False,
            "Could not find an incoming connection from visitor",
        )
        for sock in socks:
            sock.settimeout(5)
            assert sock.recv(100) == b"Welcome visitor\r\n"
            assert sock.recv(100) == b""
            sock.close()


@pytest.mark.parametrize("carrier", ["http", "websocket", "text", "fast_tcp"])
def test_a_reader_that_had_all_and_went_first_is_no_warning(
    names: LocalNames, carrier: str, caplog: pytest.LogCaptureFixture
) -> None:
    with BufferedPort("/in", names=names, strict=True) as reader:
        with Port("/out", names=names) as out:
            out.connect("/in", carrier)
            for number in range(5):
                out.write([number])
            for number in range(5):
                assert reader.read(timeout=HANG).value == [number]
            reader.close()
        assert "may have arrived" not in caplog.text
