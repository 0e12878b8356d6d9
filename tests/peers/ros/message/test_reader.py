"""The bytes of ROS to messages: recordings, real peers, and whatever is wrong."""

import struct
import tracemalloc
from random import Random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.capture import load_capture
from support.ros_value import filled

from yarpy.errors import DecodeError, Truncated
from yarpy.peers.ros.message import reader
from yarpy.peers.ros.message.library import Library

IMAGE = bytes.fromhex(
    "00000000b4df006bb37f9031060000002f6672616d6502000000030000000400000072676238001000000020000000"
) + bytes(range(32))


def test_recorded_messages(library: Library) -> None:
    string = library.message("std_msgs/String")
    said = load_capture("ros_yarp_pub_tcpros").said("b")
    body = said[4 + 0xA2 :]
    assert string.from_ros(body[4:17]).data == "hello ros"
    assert string.from_ros(body[21:]).data == "two"
    add = library.service_of("rospy_tutorials/AddTwoInts", "int64 a\nint64 b\n---\nint64 sum\n")
    steps = [step.data for step in load_capture("ros_ros_srv_tcpros").steps]
    asked = add.Request.from_ros(steps[2][4:])
    assert (asked.a, asked.b) == (1, 100)
    assert add.Response.from_ros(steps[3][5:]).sum == 101


def test_recorded_image_of_cpp_yarp(library: Library) -> None:
    image = library.message("sensor_msgs/Image").from_ros(IMAGE)
    assert (image.width, image.height, image.encoding, image.step) == (3, 2, "rgb8", 16)
    assert image.header.frame_id == "/frame"
    assert image.data.tolist() == [*range(32)]


def test_arrays_look_at_the_bytes(library: Library) -> None:
    cls = library.message("sensor_msgs/Image")
    for data in (IMAGE, bytearray(IMAGE), memoryview(IMAGE)):
        image = cls.from_ros(data)
        assert np.shares_memory(image.data, np.frombuffer(data, "u1"))
    changed = bytearray(IMAGE)
    cls.from_ros(changed).data[0] = 99
    assert changed[-32] == 99
    joints = library.message("sensor_msgs/JointState")
    data = b"".join(joints(header=None, name=["abc"], position=[1.0, 2.0]).to_ros())
    found = joints.from_ros(data)  # the doubles begin at byte 27
    assert found.position.tolist() == [1.0, 2.0]
    assert np.shares_memory(found.position, np.frombuffer(data, "u1"))


@settings(max_examples=60)
@given(st.randoms(use_true_random=False))
def test_round_trips(library: Library, chance: Random) -> None:
    for name in ("test/Every", "sensor_msgs/PointCloud2", "geometry_msgs/Twist"):
        made = filled(library.message(name), chance)
        data = b"".join(made.to_ros())
        assert type(made).from_ros(data) == made
        assert b"".join(type(made).from_ros(memoryview(data)).to_ros()) == data


def test_bools_are_true_or_false_whatever_comes(library: Library) -> None:
    flag = library.message_of("p/Flag", "bool a\nbool[] b")
    found = flag.from_ros(bytes([7, 2, 0, 0, 0, 0, 9]))
    assert found.a is True
    assert found.b.tolist() == [False, True]


def test_every_beginning_of_a_message_is_truncated(library: Library) -> None:
    made = filled(library.message("test/Every"), Random(1))
    data = b"".join(made.to_ros())
    for end in range(len(data)):
        with pytest.raises(Truncated, match=r"test/(Every|Inner)"):
            type(made).from_ros(data[:end])


def test_bytes_that_are_left_tell_that_it_is_another_type(library: Library) -> None:
    with pytest.raises(DecodeError, match="std_msgs/Int32 takes 4 bytes, here are 6"):
        library.message("std_msgs/Int32").from_ros(bytes(6))


def test_the_field_is_named(library: Library) -> None:
    with pytest.raises(Truncated, match=r"sensor_msgs/Image\.header\.frame_id takes bytes up to"):
        library.message("sensor_msgs/Image").from_ros(IMAGE[:14] + b"\xff\xff" + IMAGE[16:])
    with pytest.raises(Truncated, match=r"sensor_msgs/Image\.data"):
        library.message("sensor_msgs/Image").from_ros(IMAGE[:-1])


@pytest.mark.parametrize("kind", ["float64", "string", "time", "Part"])
def test_counts_are_checked_before_memory_is_taken(library: Library, kind: str) -> None:
    texts = f"{kind}[] items\n\n" + "=" * 80 + "\nMSG: p/Part\nint8 a"
    cls = library.message_of("p/Many", texts)
    tracemalloc.start()
    try:
        with pytest.raises(Truncated):
            cls.from_ros(b"\xff\xff\xff\xff" + bytes(1000))
        assert tracemalloc.get_traced_memory()[1] < 1 << 20
    finally:
        tracemalloc.stop()


def test_there_is_a_limit_of_elements(library: Library, monkeypatch: pytest.MonkeyPatch) -> None:
    cls = library.message_of("p/Strings", "string[] a\nstring[] b")
    half = struct.pack("<I", 20000) + bytes(4 * 20000)
    assert len(cls.from_ros(half + half).b) == 20000
    monkeypatch.setenv("YARPY_MAX_ELEMENTS", "30000")
    with pytest.raises(DecodeError, match="YARPY_MAX_ELEMENTS"):
        cls.from_ros(half + half)


def test_a_large_array_asks_for_no_limit_of_elements(
    library: Library, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Looking into the environment takes longer than all else of a picture."""
    monkeypatch.setattr(reader, "limits", None)
    cls = library.message_of("p/Bytes", "string name\nuint8[] data")
    data = struct.pack("<I", 1) + b"x" + struct.pack("<I", 1 << 20) + bytes(1 << 20)
    assert cls.from_ros(data).data.nbytes == 1 << 20


def test_messages_of_many_values_are_read_in_parts(library: Library) -> None:
    inner = "\n".join(f"int8 a{n}" for n in range(200))
    text = f"Big one\nBig[] more\nstring end\n\n{'=' * 80}\nMSG: p/Big\n{inner}\n"
    made = filled(library.message_of("p/Two", text), Random(2))
    assert type(made).from_ros(b"".join(made.to_ros())) == made
