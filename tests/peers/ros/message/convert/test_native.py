"""YARP's own types as messages of ROS, and back."""

from typing import Any

import numpy as np
import pytest

import yarpy
from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError
from yarpy.peers.ros.message.convert.native import stamp_of, to_message, to_value, type_for
from yarpy.peers.ros.message.library import Library
from yarpy.peers.ros.message.message import Time

IMAGE = yarpy.Image(np.arange(24, dtype="u1").reshape(2, 4, 3))
VALUES = [
    IMAGE,
    yarpy.Vector([1.0, 2.0]),
    yarpy.Matrix([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]),
    yarpy.PointCloud([[1.0, 2.0, 3.0]]),
    yarpy.Sound(np.arange(8, dtype="i2"), 16000),
    yarpy.Stamp(7, 12.5),
    "hello yarp",
    True,
    42,
    1.5,
]


@pytest.mark.parametrize("value", VALUES, ids=lambda value: type(value).__name__)
def test_each_has_a_natural_type_and_comes_back(library: Library, value: Any) -> None:
    name = type_for(value)
    assert name is not None
    message = to_message(value, library.message(name))
    again = type(message).from_ros(b"".join(message.to_ros()))
    assert to_value(again, type(value) if not isinstance(value, bool) else object) == (
        Bottle([1]) if value is True else value
    )


def test_images_and_bottles_are_what_readers_get_unasked(library: Library) -> None:
    image = to_message(IMAGE, library.message("sensor_msgs/Image"))
    assert to_value(image) == IMAGE
    joints = library.message("sensor_msgs/JointState")(name=["a"])
    assert to_value(joints) == joints.to_bottle()
    assert to_value(joints, type(joints)) is joints
    assert to_value(joints, Bottle) == joints.to_bottle()
    assert to_value(library.message("std_msgs/String")("hi"), str) == "hi"


def test_stamps_go_into_headers_and_come_out(library: Library) -> None:
    stamp = yarpy.Stamp(7, 12.5)
    message: Any = to_message(IMAGE, library.message("sensor_msgs/Image"), stamp, "camera")
    assert message.header.seq == 7
    assert message.header.stamp == Time(12, 500_000_000)
    assert message.header.frame_id == "camera"
    assert stamp_of(message) == stamp
    assert to_value(message, yarpy.Stamp) == stamp
    assert stamp_of(library.message("std_msgs/String")()) is None
    message = to_message(IMAGE, library.message("sensor_msgs/Image"), yarpy.Stamp(0, float("nan")))
    assert message.header.stamp == Time(0, 0)
    message = to_message(IMAGE, library.message("sensor_msgs/Image"), yarpy.Stamp())
    assert message.header.stamp == Time(0, 0)


def test_vectors_are_joints_and_arrays_of_any_kind(library: Library) -> None:
    vector = yarpy.Vector(np.arange(1000.0))
    joints: Any = to_message(vector, library.message("sensor_msgs/JointState"))
    assert np.shares_memory(joints.position, vector.array)
    assert to_value(joints, yarpy.Vector) == vector
    text = "MultiArrayLayout layout\nuint32[] data\n"
    cls = library.message_of("std_msgs/UInt32MultiArray", text)
    made: Any = to_message(yarpy.Vector([1, 2], "int32"), cls)
    assert made.layout.dim[0].size == 2
    assert to_value(cls.from_ros(b"".join(made.to_ros())), yarpy.Vector) == [1, 2]


def test_matrices_that_are_none(library: Library) -> None:
    message = to_message(yarpy.Vector([1.0]), library.message("std_msgs/Float64MultiArray"))
    with pytest.raises(DecodeError, match=r"1 numbers with the sizes \[1\] are no Matrix"):
        to_value(message, yarpy.Matrix)


def test_sound_goes_in_turns(library: Library) -> None:
    cls = library.message("audio_common_msgs/AudioData")
    message: Any = to_message(yarpy.Sound([[1, 2], [3, 4]], 16000), cls)
    assert np.frombuffer(b"".join(message.to_ros())[4:], "<i2").tolist() == [1, 3, 2, 4]
    samples = np.zeros(5000, "i2")
    blocks = to_message(yarpy.Sound(samples), cls).to_ros()
    assert np.shares_memory(np.frombuffer(blocks[1], "u1"), samples)
    with pytest.raises(DecodeError, match="no samples of 16 bits"):
        to_value(cls(data=b"abc"), yarpy.Sound)
    assert len(to_value(cls(), yarpy.Sound).array[0]) == 0


def test_pictures_may_be_compressed(library: Library) -> None:
    flat = yarpy.Image(np.full((16, 16, 3), 100, "u1"))
    message = to_message(flat, library.message("sensor_msgs/CompressedImage"))
    assert to_value(message, yarpy.Image).width == 16


def test_anything_of_the_structure_is_taken(library: Library) -> None:
    pose = library.message("turtlesim/Pose")
    for value in ([1, 2, 3, 4, 5], Bottle.from_text("1 2 3 4 5"), yarpy.Vector([1, 2, 3, 4, 5])):
        assert to_message(value, pose) == pose(1, 2, 3, 4, 5)
    assert to_message({"x": 2}, pose) == pose(x=2.0)
    assert to_message(np.arange(5.0), pose) == pose(0, 1, 2, 3, 4)
    assert to_message(None, library.message("std_msgs/Empty"))._type == "std_msgs/Empty"
    made = pose(x=1.0)
    assert to_message(made, pose) is made
    assert type_for(made) == "turtlesim/Pose"
    assert type_for(Bottle([1])) is None


def test_what_does_not_fit_is_told(library: Library) -> None:
    string = library.message("std_msgs/String")
    with pytest.raises(DecodeError, match="expected a string, got 42"):
        to_message(42, string)
    with pytest.raises(TypeError, match="a std_msgs/Int32 is no std_msgs/String"):
        to_message(library.message("std_msgs/Int32")(), string)
    with pytest.raises(DecodeError, match="expected"):
        to_message(IMAGE, string)
    with pytest.raises(DecodeError):
        to_value(string("x"), yarpy.Image)
    with pytest.raises(DecodeError):
        to_value(string("x"), yarpy.Stamp)
