"""Messages of ROS 2 in files: read by what the file says of their types."""

import pytest

import yarpy
from yarpy import ros2
from yarpy.errors import DecodeError, UnknownType
from yarpy.limit import ROS_FULL_TEXT
from yarpy.peers.ros2.recorded import reader

OWN = (
    "std_msgs/Header header\nint32 x\nmy_msgs/In[] more\n"
    + ("=" * 80 + "\nMSG: my_msgs/In\nstring word\n")
    + ("=" * 80 + "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n")
    + ("=" * 80 + "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n")
)


def body(name: str, /, **fields: object) -> bytes:
    return b"".join(map(bytes, ros2.load(name)(**fields).to_ros()))


def test_a_type_that_the_file_describes() -> None:
    data = bytes.fromhex(
        "00010000 0c000000 0065cd1d 01000000 00000000 05000000 01000000 03000000 686900"
    )
    found, value, envelope = reader("my_msgs/msg/Own", "ros2msg", OWN)(data)
    assert (found.x, found.more[0].word, envelope) == (5, "hi", "0 12.500000000")
    assert value.to_text() == '((12 500000000) "") 5 ((hi))'


def test_types_that_are_known_by_name() -> None:
    read = reader("std_msgs/msg/String", "ros2idl", "struct ...")
    found, value, envelope = read(body("std_msgs/msg/String", data="hello"))
    assert (found.data, value, envelope) == ("hello", "hello", "")
    found, value, _ = reader("std_msgs/msg/Float64MultiArray", "", "")(
        body("std_msgs/msg/Float64MultiArray", data=[1.5, 2.0])
    )
    assert isinstance(value, yarpy.Vector) and value.array.tolist() == [1.5, 2.0]


def test_what_is_wrong() -> None:
    with pytest.raises(UnknownType):
        reader("my_msgs/msg/NullSink", "ros2msg", "")
    with pytest.raises(DecodeError):
        reader("my_msgs/msg/Own", "ros2msg", "int32 x x\n")
    with pytest.raises(DecodeError):
        reader("my_msgs/msg/Own", "ros2msg", OWN)(b"\0" * 7)
    with pytest.raises(DecodeError):
        reader("my_msgs/msg/Own", "ros2msg", OWN + " " * ROS_FULL_TEXT)
