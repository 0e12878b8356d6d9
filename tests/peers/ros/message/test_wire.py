"""Messages of ROS on YARP's own connections, as classes of C++ YARP send them."""

from random import Random
from struct import pack

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.ros_value import filled

from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError
from yarpy.peers.ros.message.library import Library
from yarpy.peers.ros.message.model import PRIMITIVES
from yarpy.peers.ros.message.wire import code_of


def wire(message: object) -> bytes:
    return b"".join(codec.encode(message))


@settings(max_examples=60)
@given(st.randoms(use_true_random=False))
def test_round_trips(library: Library, chance: Random) -> None:
    for name in ("test/Every", "sensor_msgs/PointCloud2"):
        made = filled(library.message(name), chance)
        assert type(made).from_wire(wire(made)) == made
        assert codec.decode_as(wire(made), type(made)) == made
        # It is a Bottle, and one with the structure of the other form.
        assert type(made).from_bottle(Bottle.from_bytes(wire(made))) == made


def test_structs_are_lists_and_arrays_have_their_code(library: Library) -> None:
    joints = library.message("sensor_msgs/JointState")(name=["ab"], position=[1.5])
    assert wire(joints) == (
        pack("<ii", 256, 5)
        + pack("<ii", 256, 3)
        + pack("<iI", 1, 0)
        + pack("<iiiIiI", 256, 2, 1, 0, 1, 0)
        + pack("<ii", 4, 0)
        + pack("<iii2s", 260, 1, 2, b"ab")
        + pack("<iid", 266, 1, 1.5)
        + pack("<ii", 266, 0) * 2
    )
    vector = library.message("geometry_msgs/Vector3")(1.0, 2.0, 3.0)
    assert wire(vector) == pack("<iiidididxxxx", 256, 3, 10, 1.0, 10, 2.0, 10, 3.0)[:-4]


def test_codes() -> None:
    codes = {name: code_of(PRIMITIVES[name]) for name in PRIMITIVES if PRIMITIVES[name].is_number}
    assert codes == {
        **dict.fromkeys(("bool", "int8", "uint8"), 32),
        **dict.fromkeys(("int16", "uint16"), 64),
        **dict.fromkeys(("int32", "uint32"), 1),
        **dict.fromkeys(("int64", "uint64"), 17),
        "float32": 128,
        "float64": 10,
    }
    assert code_of(PRIMITIVES["string"]) == 4


def test_constants_that_cpp_counts_are_understood(library: Library) -> None:
    """C++ announces 12 elements of a PointField, and sends the 4 that are fields."""
    field = library.message("sensor_msgs/PointField")(name="x", offset=4, datatype=7, count=1)
    body = wire(field)[8:]
    assert wire(field)[:8] == pack("<ii", 256, 4)
    assert type(field).from_wire(pack("<ii", 256, 12) + body) == field
    with pytest.raises(DecodeError):
        type(field).from_wire(pack("<ii", 256, 5) + body)


def test_other_bottles_of_the_structure_are_read(library: Library) -> None:
    twist = library.message("geometry_msgs/Twist")
    found = codec.decode_as(Bottle([[1, 2, 3], [4, 5, 6]]).to_bytes(), twist)
    assert found.angular.z == 6.0
    pose = library.message("turtlesim/Pose")
    assert pose.from_wire(pose(y=2.0).to_bottle().to_bytes()).y == 2.0


def test_arrays_are_not_copied(library: Library) -> None:
    pixels = np.zeros(100_000, "u1")
    image = library.message("sensor_msgs/Image")(data=pixels)
    blocks = image.to_wire()
    assert np.shares_memory(np.frombuffer(blocks[1], "u1"), pixels)
    data = b"".join(blocks)
    assert np.shares_memory(type(image).from_wire(data).data, np.frombuffer(data, "u1"))


def test_what_is_another_message_is_told(library: Library) -> None:
    twist = library.message("geometry_msgs/Twist")
    with pytest.raises(DecodeError, match=r"geometry_msgs/Twist\.linear: expected a list"):
        twist.from_wire(Bottle([1, [2]]).to_bytes())
    with pytest.raises(DecodeError):
        twist.from_wire(b"hello")


def test_every_beginning_of_a_message_is_refused(library: Library) -> None:
    made = filled(library.message("test/Every"), Random(4))
    data = wire(made)
    for end in range(len(data)):
        with pytest.raises(DecodeError):
            type(made).from_wire(data[:end])


def test_there_is_a_limit_of_elements(library: Library, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_MAX_ELEMENTS", "20000")
    cls = library.message_of("p/Strings", "string[] a")
    data = pack("<iiii", 256, 1, 260, 30000) + bytes(4 * 30000)
    with pytest.raises(DecodeError, match="YARPY_MAX_ELEMENTS"):
        cls.from_wire(data)
