"""ros2: what a port writes and reads there, without any medium."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any

import pytest

import yarpy
from yarpy.errors import LinkClosed
from yarpy.link.begin.handshake import find_carrier
from yarpy.peers import ros2
from yarpy.peers.ros2.carrier import Asker, Incoming, Outgoing, Ros2, Server, Subscriber
from yarpy.peers.ros2.kind import chosen
from yarpy.route import Route, parse_carrier
from yarpy.testing import End
from yarpy.wire.message import CALL, DATA, Packet
from yarpy.wire.stream import ObjectStream

String = ros2.load("std_msgs/msg/String")
Add = ros2.load("example_interfaces/srv/AddTwoInts")
HI = bytes.fromhex("00010000 03000000 686900")


class Chatter:
    """A topic as the medium gives it."""

    name = "/chatter"
    clock: Callable[[], float] = staticmethod(lambda: 12.5)

    def __init__(self, kind: Any = String) -> None:
        self.kind = kind

    def settle(self, value: object) -> Any:
        self.kind = chosen(value)
        return self.kind


def opened(spec: str, topic: Chatter) -> tuple[Any, End]:
    """A carrier that was greeted, and its side of the medium."""
    carrier = find_carrier(parse_carrier(spec))(Route("/port", "/ros2://chatter", spec))
    end = End()
    end.stream = ObjectStream()
    end.stream.feed_object(topic)
    end.begin(carrier.greet(end.stream))
    assert end.done
    return carrier, end


def said(end: End) -> list[Outgoing]:
    found: list[Any] = [*end.outbox, *end.stream.take_output()]
    end.outbox.clear()
    return found


def read(carrier: Any, end: End, item: object) -> Any:
    assert isinstance(end.stream, ObjectStream)
    end.stream.feed_object(item)
    end.begin(carrier.decode(end.stream))
    return end.result


def test_what_is_what() -> None:
    kinds = {"ros2": Ros2, "ros2+sub": Subscriber, "ros2+srv": Asker, "ros2+sub+srv": Server}
    for spec, kind in kinds.items():
        assert find_carrier(parse_carrier(spec)) is kind
        assert kind.push is not spec.startswith("ros2+sub")
        assert kind.replies is ("srv" in spec)


def test_publishing() -> None:
    carrier, end = opened("ros2", Chatter())
    carrier.encode(end.stream, Packet("hi", b"1 2.5"))
    (item,) = said(end)
    assert (b"".join(item.body), item.time, item.kind) == (HI, 2_500_000_000, String)
    assert item.size == len(HI)
    carrier.encode_quit(end.stream)
    assert said(end) == []


def test_the_first_message_says_the_type() -> None:
    topic = Chatter(None)
    carrier, end = opened("ros2", topic)
    carrier.encode(end.stream, Packet(yarpy.Bottle([1, "two"])))
    assert carrier.lost == 1
    carrier.encode(end.stream, Packet("hi"))
    assert topic.kind is String
    assert [b"".join(item.body) for item in said(end)] == [HI]


def test_what_does_not_fit_is_said_once(caplog: pytest.LogCaptureFixture) -> None:
    carrier, end = opened("ros2", Chatter())
    with caplog.at_level(logging.WARNING, logger="yarpy"):
        for value in (5, 5, "hi", 5):
            carrier.encode(end.stream, Packet(value))
        assert not carrier.prepare(Packet(5))
    assert (carrier.lost, len(said(end))) == (3, 1)
    assert caplog.text.count("/port: a message is not sent to /ros2://chatter") == 2


def test_what_leaves_later_has_memory_of_its_own() -> None:
    import numpy as np

    pixels = np.zeros((60, 60, 3), "u1")
    carrier, end = opened("ros2", Chatter(ros2.load("sensor_msgs/msg/Image")))
    packet = Packet(yarpy.Image(pixels))
    assert carrier.prepare(packet)
    pixels[:] = 9
    carrier.encode(end.stream, packet)
    assert set(said(end)[0].body[-1]) == {0}


def test_subscribing() -> None:
    carrier, end = opened("ros2+sub", Chatter())
    assert isinstance(end.stream, ObjectStream)
    message = read(carrier, end, Incoming(HI, 3, 1_500_000_000))
    assert (message.key, message.value, message.envelope) == (DATA, "hi", "3 1.500000000")
    assert carrier.parse(end.stream) is None
    for number in (4, 5):
        end.stream.feed_object(Incoming(HI, number, 1_500_000_000))
    found = [carrier.parse(end.stream) for _ in range(3)]
    assert [one and one.envelope for one in found] == ["4 1.500000000", "5 1.500000000", None]
    end.stream.feed_eof()
    with pytest.raises(LinkClosed):
        end.begin(carrier.decode(end.stream))


def test_asking() -> None:
    carrier, end = opened("ros2+srv", Chatter(Add))
    packet = Packet([1, 2], key=CALL)
    assert carrier.prepare(packet)
    carrier.encode(end.stream, packet)
    (item,) = said(end)
    assert Add.Request.from_ros(b"".join(item.body)) == Add.Request(a=1, b=2)
    assert isinstance(end.stream, ObjectStream)
    end.stream.feed_object(Incoming(b"".join(Add.Response(sum=3).to_ros())))
    end.begin(carrier.expect_reply(end.stream))
    assert end.result.ros.sum == 3
    end.stream.feed_object(Incoming(b"", failure="nobody is there"))
    end.begin(carrier.expect_reply(end.stream))
    assert end.result.as_(yarpy.Bottle).to_text() == '[fail] "nobody is there"'
    with pytest.raises(ValueError, match="expected an integer"):
        carrier.encode(end.stream, Packet(["x", 2], key=CALL))


def test_serving() -> None:
    carrier, end = opened("ros2+sub+srv", Chatter(Add))
    question = b"".join(Add.Request(a=1, b=2).to_ros())
    for answer, failure in (
        ([3], ""),
        (Add.Response(sum=3), ""),
        ([yarpy.Vocab("fail"), "no"], "no"),
        ([yarpy.Vocab("fail")], "it failed"),
        (yarpy.Bottle(), "the service gave no answer"),
    ):
        message = read(carrier, end, Incoming(question, 1, 2, asked="whoever"))
        assert (message.key, message.ros.b) == (CALL, 2)
        carrier.encode_reply(end.stream, answer)
        (item,) = said(end)
        assert item.to == "whoever"
        assert item.failure.startswith(failure) if failure else not item.failure
        if not failure:
            assert Add.Response.from_ros(b"".join(item.body)).sum == 3
    message = read(carrier, end, Incoming(question, asked="whoever"))
    with pytest.raises(ValueError, match="expected an integer"):
        carrier.encode_reply(end.stream, ["x"])


def test_a_question_that_is_none_is_refused_and_the_next_one_heard() -> None:
    carrier, end = opened("ros2+sub+srv", Chatter(Add))
    assert isinstance(end.stream, ObjectStream)
    end.stream.feed_object(Incoming(b"\xff" * 9, asked="somebody"))
    message = read(carrier, end, Incoming(b"".join(Add.Request(a=1).to_ros()), asked="other"))
    assert message.ros.a == 1
    (item,) = said(end)
    assert (item.to, carrier.lost) == ("somebody", 1)
    assert "no plain CDR" in item.failure
