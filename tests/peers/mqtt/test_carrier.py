"""mqtt: what mosquitto was recorded to say, clients that break the rules."""

from __future__ import annotations

from typing import Any

import pytest

from yarpy.carriers.base import Carrier
from yarpy.data.bottle import Bottle
from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.peers.mqtt import packet as mqtt
from yarpy.peers.mqtt.carrier import Mqtt, Reader
from yarpy.route import Route, parse_carrier
from yarpy.testing import End
from yarpy.wire.message import CALL, DATA, Message, Packet

HELLO3 = bytes.fromhex("100e00044d5154540402003c00026d65")
HELLO5 = bytes.fromhex("101200044d5154540502003c0321001400026d65")
SUBSCRIBE3 = bytes.fromhex("820a0001000561726d2f2301")  # arm/#, QoS 1
SUBSCRIBE5 = bytes.fromhex("820b000100000561726d2f2300")
PUBLISH3 = bytes.fromhex("320a000361726d00015b315d")  # arm, QoS 1
PUBLISH5 = bytes.fromhex("3009000361726d005b315d")
LISTEN5 = bytes.fromhex("820700010000016100")  # mosquitto_rr: first its answers ...
ASK5 = bytes.fromhex("3010000171090900026331080001615b315d")  # ... and then the question


def accepted(hello: bytes, target: str = "/arm/left", piece: int = 0) -> tuple[End, Mqtt]:
    """The port's side of a connection that a client has dialled."""
    end, carrier = End(piece), Mqtt(Route("", target, "mqtt", 10002))
    assert Mqtt.recognises(hello[:8])

    def steps() -> Any:
        first = bytes((yield from end.stream.read_exact(8)))
        assert (yield from carrier.welcome(end.stream, first)) is None

    end.begin(steps())
    end.feed(hello)
    assert end.done
    return end, carrier


def test_a_port_says_that_it_forgets_its_clients() -> None:
    end, _ = accepted(bytes.fromhex("101300044d5154540502003c05 1100000009 000161"))
    assert end.take() == bytes.fromhex("200f00000c 210400 2500 2a00 1100000000")


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("mqtt+bla", 'no "\\+bla"'),
        ("mqtt+sub+retian", 'no "\\+retian"'),
        ("mqtt+qos.3", "QoS 0, 1 and 2"),
        ("mqtt+sub+qos.x", "QoS 0, 1 and 2"),
        ("mqtt+sub+will.gone", "that write"),
        ("mqtt+password.x", r"\+user.NAME"),
    ],
)
def test_what_no_broker_can_be_asked_for_is_not_dialled(text: str, why: str) -> None:
    with pytest.raises(LocalProtocolError, match=why):
        Mqtt.of(parse_carrier(text))


def read(end: End, carrier: Carrier, data: bytes) -> Message:
    end.take()
    end.begin(carrier.decode(end.stream))
    end.feed(data)
    assert end.done
    message: Message = end.result
    return message


def test_a_client_without_a_name_is_given_one() -> None:
    nameless = mqtt.packet(mqtt.CONNECT, mqtt.string(b"MQTT") + b"\5\2\0\0\0" + mqtt.string(b""))
    names = set()
    for _ in range(2):
        end, _ = accepted(nameless)
        said = mqtt.Body(end.take()[2:])
        assert said.number(2) == 0
        names.add(bytes(said.properties()[0x12]))
    assert len(names) == 2 and all(name.startswith(b"yarpy-") for name in names)


@pytest.mark.parametrize("piece", [0, 1])
def test_clients_are_welcomed(piece: int) -> None:
    end, carrier = accepted(HELLO3, piece=piece)
    assert end.take() == bytes.fromhex("20020000")
    assert (carrier.route.source, carrier.version) == ("mqtt", mqtt.V3)
    end, carrier = accepted(HELLO5, piece=piece)
    assert end.take() == bytes.fromhex("200a000007 210400 2500 2a00".replace(" ", ""))
    assert carrier.version == mqtt.V5


def test_long_greetings_are_recognised() -> None:
    body = HELLO3[2:12] + mqtt.string(b"x" * 300)
    long = mqtt.packet(mqtt.CONNECT, body)
    accepted(long)
    for other in (b"\x10\x0e\0\4MQTX", b"\x10\x0e\0\6MQIs", b"\x20\x0e\0\4MQTT", b"\x10"):
        assert not Mqtt.recognises(other)


@pytest.mark.parametrize(
    ("hello", "subscribe", "granted", "sent"),
    [
        (HELLO3, SUBSCRIBE3, "9003000100", b"\x30\x0d\0\x08arm/left[1]"),
        (HELLO5, SUBSCRIBE5, "900400010000", b"\x30\x0e\0\x08arm/left\0[1]"),
    ],
)
def test_who_subscribes_reads(hello: bytes, subscribe: bytes, granted: str, sent: bytes) -> None:
    end, carrier = accepted(hello)
    message = read(end, carrier, subscribe)
    assert end.take() == bytes.fromhex(granted)
    assert message.key == "r"
    reader = message.payload
    assert isinstance(reader, Reader)
    assert (reader.push, reader.delivery.lossy) == (False, True)
    reader.encode(end.stream, Packet([1]))
    assert end.take() == sent
    steps = reader.listen(end.stream)
    next(steps)
    end.stream.feed(mqtt.packet(mqtt.PINGREQ))
    next(steps)
    assert end.take() == b"\xd0\0"
    properties = b"\0" if hello is HELLO5 else b""
    cancel = mqtt.packet(0xA2, b"\0\7" + properties + mqtt.string(b"arm/#"))
    end.stream.feed(cancel)
    next(steps)
    assert end.take() == mqtt.packet(mqtt.UNSUBACK, b"\0\7" + 2 * properties)
    reader.encode(end.stream, Packet([2]))
    assert end.take() == b""
    assert reader.unwanted == 1
    end.stream.feed(subscribe)
    next(steps)
    end.take()
    reader.encode(end.stream, Packet([1]))
    assert end.take() == sent
    end.stream.feed(b"\xe0\0")
    with pytest.raises(StopIteration):
        next(steps)


def test_subscriptions_are_limited() -> None:
    end, carrier = accepted(HELLO3, "/" + "/".join("abcdefgh"))
    reader = read(end, carrier, mqtt.packet(0x82, b"\0\1\0\1#\0")).payload
    steps = reader.listen(end.stream)
    next(steps)
    with pytest.raises(RemoteProtocolError, match="subscriptions"):
        for number in range(256):  # each takes the topic
            levels = ["+" if number >> place & 1 else "abcdefgh"[place] for place in range(8)]
            topic = mqtt.string("/".join(levels).encode())
            end.stream.feed(mqtt.packet(0x82, b"\0\1" + topic + b"\0"))
            next(steps)
            end.take()


def test_who_subscribes_to_something_else_still_writes() -> None:
    end, carrier = accepted(HELLO3, "/leg")
    message = read(end, carrier, SUBSCRIBE3 + PUBLISH3)
    assert (message.key, message.value) == (DATA, Bottle([1]))


def test_messages_are_acknowledged_once_they_were_taken() -> None:
    end, carrier = accepted(HELLO3)
    message = read(end, carrier, PUBLISH3)
    assert (message.key, message.value) == (DATA, Bottle([1]))
    assert end.take() == b""
    carrier.encode_ack(end.stream, 1)
    assert end.take() == bytes.fromhex("40020001")
    end, carrier = accepted(HELLO5)
    assert read(end, carrier, PUBLISH5).value == Bottle([1])
    carrier.encode_ack(end.stream, 1)
    assert end.take() == b""


def test_a_message_with_a_response_topic_is_a_question() -> None:
    end, carrier = accepted(HELLO5)
    message = read(end, carrier, LISTEN5 + ASK5)
    assert (message.key, message.value) == (CALL, Bottle([1]))
    end.take()
    carrier.encode_reply(end.stream, [2])
    assert end.take() == bytes.fromhex("300c000161 05 0900026331 5b325d".replace(" ", ""))


def test_pings_are_answered_and_a_goodbye_is_the_end() -> None:
    end, carrier = accepted(HELLO3)
    end.take()
    end.begin(carrier.decode(end.stream))
    end.feed(b"\xc0\0")
    assert end.take() == b"\xd0\0"
    end.feed(b"\xe0\0")
    assert end.result.key == "q"


# ---------------------------------------------------------------------------------------- a broker


# ----------------------------------------------------------------------------------- bad clients


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b"\x36\7\0\1a\0\1xx", "QoS 3"),
        (b"\x30\1\0", "too early"),
        (b"\x30\5\0\x09abc", "too early"),
        (b"\x32\3\0\1a", "too early"),
        (b"\x50\2\0\1", "does not belong"),
        (b"\x82" + mqtt.varint(700) + b"\0\1" + b"\0\0\0" * 300, "too early|more subscriptions"),
        (b"\x82\x81\x40\0\1" + 1000 * b"\0\1#\0" + b"\0" * 5000, "more subscriptions"),
    ],
)
def test_clients_that_break_the_rules(data: bytes, why: str) -> None:
    end, carrier = accepted(HELLO3)
    end.begin(carrier.decode(end.stream))
    with pytest.raises(RemoteProtocolError, match=why):
        end.feed(data)
        end.feed(bytes(10_000))


@pytest.mark.parametrize(
    "hello",
    [
        HELLO3[:8] + b"\x63" + HELLO3[9:],
        bytes.fromhex("100c00044d5154540400003c0000"),
        HELLO3[:12] + b"\0\x09me",
    ],
)
def test_greetings_that_are_refused(hello: bytes) -> None:
    end, carrier = End(), Mqtt(Route("", "/port", "mqtt", 10002))
    end.begin(carrier.welcome(end.stream, b""))
    with pytest.raises(RemoteProtocolError):
        end.feed(hello)


def test_a_reader_does_not_write_on_the_same_connection() -> None:
    end, carrier = accepted(HELLO3)
    reader = read(end, carrier, SUBSCRIBE3).payload
    steps = reader.listen(end.stream)
    next(steps)
    end.stream.feed(PUBLISH3)
    with pytest.raises(RemoteProtocolError, match="second connection"):
        next(steps)
