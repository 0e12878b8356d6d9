"""Messages of ROS as Bottles and back: the shapes that C++ YARP shows, and what it refuses."""

from random import Random
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.ros_value import filled

from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.data.sig.vector import Vector
from yarpy.errors import DecodeError
from yarpy.peers.ros.message.library import Library


@pytest.mark.parametrize(
    ("name", "fields", "text"),
    [
        ("std_msgs/String", {"data": "hello yarp"}, '"hello yarp"'),
        ("std_msgs/Bool", {"data": True}, "1"),
        (
            "turtlesim/Pose",
            {"y": 5.0, "theta": 10.0, "linear_velocity": 15.0, "angular_velocity": 20.0},
            "0.0 5.0 10.0 15.0 20.0",
        ),
        ("std_msgs/Header", {"seq": 5, "stamp": [12, 34], "frame_id": "base"}, "5 (12 34) base"),
        (
            "sensor_msgs/JointState",
            {
                "header": [1, [0, 0], "base"],
                "name": ["a", "b"],
                "position": [1.0, 2.0],
                "effort": [0.5],
            },
            "(1 (0 0) base) (a b) (1.0 2.0) () (0.5)",
        ),
        ("geometry_msgs/Twist", {"linear": [1, 2, 3]}, "(1.0 2.0 3.0) (0.0 0.0 0.0)"),
    ],
)
def test_shapes_that_cpp_yarp_shows(
    library: Library, name: str, fields: dict[str, Any], text: str
) -> None:
    message = library.message(name).from_bottle(fields)
    assert message.to_bottle().to_text() == text
    assert type(message).from_bottle(Bottle.from_text(text)) == message


def test_equal_numbers_side_by_side_are_a_specialised_list(library: Library) -> None:
    pose = library.message("turtlesim/Pose")(x=1.0)
    assert pose.to_bottle().to_bytes()[:8].hex() == "8001000005000000"  # 256 + float32, 5
    empty = library.message("sensor_msgs/JointState")().to_bottle()
    assert empty.to_bytes().hex().endswith("0a01000000000000" * 3)


@settings(max_examples=60)
@given(st.randoms(use_true_random=False))
def test_round_trips(library: Library, chance: Random) -> None:
    for name in ("test/Every", "sensor_msgs/PointCloud2"):
        made = filled(library.message(name), chance)
        bottle = made.to_bottle()
        assert type(made).from_bottle(bottle) == made
        assert type(made).from_bottle(Bottle.from_bytes(bottle.to_bytes())) == made


def test_arrays_are_not_copied(library: Library) -> None:
    pixels = np.zeros(100_000, "u1")
    image = library.message("sensor_msgs/Image")(data=pixels)
    vector = image.to_bottle()[-1]
    assert isinstance(vector, Vector)
    assert np.shares_memory(vector.array, pixels)
    again = type(image).from_bottle(image.to_bottle())
    assert np.shares_memory(again.data, pixels)
    assert again.data.dtype == "u1"


def test_what_a_port_reads_is_understood(library: Library) -> None:
    """`decode` gives a Vector for numbers and the value itself where there is only one."""
    pose = library.message("turtlesim/Pose")
    assert pose.from_bottle(Vector([1, 2, 3, 4, 5])).y == 2.0
    string = library.message("std_msgs/String")
    assert string.from_bottle(codec.decode(b"".join(codec.encode("hi")))).data == "hi"
    assert string.from_bottle("hi").data == "hi"


def test_numbers_take_the_declared_kind(library: Library) -> None:
    every = library.message("test/Every")
    found = every.from_bottle(
        {"f64": 1, "u8": -1, "u32": 4294967295, "i64": 5, "flag": 1, "u8s": b"ab", "f64s": [1, 2]}
    )
    assert (found.f64, found.u8, found.u32, found.flag) == (1.0, 255, 4294967295, True)
    assert type(found.f64) is float
    assert found.u8s.tolist() == [97, 98]
    assert every.from_bottle({"u16s": Vector([-1, 2], "int16")}).u16s.tolist() == [65535, 2]
    assert every.from_bottle({"flags": Vector([1, 0], "int8")}).flags.tolist() == [True, False]
    assert every.from_bottle({"i64s": np.array([1, 2], "i4")}).i64s.dtype == "i8"


def test_messages_within_may_be_messages(library: Library) -> None:
    header = library.message("std_msgs/Header")(seq=3)
    image = library.message("sensor_msgs/Image")
    assert image.from_bottle({"header": header}).header is header


@pytest.mark.parametrize(
    ("field", "value", "said"),
    [
        ("text", 42, "test/Every.text: expected a string, got 42"),
        ("i32", 1.0, "test/Every.i32: expected an integer (int32), got 1.0"),
        ("i32", True, "test/Every.i32: expected an integer"),
        ("f64", "x", "test/Every.f64: expected a number, got 'x'"),
        ("u8", 256, "test/Every.u8: 256 does not fit in uint8"),
        ("u8", -129, "does not fit in uint8"),
        ("i8", 200, "does not fit in int8"),
        ("flag", 2, "test/Every.flag: expected true or false, got 2"),
        ("stamp", [1], "test/Every.stamp: expected (sec nsec)"),
        ("stamp", [1, -(1 << 40)], "test/Every.stamp.nsecs"),
        ("f64s", [1.0], "test/Every.f64s: expected 2 elements, got 1"),
        ("i32s", [1, "a"], "test/Every.i32s[1]: expected an integer"),
        ("i32s", Vector([1.5]), "test/Every.i32s: expected int32 numbers"),
        ("i32s", "ab", "test/Every.i32s: expected a list, got 'ab'"),
        ("texts", b"ab", "test/Every.texts: expected a list"),
        ("inner", [1.0], "test/Every.inner: expected 2 elements (x name), got 1"),
        ("inner", 3, "test/Every.inner: expected a list of 2, got 3"),
        ("pair", [[1.0, "a"], [1.0, 2]], "test/Every.pair[1].name: expected a string, got 2"),
        ("inner", {"z": 1}, "test/Every.inner has no field 'z'; it has x, name"),
    ],
)
def test_errors_name_the_field(library: Library, field: str, value: Any, said: str) -> None:
    with pytest.raises(DecodeError) as caught:
        library.message("test/Every").from_bottle({field: value})
    assert said in str(caught.value)


def test_words_are_not_one_string(library: Library) -> None:
    """As the paper's publisher of text: `hello world` is refused, `"hello world"` is not."""
    string = library.message("std_msgs/String")
    with pytest.raises(DecodeError, match=r"std_msgs/String: expected 1 elements \(data\), got 2"):
        string.from_bottle(Bottle.from_text("hello world"))
    with pytest.raises(DecodeError, match="expected a string, got 42"):
        string.from_bottle(Bottle.from_text("42"))
    assert string.from_bottle(Bottle.from_text('"42"')).data == "42"


def test_messages_that_are_none_are_refused_on_the_way_out(library: Library) -> None:
    every = library.message("test/Every")
    with pytest.raises(TypeError, match=r"test/Every\.inner: expected test/Inner, got 3"):
        every(inner=3).to_bottle()
    with pytest.raises(OverflowError, match=r"test/Every\.i8: 300"):
        every(i8=300).to_bottle()
