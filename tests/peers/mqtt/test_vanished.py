"""Clients that vanish: their promise of signs of life is held against them, and their wills."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from contextlib import contextmanager

import paho.mqtt.client as paho
import pytest
from support.paho_client import end
from support.wait import HANG, wait_until

import yarpy
from yarpy.peers.mqtt import packet as mqtt

CLEAN, WILL = 2, 4


@contextmanager
def client(
    port: yarpy.Port, keep_alive: int, version: int = 4, will: bytes = b""
) -> Iterator[socket.socket]:
    """A raw client that has been welcomed."""
    flags = CLEAN | (WILL if will else 0)
    extra = b"\0" if version == 5 else b""
    body = mqtt.string(b"MQTT") + bytes((version, flags)) + keep_alive.to_bytes(2, "big") + extra
    body += mqtt.string(b"me") + (extra + mqtt.string(b"end") + mqtt.string(will) if will else b"")
    with socket.create_connection((port.contact.host, port.contact.port), HANG) as sock:
        sock.sendall(mqtt.packet(mqtt.CONNECT, body))
        first = sock.recv(2, socket.MSG_WAITALL)
        assert first[0] == mqtt.CONNACK
        assert not sock.recv(first[1], socket.MSG_WAITALL)[1]
        yield sock


def subscribed(sock: socket.socket) -> None:
    sock.sendall(mqtt.packet(mqtt.SUBSCRIBE | 2, b"\0\1" + mqtt.string(b"#") + b"\0"))
    assert sock.recv(5, socket.MSG_WAITALL)[0] == mqtt.SUBACK


def test_a_silent_writer_is_taken_for_gone(names: yarpy.LocalNames) -> None:
    with yarpy.BufferedPort("/in", names=names) as port, client(port, 1) as sock:
        wait_until(lambda: port.inputs)
        assert sock.recv(1) == b""  # after one and a half seconds
        wait_until(lambda: not port.inputs)


def test_a_silent_reader_is_taken_for_gone(
    names: yarpy.LocalNames, caplog: pytest.LogCaptureFixture
) -> None:
    with yarpy.Port("/out", names=names) as port, client(port, 1) as sock:
        subscribed(sock)
        wait_until(lambda: port.outputs)
        assert sock.recv(1) == b""
        wait_until(lambda: not port.outputs)
    assert "no sign of life" in caplog.text


@pytest.mark.parametrize("reads", [False, True])
def test_pings_are_signs_of_life(names: yarpy.LocalNames, reads: bool) -> None:
    kind = yarpy.Port if reads else yarpy.BufferedPort
    with kind("/p", names=names) as port, client(port, 2) as sock:
        if reads:
            subscribed(sock)
        for _ in range(6):  # longer than the three seconds after which it would be gone
            sock.settimeout(0.6)
            with pytest.raises(TimeoutError):
                sock.recv(1)
            sock.settimeout(HANG)
            sock.sendall(mqtt.packet(mqtt.PINGREQ))
            assert sock.recv(2, socket.MSG_WAITALL) == mqtt.packet(mqtt.PINGRESP)


def test_who_promises_nothing_may_be_silent(names: yarpy.LocalNames) -> None:
    with yarpy.BufferedPort("/in", names=names) as port, client(port, 0), client(port, 1) as other:
        wait_until(lambda: len(port.inputs) == 2)
        assert other.recv(1) == b""  # which it is told of last, were it to be
        wait_until(lambda: len(port.inputs) == 1)


@pytest.mark.parametrize("version", [4, 5])
@pytest.mark.parametrize("how", ["cut", "silent", "wrong"])
def test_the_will_of_one_who_vanishes(names: yarpy.LocalNames, version: int, how: str) -> None:
    with yarpy.BufferedPort("/in", strict=True, names=names) as port:
        with client(port, 1 if how == "silent" else 0, version, b'["gone", 1]') as sock:
            sock.sendall(
                mqtt.packet(mqtt.PUBLISH, mqtt.string(b"x") + bytes(version == 5) + b"[7]")
            )
            first = port.read(timeout=HANG)
            assert first is not None and first.value == [7]
            if how == "cut":
                sock.close()
            elif how == "wrong":
                sock.sendall(b"\xf0\0")
            last = port.read(timeout=HANG)
            assert last is not None and last.value == ["gone", 1]
        wait_until(lambda: not port.inputs)


def test_no_will_after_a_goodbye_unless_it_says_so(names: yarpy.LocalNames) -> None:
    with yarpy.BufferedPort("/in", strict=True, names=names) as port:
        with client(port, 0, 5, b"[1]") as sock:
            sock.sendall(mqtt.packet(mqtt.DISCONNECT))
            assert sock.recv(1) == b""
        with client(port, 0, 5, b"[2]") as sock:
            sock.sendall(mqtt.packet(mqtt.DISCONNECT, bytes((mqtt.WITH_WILL, 0))))
            assert sock.recv(1) == b""
        last = port.read(timeout=HANG)
        assert last is not None and last.value == [2]


def test_a_will_does_not_outlive_the_port(names: yarpy.LocalNames) -> None:
    """The end of the port is not that of the client."""
    heard = []
    port = yarpy.Port("/in", names=names, callback=lambda message: heard.append(message.value))
    with port, client(port, 0, 4, b"[1]"):
        wait_until(lambda: port.inputs)
        port.close()  # before the client goes
    assert heard == []


def test_the_will_of_a_program_with_paho(names: yarpy.LocalNames) -> None:
    with yarpy.BufferedPort("/in", strict=True, names=names) as port:
        program = paho.Client(paho.CallbackAPIVersion.VERSION2)
        program.will_set("robots/arm", b'"arm is gone"', qos=1)
        program.connect(port.contact.host, port.contact.port)
        program.loop_start()
        program.publish("robots/arm", b'"here"').wait_for_publish(HANG)
        first = port.read(timeout=HANG)
        assert first is not None and first.value == "here"
        sock = program.socket()
        assert sock is not None
        sock.shutdown(socket.SHUT_RDWR)
        last = port.read(timeout=HANG)
        assert last is not None and last.value == "arm is gone"
        end(program)
