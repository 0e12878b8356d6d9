"""Bodies of messages of ROS 2, from bytes alone."""

import copy

import numpy as np
import pytest

import yarpy
from yarpy import idl
from yarpy.data import codec
from yarpy.peers import ros2
from yarpy.peers.ros.body import RosMessage
from yarpy.peers.ros2.body import Ros2Message, encode_body, time_of, value_of
from yarpy.wire.message import DATA, Encoded, Message, Packet

String = ros2.load("std_msgs/msg/String")
Image = ros2.load("sensor_msgs/msg/Image")
HI = bytes.fromhex("00010000 03000000 686900")


def body(value: object, kind: type, envelope: bytes = b"", now: float | None = None) -> bytes:
    clock = None if now is None else lambda: now
    return b"".join(encode_body(Packet(value, envelope), kind, clock))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "value",
    [
        *("hi", ["hi"], {"data": "hi"}, yarpy.Bottle(["hi"]), String(data="hi")),
        Encoded(b"".join(codec.encode("hi"))),
    ],
)
def test_golden_bytes(value: object) -> None:
    assert body(value, String) == HI


def test_it_is_made_once_for_all() -> None:
    packet = Packet("hi")
    assert encode_body(packet, String, None) is encode_body(packet, String, None)
    assert value_of(Packet(Encoded(b"".join(codec.encode("hi"))))) == "hi"


def test_what_does_not_fit() -> None:
    with pytest.raises(ValueError, match=r"std_msgs/String is expected here.*got 5"):
        body(5, String)
    with pytest.raises(ValueError, match="std_msgs/String is expected here"):
        body(Image(), String)


def test_pixels_are_not_copied() -> None:
    pixels = np.zeros((64, 64, 3), "u1")
    blocks = encode_body(Packet(yarpy.Image(pixels)), Image, None)
    assert np.shares_memory(np.frombuffer(blocks[-1], "u1"), pixels)


def test_a_picture_of_ros_1() -> None:
    old = idl.load("sensor_msgs/Image")(height=1, width=1, encoding="mono8", step=1, data=b"\7")
    made = Image.from_ros(body(old, Image))
    assert (made.width, made.encoding, made.data.tolist()) == (1, "mono8", [7])


def test_time() -> None:
    picture = yarpy.Image(np.zeros((1, 1), "u1"))
    said = Image.from_ros(body(picture, Image, b"7 12.25", 99.5)).header.stamp
    assert (said.sec, said.nanosec) == (12, 250_000_000)
    now = Image.from_ros(body(picture, Image, b"", 99.5)).header.stamp
    assert (now.sec, now.nanosec) == (99, 500_000_000)
    own = Image()
    own.header.stamp.sec = 3
    for value in (own, {"header": {"stamp": {"sec": 3}}}):
        assert Image.from_ros(body(value, Image, b"", 99.5)).header.stamp.sec == 3
    assert Image.from_ros(body(own, Image, b"1 4.5")).header.stamp.sec == 4
    assert time_of(Packet("hi", b"1 4.5")) == 4_500_000_000
    assert time_of(Packet("hi", b"nonsense")) == 0


def test_what_came() -> None:
    plain = Ros2Message(DATA, HI, String, False, 7, 1_500_000_000)
    assert (plain.value, plain.envelope) == ("hi", "7 1.500000000")
    picture = body(yarpy.Image(np.zeros((1, 1), "u1")), Image, b"7 12.25")
    assert Ros2Message(DATA, picture, Image, True, 3, 99).envelope == "3 12.250000000"
    unsaid = body(Image(), Image)
    assert Ros2Message(DATA, unsaid, Image, True, 3, 2_000_000_000).envelope == "3 2.000000000"
    assert Ros2Message(DATA, b"", Image, True, 3, -5).envelope == ""


def test_what_came_begins_as_any_message_of_ros() -> None:
    came, plain = Ros2Message(DATA, HI, String, False, 7, 0), RosMessage(DATA, HI, String, "7 0.0")
    names = {*Message.__slots__, *RosMessage.__slots__} - {"envelope"}
    assert {name: getattr(came, name) for name in names} == {
        name: getattr(plain, name) for name in names
    }


def test_its_envelope_may_be_another() -> None:
    came = Ros2Message(DATA, HI, String, False, 7, 1_500_000_000)
    came.envelope = "said by a monitor"
    assert came.envelope == "said by a monitor"
    copied = copy.copy(Ros2Message(DATA, HI, String, False, 7, 1_500_000_000))
    assert (copied.value, copied.envelope) == ("hi", "7 1.500000000")
