"""mqtt_broker: a broker's answers, its pings and its goodbye, the conformance suite."""

from __future__ import annotations

from typing import Any

import pytest

from yarpy.carriers.base import Carrier
from yarpy.carriers.payload import payload_of, value_of
from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.errors import LocalProtocolError, LoginRefused, RemoteProtocolError
from yarpy.peers.mqtt import packet as mqtt
from yarpy.peers.mqtt.broker import Asker, Client, Publisher, Subscriber
from yarpy.peers.mqtt.carrier import Mqtt
from yarpy.route import Route, parse_carrier
from yarpy.testing import CarrierConformance, End
from yarpy.wire.message import CALL, Message, Packet

SUBSCRIBE3 = bytes.fromhex("820a0001000561726d2f2301")  # arm/#, QoS 1
PUBLISH3 = bytes.fromhex("320a000361726d00015b315d")  # arm, QoS 1


class _Mqtt(CarrierConformance):
    """A port that takes another one for a broker."""

    carrier = Publisher
    names_sender = False
    carries_envelopes = False

    def test_its_own_greeting_is_recognised(self) -> None:
        assert isinstance(self._greeted().accepting, Mqtt)

    def expected(self, value: Any) -> Any:
        return codec.decode(b"".join(codec.encode(value_of(payload_of(value)))))


class TestPublisher(_Mqtt):
    pass


class TestPublisherWithAcknowledgements(_Mqtt):
    modifiers = "+qos.1"


class TestAsker(_Mqtt):
    carrier = Asker
    modifiers = "+rpc"


def read(end: End, carrier: Carrier, data: bytes) -> Message:
    end.take()
    end.begin(carrier.decode(end.stream))
    end.feed(data)
    assert end.done
    message: Message = end.result
    return message


def dialled(spec: str, target: str) -> tuple[End, Client]:
    kind = Mqtt.of(parse_carrier(spec))
    assert issubclass(kind, Client)
    return End(), kind(Route("/arm", target, spec, 1883, "broker"))


def test_a_port_publishes() -> None:
    end, carrier = dialled("mqtt", "/mqtt://broker:1883/robot/arm")
    assert isinstance(carrier, Publisher)
    end.begin(carrier.greet(end.stream))
    hello = end.take()
    assert hello[2:12] == bytes.fromhex("00044d5154540402003c")
    assert hello[14:].startswith(b"yarpy-arm-")
    end.feed(b"\x20\2\0\0")
    assert end.done
    carrier.encode(end.stream, Packet([1]))
    assert end.take() == b"\x30\x0e\0\x09robot/arm[1]"
    carrier.encode_quit(end.stream)
    assert end.take() == b"\xe0\0"


def test_a_port_publishes_with_acknowledgements() -> None:
    end, carrier = dialled("mqtt+qos.1+retain", "/mqtt://broker:1883/a")
    end.begin(carrier.greet(end.stream))
    end.feed(b"\x20\2\0\0")
    end.take()
    for number in (1, 2):
        carrier.encode(end.stream, Packet(7))
        assert end.take() == b"\x33\6\0\1a\0%c7" % number
    for number in (1, 2):
        end.begin(carrier.expect_ack(end.stream))
        end.feed(b"\x40\2\0%c" % number)
        assert end.done
    carrier.encode(end.stream, Packet(7))
    end.begin(carrier.expect_ack(end.stream))
    with pytest.raises(RemoteProtocolError, match="another"):
        end.feed(b"\x40\2\0\x09")


def test_a_port_subscribes() -> None:
    end, carrier = dialled("mqtt+sub+qos.1", "/mqtt://broker:1883/arm/#")
    assert isinstance(carrier, Subscriber)
    end.begin(carrier.greet(end.stream))
    end.take()
    end.feed(b"\x20\2\0\0")
    assert end.take() == SUBSCRIBE3
    end.feed(b"\x90\3\0\1\1")
    assert end.done
    assert read(end, carrier, PUBLISH3).value == Bottle([1])
    carrier.encode_ack(end.stream, 1)
    assert end.take() == bytes.fromhex("40020001")


def asking() -> tuple[End, Client, bytes]:
    """A port that asks at a broker, and the topic of the answers."""
    end, carrier = dialled("mqtt+rpc", "/mqtt://broker:1883/q")
    end.begin(carrier.greet(end.stream))
    assert end.take()[8] == mqtt.V5
    end.feed(bytes.fromhex("2003000000"))
    said = mqtt.Body(end.take()[5:])
    answers = said.string()
    assert answers.startswith(b"yarpy/answers/")
    assert end.done
    return end, carrier, answers


def test_a_port_asks_at_a_broker() -> None:
    end, carrier, answers = asking()
    carrier.encode(end.stream, Packet([1], key=CALL))
    properties = b"\x08" + mqtt.string(answers) + b"\x09\0\2\0\1"
    head = b"\0\1q\0\1" + mqtt.varint(len(properties)) + properties
    assert end.take() == mqtt.packet(0x32, head + b"[1]")
    end.begin(carrier.expect_reply(end.stream))
    answer = mqtt.string(answers) + b"\0\7\5\x09\0\2\0%c[2]"
    end.feed(bytes.fromhex("900400010001"))
    end.feed(b"\x40\2\0\1" + mqtt.packet(0x32, answer % 0))  # to an older question
    assert end.take() == b"\x40\2\0\7"
    assert not end.done
    end.feed(mqtt.packet(0x32, answer % 1))
    assert end.result.value == Bottle([2])
    carrier.encode(end.stream, Packet([3]))  # wants no answer
    end.collect()
    assert end.take().endswith(b"\x30\7\0\1q\0[3]")


def test_an_answer_may_take_longer_than_a_message() -> None:
    _, asker, _ = asking()
    _, publisher = dialled("mqtt", "/mqtt://broker:1883/q")
    assert asker.limits.message_timeout is None
    assert asker.limits.ping_interval, "it pings like any other client"
    assert publisher.limits.message_timeout  # an acknowledgement comes at once


def test_a_broker_says_that_nobody_is_there() -> None:
    end, carrier, _ = asking()
    carrier.encode(end.stream, Packet([1], key=CALL))
    end.begin(carrier.expect_reply(end.stream))
    end.feed(b"\x40\4\0\1\x10\0")
    assert end.result.value == Bottle([Vocab("fail"), "nobody has subscribed to q at the broker"])


def test_a_broker_does_not_let_answers_through() -> None:
    end, carrier, _ = asking()
    carrier.encode(end.stream, Packet([1], key=CALL))
    end.begin(carrier.expect_reply(end.stream))
    with pytest.raises(RemoteProtocolError, match="refuses the subscription to yarpy/answers"):
        end.feed(bytes.fromhex("900400010087"))


def test_a_login_is_said() -> None:
    end, carrier = dialled("mqtt+user.me+password.a%2Bb", "/mqtt://broker:1883/a")
    end.begin(carrier.greet(end.stream))
    hello = end.take()
    assert hello[9] == 0xC2
    assert hello.endswith(b"\0\2me\0\3a+b")
    with pytest.raises(LoginRefused, match=r"\+user"):
        end.feed(b"\x20\2\0\5")


@pytest.mark.parametrize(
    ("spec", "target"),
    [
        ("mqtt", "/127.0.0.1:1883/"),
        ("mqtt", "/mqtt://broker:1883/a/#"),
        ("mqtt", "/mqtt://broker:1883/a/+/b"),
        ("mqtt+sub", "/127.0.0.1:1883/"),
    ],
)
def test_what_cannot_be_is_said_before_anything_is_sent(spec: str, target: str) -> None:
    end, carrier = dialled(spec, target)
    with pytest.raises(LocalProtocolError):
        end.begin(carrier.greet(end.stream))
    assert end.take() == b""


@pytest.mark.parametrize(
    ("answer", "why"),
    [
        (b"HTTP/1.1 400 Bad Request\r\n\r\n" + bytes(100), "no broker"),
        (b"\x20\2\0\1", "3.1.1"),
        (b"\x20\2\0\x63", "99"),
        (b"\x20\0", "no broker"),
        (b"\x20\2\0\0\x90\3\0\1\x80", "refuses the subscription"),
        (b"\x20\2\0\0\x30\3\0\1a", "does not answer"),
    ],
)
def test_brokers_that_refuse(answer: bytes, why: str) -> None:
    end, carrier = dialled("mqtt+sub", "/mqtt://broker:1883/a")
    end.begin(carrier.greet(end.stream))
    with pytest.raises(RemoteProtocolError, match=why):
        end.feed(answer)


# ----------------------------------------------------------------------------- version 5, and pings


def test_a_port_publishes_in_version_5() -> None:
    end, carrier = dialled("mqtt+v5+qos.1", "/mqtt://broker:1883/a")
    end.begin(carrier.greet(end.stream))
    assert end.take()[8] == mqtt.V5
    end.feed(bytes.fromhex("2003000000"))
    carrier.encode(end.stream, Packet(7))
    assert end.take() == bytes.fromhex("32070001610001 00 37")
    end.begin(carrier.expect_ack(end.stream))
    end.feed(bytes.fromhex("4004000110 00"))  # nobody has subscribed, which is no fault
    assert end.done


def test_a_port_subscribes_in_version_5() -> None:
    end, carrier = dialled("mqtt+sub+v5", "/mqtt://broker:1883/arm/#")
    end.begin(carrier.greet(end.stream))
    end.take()
    end.feed(bytes.fromhex("2003000000"))
    assert end.take() == bytes.fromhex("820b000100000561726d2f2300")
    end.feed(bytes.fromhex("90040001 00 00"))
    assert end.done
    assert read(end, carrier, bytes.fromhex("3009000361726d005b315d")).value == Bottle([1])


def test_the_broker_may_wish_for_other_pings() -> None:
    end, carrier = dialled("mqtt+v5", "/mqtt://broker:1883/a")
    assert (carrier.limits.ping, carrier.limits.ping_interval) == (b"\xc0\0", 30.0)
    end.begin(carrier.greet(end.stream))
    assert end.take()[10:12] == b"\0\x3c"  # a minute
    end.feed(bytes.fromhex("2006000003 13000a"))
    assert end.done
    assert carrier.limits.ping_interval == 5.0


@pytest.mark.parametrize("spec", ["mqtt", "mqtt+rpc"])
def test_what_a_broker_says_in_between_is_heard(spec: str) -> None:
    end, carrier = dialled(spec, "/mqtt://broker:1883/a")
    end.begin(carrier.greet(end.stream))
    end.take()
    end.feed(b"\x20\2\0\0" if spec == "mqtt" else bytes.fromhex("2003000000"))
    listening = carrier.listen(end.stream)
    assert listening is not None
    end.begin(listening)
    end.take()
    end.feed(b"\xd0\0")
    end.feed(b"\xc0\0")
    assert end.take() == b"\xd0\0"
    with pytest.raises(RemoteProtocolError, match="it is shutting down"):
        end.feed(b"\xe0\1\x8b")


def test_a_broker_that_goes_is_no_goodbye_of_a_writer() -> None:
    end, carrier = dialled("mqtt+sub+v5", "/mqtt://broker:1883/a")
    end.begin(carrier.decode(end.stream))
    with pytest.raises(RemoteProtocolError, match="the broker ends the connection: it is shutting"):
        end.feed(b"\xe0\2\x8b\0")


def test_a_subscription_to_many_topics_tells_them_apart() -> None:
    end, carrier = dialled("mqtt+sub", "/mqtt://broker:1883/robots/+/pose")
    for name in (b"r1", b"r\x1b"):
        body = mqtt.string(b"robots/" + name + b"/pose") + b"[1]"
        message = read(end, carrier, mqtt.packet(mqtt.PUBLISH, body))
        shown = name.decode().replace("\x1b", "\\x1b")
        assert message.source == f"/mqtt://broker:1883/robots/{shown}/pose"
