"""Packets of MQTT: as mosquitto 2.0 wrote them, in pieces too, and such as nobody writes."""

from __future__ import annotations

import pytest
from support.steps import chop

from yarpy.errors import LinkClosed, RemoteProtocolError
from yarpy.peers.mqtt import packet as mqtt
from yarpy.wire.stream import ByteStream, run

SUBSCRIBE = bytes.fromhex("820a0001000561726d2f2301")
ASKING = bytes.fromhex("3010000171090900026331080001615b315d")


@pytest.mark.parametrize("size", [1, 3, 100])
def test_packets_are_read(size: int) -> None:
    for data, first in ((SUBSCRIBE, 0x82), (ASKING, 0x30), (b"\xc0\0", mqtt.PINGREQ)):
        stream = ByteStream()
        assert run(mqtt.read_packet(stream, 100), stream, chop(data, size)) == (first, data[2:])
        stream = ByteStream()
        for part in chop(data[:-1], size):
            stream.feed(part)
            assert mqtt.parse_packet(stream, 100) is None
        stream.feed(data[-1:])
        assert mqtt.parse_packet(stream, 100) == (first, data[2:])
        assert not stream.waiting


def test_packets_are_written() -> None:
    assert mqtt.packet(0x82, b"\0\1" + mqtt.string(b"arm/#") + b"\1") == SUBSCRIBE
    properties = b"\x09" + mqtt.string(b"c1") + b"\x08" + mqtt.string(b"a")
    head = mqtt.string(b"q") + mqtt.varint(len(properties)) + properties
    assert b"".join(map(bytes, mqtt.publish(head, b"[1]"))) == ASKING
    large = bytes(100_000)
    pieces = mqtt.publish(mqtt.string(b"q"), large)
    assert pieces[0] == b"\x30" + mqtt.varint(100_003) + b"\0\1q"
    assert pieces[1] is large


def test_properties_are_read() -> None:
    said = mqtt.Body(ASKING[2:])
    assert said.string() == b"q"
    assert said.properties() == {mqtt.CORRELATION_DATA: b"c1", mqtt.RESPONSE_TOPIC: b"a"}
    assert bytes(said.rest()) == b"[1]"
    assert not said
    every = bytes.fromhex("0101 2100ff 0200000001 0bff01 26000161000162 030001 78".replace(" ", ""))
    found = mqtt.Body(mqtt.varint(len(every)) + every).properties()
    assert found == {1: b"\1", 0x21: b"\0\xff", 2: b"\0\0\0\1", 0x0B: b"\0\0\0\xff", 3: b"x"}


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b"\x30\xff\xff\xff\xff\1", "no end"),
        (b"\x30\x80\x80\x80\x7f", "266338304 bytes"),
        (b"\x30\x65" + bytes(101), "101 bytes"),
    ],
)
def test_lengths_are_not_believed(data: bytes, why: str) -> None:
    stream = ByteStream()
    with pytest.raises(RemoteProtocolError, match=why):
        run(mqtt.read_packet(stream, 100), stream, [data])
    stream = ByteStream()
    stream.feed(data)
    with pytest.raises(RemoteProtocolError, match=why):
        mqtt.parse_packet(stream, 100)


@pytest.mark.parametrize("data", [b"", b"\0", b"\0\5abc"])
def test_bodies_that_end_too_early(data: bytes) -> None:
    with pytest.raises(RemoteProtocolError, match="too early"):
        mqtt.Body(data).string()


@pytest.mark.parametrize("data", [b"\2\x7f\0", b"\2\x26\0", b"\5\x0b\xff\xff\xff\xff", b"\x80"])
def test_properties_that_nobody_has(data: bytes) -> None:
    with pytest.raises(RemoteProtocolError):
        mqtt.Body(data).properties()


def test_an_end_is_noticed_anywhere() -> None:
    for size in range(len(SUBSCRIBE)):
        stream = ByteStream()
        with pytest.raises(LinkClosed):
            run(mqtt.read_packet(stream, 100), stream, [SUBSCRIBE[:size]])


@pytest.mark.parametrize(
    ("pattern", "topic", "does"),
    [
        ("#", "arm", True),
        ("arm/#", "arm", True),
        ("arm/#", "arm/left/hand", True),
        ("+/left", "arm/left", True),
        ("+", "arm", True),
        ("+", "arm/left", False),
        ("arm/+/hand", "arm/left/hand", True),
        ("arm/left", "arm", False),
        ("leg", "arm", False),
        ("#/left", "arm/left", False),
    ],
)
def test_subscriptions(pattern: str, topic: str, does: bool) -> None:
    assert mqtt.matches(pattern, topic) == does
