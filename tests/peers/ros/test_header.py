"""Headers of ROS connections: those of the captures, any fields, and what is none."""

import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.capture import load_capture

from yarpy.errors import RemoteProtocolError
from yarpy.limit import ROS_HEADER, ROS_HEADER_FIELDS
from yarpy.link.begin.handshake import UNKNOWN_PROTOCOL
from yarpy.peers.ros.header import begins_header, encode_header, parse_header, read_header
from yarpy.wire.stream import ByteStream, run

CAPTURES = ["ros_yarp_pub_tcpros", "ros_ros_srv_tcpros", "ros_yarp_srv_tcpros_3"]


@pytest.mark.parametrize("name", CAPTURES)
def test_recorded_headers_are_read_and_written_again(name: str) -> None:
    for step in load_capture(name).steps[:2]:
        size = 4 + struct.unpack_from("<I", step.data)[0]
        data = step.data[:size]
        assert begins_header(data[:8])
        fields = parse(data)
        assert fields["md5sum"] and "callerid" in fields
        assert encode_header(fields) == data


def parse(data: bytes, piece: int = 1) -> dict[str, str]:
    stream = ByteStream()
    pieces = [data[at : at + piece] for at in range(0, len(data), piece)]
    return run(read_header(stream), stream, pieces)


keys = st.text(st.characters(codec="utf-8", exclude_characters="="), min_size=1, max_size=9)


@given(st.dictionaries(keys, st.text(max_size=99), max_size=9))
def test_any_fields_return(fields: dict[str, str]) -> None:
    assert parse(encode_header(fields), 1000) == fields


def test_values_may_hold_anything() -> None:
    fields = {"message_definition": "int32 A=1\n# b = c\n", "type": "a/B"}
    assert parse(encode_header(fields)) == fields


def test_of_two_fields_with_one_key_the_first_counts() -> None:
    assert parse_header(b"\3\0\0\0a=1\3\0\0\0a=2") == {"a": "1"}


@pytest.mark.parametrize(
    ("data", "problem"),
    [
        (b"\3\0\0\0a=1\3\0", "in the middle of a length"),
        (b"\4\0\0\0a=1", "beyond its header"),
        (b"\1\0\0\0a", "without a key"),
        (b"\2\0\0\0=1", "without a key"),
        (b"\3\0\0\0a=1" + b"".join(b"\3\0\0\0%c=1" % (64 + n) for n in range(66)), "more than"),
    ],
)
def test_what_is_no_header_is_refused(data: bytes, problem: str) -> None:
    with pytest.raises(RemoteProtocolError, match=problem):
        parse_header(data)


def test_an_announced_length_is_not_believed() -> None:
    with pytest.raises(RemoteProtocolError, match="the limit is"):
        parse(struct.pack("<I", ROS_HEADER + 1))


def test_a_port_of_yarp_that_knows_no_ros_is_named() -> None:
    with pytest.raises(RemoteProtocolError, match="take another carrier, such as tcp"):
        parse(UNKNOWN_PROTOCOL)


def test_beginnings() -> None:
    assert not begins_header(bytes(8))
    assert not begins_header(b"\5\0\0\0\2\0\0\0")
    assert begins_header(b"\6\0\0\0\2\0\0\0")
    assert not begins_header(b"CONNECT ")
    assert not begins_header(b"YA\xe4\x1e\0\0RP")
    assert not begins_header(b"\6\0\0\0")
    assert ROS_HEADER_FIELDS > 20
