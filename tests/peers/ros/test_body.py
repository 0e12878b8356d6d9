"""Bodies of ROS messages; in dialogues they are tested in test_tcpros.py."""

import pytest
from support.ros_link import LIBRARY, Int32, Stamped, String

from yarpy.data.bottle import Bottle
from yarpy.peers.ros.body import RosMessage, encode_body, envelope_of, message_of
from yarpy.wire.message import DATA, Encoded, Packet

UInt8s = LIBRARY.message("std_msgs/UInt8MultiArray")


def body(value: object, kind: object) -> bytes:
    return b"".join(map(bytes, encode_body(Packet(value), kind, None)))  # type: ignore[arg-type]


def test_a_body_is_made_once_for_all_connections_of_a_type() -> None:
    packet = Packet(["a"])
    assert encode_body(packet, String, None) is encode_body(packet, String, None)
    with pytest.raises(ValueError, match="std_msgs/Int32 is expected here"):
        encode_body(packet, Int32, None)


def test_what_a_monitor_has_made_is_read_again() -> None:
    assert body(Encoded(Bottle(["hi"]).to_bytes()), String) == b"\2\0\0\0hi"


def test_plain_values_and_lists_are_bodies() -> None:
    assert body("hi", String) == body(["hi"], String) == body({"data": "hi"}, String)
    assert body(7, Int32) == body([7], Int32) == b"\7\0\0\0"


def test_a_blob_is_a_body_but_where_the_type_has_bytes() -> None:
    assert body([b"\1\2"], Int32) == b"\1\2"
    assert body([b"\1\2"], UInt8s) == b"\2\0\0\0\1\2"


def test_headers_are_found() -> None:
    assert Stamped._has_header and not String._has_header
    assert envelope_of(b"\1\0\0\0") == ""  # cut off; reading it says so
    assert envelope_of(b"\xff" * 12) == ""  # no time


def test_bytes_are_looked_at_when_somebody_looks() -> None:
    message = message_of(DATA, b"\xff\0\0\0", String, raw=False)
    assert isinstance(message, RosMessage)
    assert message.spelling == "foreign"
    assert len(message.payload) == 4
    good = message_of(DATA, b"\2\0\0\0hi", String, raw=False)
    assert isinstance(good, RosMessage)
    assert good.ros is good.ros
    assert good.to_bytes() == Bottle(["hi"]).to_bytes()
    assert good.as_(str) == "hi"
