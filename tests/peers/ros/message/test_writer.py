"""Messages to the bytes of ROS: what rospy writes, blocks without copies, errors with paths."""

from random import Random

import numpy as np
import pytest
from support import ros
from support.ros_value import PLAIN, filled

from yarpy.peers.ros.message.library import Library


@pytest.mark.peer("ros")
def test_rospy_reads_and_writes_the_same_bytes_for_every_installed_type() -> None:
    library, chance = Library(), Random(7)
    given = []
    for key in ros.installed():
        kind, name = key.split()
        if kind == "msg":
            given += [
                (name, b"".join(filled(library.message(name), chance, PLAIN).to_ros()).hex())
                for _ in range(3)
            ]
    program = """
from io import BytesIO
answer = []
for name, data in given:
    message = roslib.message.get_message_class(name)()
    message.deserialize(bytes.fromhex(data))
    out = BytesIO()
    message.serialize(out)
    answer.append([name, out.getvalue().hex()])
"""
    assert ros.ask(program, given) == [list(pair) for pair in given]


@pytest.mark.peer("ros")
def test_values_of_rospy_are_ours(library: Library) -> None:
    program = """
from io import BytesIO
from sensor_msgs.msg import JointState
message = JointState(name=["a", "bc"], position=[1.0, -2.5], effort=[3.0])
message.header.seq, message.header.frame_id = 7, "base"
message.header.stamp.secs, message.header.stamp.nsecs = 12, 34
out = BytesIO()
message.serialize(out)
answer = out.getvalue().hex()
"""
    data = bytes.fromhex(ros.ask(program))
    found = library.message("sensor_msgs/JointState").from_ros(data)
    assert found.to_bottle().to_text() == "(7 (12 34) base) (a bc) (1.0 -2.5) () (3.0)"
    assert b"".join(found.to_ros()) == data


def test_large_arrays_are_blocks_of_their_own(library: Library) -> None:
    pixels = np.zeros(6000, "u1")
    image = library.message("sensor_msgs/Image")(encoding="mono8", data=pixels)
    head, data = image.to_ros()
    assert isinstance(data, memoryview)
    assert np.shares_memory(np.frombuffer(data, "u1"), pixels)
    assert type(image).from_ros(b"".join((head, data))) == image


def test_large_arrays_of_any_make(library: Library) -> None:
    cls = library.message("sensor_msgs/Image")
    data = bytes(range(250)) * 20
    for value in (data, bytearray(data), memoryview(data), list(data), np.frombuffer(data, "u1")):
        assert b"".join(cls(data=value).to_ros())[-5000:] == data
    every_second = np.frombuffer(data, "u1")[::2]
    doubled = cls(data=np.repeat(every_second, 4)[::2])
    assert b"".join(doubled.to_ros())[-5000:] == np.repeat(every_second, 2).tobytes()
    cloud = library.message("std_msgs/Float64MultiArray")
    blocks = cloud(data=np.arange(1000.0)).to_ros()
    assert [type(block) for block in blocks] == [bytes, memoryview]


def test_arrays_of_other_numbers_are_converted(library: Library) -> None:
    every = library.message("test/Every")
    made = every(f64s=[1, 2], u8s=np.array([1, 2], "i8"), u32s=(1, 2, 3), flags=[True, False])
    found = every.from_ros(b"".join(made.to_ros()))
    assert found.f64s.tolist() == [1.0, 2.0]
    assert found.u8s.tolist() == [1, 2]
    assert found.flags.tolist() == [True, False]


def test_times_are_whatever_has_seconds(library: Library) -> None:
    class Stamp:
        secs, nsecs = 3, 4

    header = library.message("std_msgs/Header")
    assert header.from_ros(b"".join(header(stamp=Stamp()).to_ros())).stamp == (3, 4)


def test_what_does_not_fit_is_told_with_its_field(library: Library) -> None:
    image = library.message("sensor_msgs/Image")()
    image.header.seq = -1
    with pytest.raises(OverflowError, match=r"^sensor_msgs/Image\.header\.seq: -1 does not fit"):
        image.to_ros()
