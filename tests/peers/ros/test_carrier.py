"""tcpros: the captures of C++ YARP and rospy in both roles, types that do not fit, the conformance
suite."""

from __future__ import annotations

import pickle
import struct
from typing import Any

import pytest
from support.capture import load_capture
from support.ros_link import (
    STRING,
    AddTwoInts,
    Int32,
    Stamped,
    String,
    accept,
    header,
    taken_header,
    welcomed,
)
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import AccessRefused, DecodeError, RemoteProtocolError, YarpError
from yarpy.peers.ros.carrier import TcpRos
from yarpy.peers.ros.header import encode_header, parse_header
from yarpy.peers.ros.service.carrier import RosSrv
from yarpy.route import UNDECLARED, Declared, Route
from yarpy.testing import CarrierConformance, End
from yarpy.wire.effects import HEAR, May
from yarpy.wire.message import Message, Packet
from yarpy.wire.stream import ByteStream

PIECES = [0, 1]


class TestTcpRos(CarrierConformance):
    carrier = TcpRos
    names_sender = False
    carries_envelopes = False

    def of_size(self, size: int) -> Any:
        return ["put", bytes(size)]  # a blob alone is a body


def sent(end: End, carrier: TcpRos, value: object, envelope: str = "") -> bytes:
    """The body of a message as `carrier` sends it."""
    carrier.encode(end.stream, Packet(value, envelope.encode()))
    data = end.take()
    assert struct.unpack_from("<I", data)[0] == len(data) - 4
    return data[4:]


def subscribed(declared: Declared, answer: bytes, carrier: str, piece: int = 0) -> tuple[End, Any]:
    """An end that has dialled a publisher who answers so."""
    end, talk = End(piece), TcpRos(Route("/chatter-@/me", "/them", carrier, declared=declared))
    end.begin(talk.greet(end.stream))
    end.feed(answer)
    assert end.done
    return end, talk


def received(end: End, carrier: TcpRos, body: bytes) -> Message:
    end.begin(carrier.decode(end.stream))
    end.feed(struct.pack("<I", len(body)) + body)
    message = end.result
    assert isinstance(message, Message)
    return message


# ------------------------------------------------------------------------------------ the captures


@pytest.mark.parametrize("piece", PIECES)
def test_a_publisher_answers_rospy_as_cpp_does(piece: int) -> None:
    """It has no type of its own."""
    asked, said = (step.data for step in load_capture("ros_yarp_pub_tcpros").steps)
    end, carrier = accept(asked, Declared("/yarp/talker", "/chatter"), piece)
    assert carrier.route.source == "/rostopic_15896_1795224835519"
    bodies = end.take()
    for word in ("hello ros", "two"):
        carrier.encode(end.stream, Packet([word]))
        bodies += end.take()
    assert bodies == said


@pytest.mark.parametrize("piece", PIECES)
def test_a_subscriber_reads_what_rospy_publishes(piece: int) -> None:
    asked, said = (step.data for step in load_capture("ros_yarp_sub_update_tcpros").steps)
    declared = Declared("/yarp/listener", "/chatter", "std_msgs/String", String)
    end = End(piece)
    talk = TcpRos(Route("/chatter-@/yarp/listener", "/rostopic", "tcpros", declared=declared))
    end.begin(talk.greet(end.stream))
    wanted = encode_header({**read(asked), "tcp_nodelay": "1"})
    assert end.take() == wanted
    found: list[Any] = []

    def follow() -> Any:
        while True:
            found.append((yield from talk.decode(end.stream)))

    size = 4 + struct.unpack_from("<I", said)[0]
    end.feed(said[:size])
    assert end.done
    end.begin(follow())
    end.feed(said[size:])
    assert [message.value for message in found] == ["second publisher"] * len(found)
    assert len(found) == 7


def read(data: bytes) -> dict[str, str]:
    return parse_header(data[4 : 4 + struct.unpack_from("<I", data)[0]])


# ------------------------------------------------------------------------------------------- types

PUBLISHED = {"callerid": "/them", "md5sum": STRING, "topic": "/chatter", "type": "std_msgs/String"}


def test_the_type_of_the_publisher_is_read_from_its_definition() -> None:
    answer = header(
        callerid="/them",
        md5sum="*",
        topic="/t",
        type="strange/Pair",
        message_definition="strange/Half[2] halves\n"
        + "=" * 80
        + "\nMSG: strange/Half\nint16 n\nstring s\n",
    )
    end, carrier = subscribed(UNDECLARED, answer, "tcpros+topic./t")
    message = received(end, carrier, bytes.fromhex("0100 01000000 61 0200 00000000"))
    assert message.value == [[[1, "a"], [2, ""]]]
    assert message.ros.halves[1].n == 2  # type: ignore[attr-defined]


def test_a_type_that_nobody_knows_is_named() -> None:
    with pytest.raises(YarpError, match="nowhere/Known"):
        subscribed(UNDECLARED, header(md5sum="*", type="nowhere/Known"), "tcpros")


def test_another_definition_of_the_publisher_is_an_error_that_says_so() -> None:
    declared = Declared("/me", "/chatter", "std_msgs/Int32", Int32)
    with pytest.raises(
        RemoteProtocolError, match=r"std_msgs/String with the md5sum 992.*both sides"
    ):
        subscribed(declared, encode_header(PUBLISHED), "tcpros")


def test_the_error_of_the_publisher_is_told() -> None:
    with pytest.raises(RemoteProtocolError, match=r"refuses the connection: no such\\x1b topic"):
        subscribed(UNDECLARED, header(error="no such\x1b topic"), "tcpros")


def test_a_subscriber_of_another_type_is_told_why() -> None:
    declared = Declared("/me", "/chatter", "std_msgs/Int32", Int32)
    end = End()
    with pytest.raises(RemoteProtocolError, match="both sides need the same definition"):
        end.begin(welcomed(end, [], Route("", "/port", declared=declared)))
        end.feed(encode_header(PUBLISHED))
    end.collect()
    fields, rest = taken_header(end)
    assert "both sides need the same definition" in fields["error"]
    assert not rest


@pytest.mark.parametrize("missing", ["callerid", "md5sum", "topic"])
def test_what_a_subscriber_has_to_say(missing: str) -> None:
    fields = {key: value for key, value in PUBLISHED.items() if key != missing}
    with pytest.raises(RemoteProtocolError, match=f"needs the field '{missing}'"):
        accept(encode_header(fields), UNDECLARED)


def test_another_topic_is_refused() -> None:
    with pytest.raises(RemoteProtocolError, match="/rgb:o is published here, not /chatter"):
        accept(encode_header(PUBLISHED), Declared("/me", "/rgb:o"))
    accept(encode_header({**PUBLISHED, "topic": "/rgb__o"}), Declared("/me", "/rgb:o"))


def test_who_does_not_care_gets_the_type_of_the_port() -> None:
    asked = header(callerid="/rostopic", md5sum="*", topic="/chatter", type="*", tcp_nodelay="1")
    end, _ = accept(asked, Declared("/me", "/chatter", "std_msgs/String", String, latched=True))
    fields, _ = taken_header(end)
    assert fields == {
        **PUBLISHED,
        "callerid": "/me",
        "latching": "1",
        "message_definition": "string data\n",
        "tcp_nodelay": "1",
    }


def test_a_message_of_another_type_is_not_sent_and_counted(
    caplog: pytest.LogCaptureFixture,
) -> None:
    end, carrier = accept(encode_header(PUBLISHED), Declared("/me", "/chatter", "", String))
    end.take()
    for _ in range(2):
        carrier.encode(end.stream, Packet([42]))
    assert end.take() == b""
    assert carrier.lost == 2
    assert [record.message for record in caplog.records] == [
        f"{carrier.route.source}: a message is not sent to {carrier.route.target}: "
        "std_msgs/String is expected here: std_msgs/String.data: expected a string, got 42"
    ]
    assert sent(end, carrier, ["42"]) == b"\2\0\0\x0042"
    assert not carrier.prepare(Packet([1, 2]))
    assert carrier.prepare(Packet("42"))


def test_objects_of_the_type_are_sent_and_of_others_not() -> None:
    end, carrier = accept(encode_header(PUBLISHED), Declared("/me", "/chatter", "", String))
    end.take()
    assert sent(end, carrier, String("ab")) == b"\2\0\0\0ab"
    carrier.encode(end.stream, Packet(Int32(1)))
    assert carrier.lost == 1


def test_small_objects_of_the_type_are_whole_messages() -> None:
    end, carrier = accept(encode_header(PUBLISHED), Declared("/me", "/chatter", "", String))
    end.take()
    carrier.encode(end.stream, Packet(String("ab")))
    assert carrier.whole(String("ab")) == end.take() == b"\6\0\0\0\2\0\0\0ab"
    for other in (Int32(1), "ab", String(7), String("x" * (1 << 20)), None):
        assert carrier.whole(other) is None
    _, untyped = accept(header(callerid="/a", md5sum="*", topic="/t"), UNDECLARED)
    assert untyped.whole(None) is untyped.whole(String("ab")) is None


def test_a_service_cannot_be_subscribed_to() -> None:
    with pytest.raises(RemoteProtocolError, match="is a service"):
        accept(encode_header(PUBLISHED), Declared("/me", "", "", AddTwoInts))


# ------------------------------------------------------------------------- number, time, and bodies


def test_the_header_of_a_message_is_its_envelope() -> None:
    answer = header(md5sum=Stamped._md5sum, type="test/Stamped", topic="/t")
    end, carrier = subscribed(Declared("/me", "/t", "", Stamped), answer, "tcpros")
    body = struct.pack("<III", 7, 1234, 500_000_000) + b"\1\0\0\0m" + b"\2\0\0\0xy"
    message = received(end, carrier, body)
    assert message.envelope == "7 1234.500000000"
    assert message.stamp == yarpy.Stamp(7, 1234.5)
    assert message.as_(Stamped).header.frame_id == "m"
    with pytest.raises(DecodeError, match="a message of the type test/Stamped, not std_msgs/Str"):
        message.as_(String)


def test_the_envelope_is_the_header_of_a_message() -> None:
    asked = header(callerid="/a", md5sum="*", topic="/t")
    declared = Declared("/me", "/t", "", Stamped, clock=lambda: 99.25)
    end, carrier = accept(asked, declared)
    end.take()
    value = [[0, [0, 0], "m"], b"xy"]
    tail = b"\1\0\0\0m\2\0\0\0xy"
    assert sent(end, carrier, value, "7 1234.5") == struct.pack("<III", 7, 1234, 500_000_000) + tail
    assert sent(end, carrier, value) == struct.pack("<III", 0, 99, 250_000_000) + tail
    made = Stamped.from_bottle([[3, [4, 5], "m"], b"xy"])
    assert sent(end, carrier, made) == struct.pack("<III", 3, 4, 5) + tail


def test_a_large_array_is_sent_from_where_it_is() -> None:
    import numpy as np

    asked = header(callerid="/a", md5sum="*", topic="/t")
    end, carrier = accept(asked, Declared("/me", "/t", "", Stamped))
    end.take()
    data = np.zeros(100_000, "u1")
    carrier.encode(end.stream, Packet(Stamped(data=data)))
    blocks = end.stream.take_output()
    assert np.shares_memory(np.frombuffer(blocks[-1], "u1"), data)
    packet = Packet(Stamped(data=data))
    assert carrier.prepare(packet)  # it leaves later, and its writer goes on
    carrier.encode(end.stream, packet)
    data[:] = 1
    assert bytes(end.stream.take_output()[-1]) == bytes(100_000)


def test_without_a_type_bodies_are_yarps_own() -> None:
    end, carrier = accept(header(callerid="/a", md5sum="*", topic="/t"), UNDECLARED)
    end.take()
    assert sent(end, carrier, [1, 2]) == yarpy.Bottle([1, 2]).to_bytes()
    assert sent(end, carrier, [b"any bytes"]) == b"any bytes"


@pytest.mark.parametrize(("raw", "wanted"), [("0", [b"\2\0\0\0hi"]), ("2", "hi")])
def test_raw_bodies(raw: str, wanted: object) -> None:
    end, carrier = subscribed(UNDECLARED, encode_header(PUBLISHED), f"tcpros+raw.{raw}")
    assert received(end, carrier, b"\2\0\0\0hi").value == wanted


def test_raw_bodies_that_are_bottles() -> None:
    end, carrier = subscribed(UNDECLARED, encode_header(PUBLISHED), "tcpros+raw.1")
    assert received(end, carrier, yarpy.Bottle([1, "a"]).to_bytes()).value == [1, "a"]


def test_modifiers_name_topic_and_type() -> None:
    end, carrier = End(), TcpRos(Route("/r", "/p", "tcpros+role.pub+topic./Pose+package.turtlesim"))
    end.begin(carrier.greet(end.stream))
    end.collect()
    assert taken_header(end)[0] == {
        "callerid": "/r",
        "md5sum": "*",
        "persistent": "1",
        "tcp_nodelay": "1",
        "topic": "/Pose",
        "type": "turtlesim/Pose",
    }


def test_copies_are_yarp_messages() -> None:
    end, carrier = subscribed(UNDECLARED, encode_header(PUBLISHED), "tcpros")
    message = received(end, carrier, b"\2\0\0\0hi")
    message.source = "/them"
    copy = pickle.loads(pickle.dumps(message))
    assert (copy.value, copy.source) == ("hi", "/them")


def test_a_body_that_is_none_of_the_type_is_found_when_it_is_read() -> None:
    end, carrier = subscribed(UNDECLARED, encode_header(PUBLISHED), "tcpros")
    with pytest.raises(DecodeError):
        _ = received(end, carrier, b"\xff\0\0\0hi").value


def test_a_length_beyond_the_limit_ends_the_connection() -> None:
    end, carrier = subscribed(UNDECLARED, encode_header(PUBLISHED), "tcpros")
    end.stream.limit = 1000
    with pytest.raises(RemoteProtocolError, match="the limit is 1000"):
        received(end, carrier, bytes(1001))


def test_who_may_not_read_is_told() -> None:
    stream = ByteStream()
    stream.feed(encode_header(PUBLISHED))
    carrier = TcpRos(Route("", "/port"))
    stream.head = 8
    steps = carrier.welcome(stream, b"")
    stream.head = 0
    assert next(steps) == May(HEAR)
    with pytest.raises(AccessRefused, match="not you"):
        steps.send("not you")
    assert b"error=not you" in b"".join(stream.take_output())


def test_a_service_is_handed_on() -> None:
    asked = header(callerid="/a", md5sum="*", service="/s")
    assert isinstance(accept(asked, UNDECLARED)[1], RosSrv)


def test_what_does_not_fit_counts_as_a_drop(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROS_MASTER_URI", raising=False)
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/chatter+@/me~std_msgs/String", names=names) as writer,
        yarpy.BufferedPort("/reader", names=names, strict=True) as reader,
    ):
        reader.connect("/chatter+@/me", "tcpros+topic./chatter")
        assert writer.wait_for_outputs(timeout=HANG)
        writer.write([42])
        writer.write("fits")
        assert reader.read(timeout=HANG).value == "fits"

        def counted() -> bool:  # a message is, behind sending it
            stats = writer.outputs[0].stats
            return (stats.messages, stats.drops) == (1, 1)

        wait_until(counted)
