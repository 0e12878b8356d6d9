"""Messages of ROS 1 in files: read by what the file says of their types."""

import threading
from pathlib import Path

import numpy as np
import pytest
from support.recordings import START, payload_of
from support.ros_graph import RosGraph
from support.wait import HANG, wait_until

import yarpy
from yarpy import idl, record
from yarpy.errors import DecodeError, UnknownType
from yarpy.kits.record.mcap.layout import Channel, Other, Schema
from yarpy.kits.record.mcap.writer import McapWriter
from yarpy.peers.ros.bag.recorded import reader

OWN = "Header header\nint32 x\nmy_msgs/In[] more\n" + "=" * 80 + "\nMSG: my_msgs/In\nstring word\n"


def body(name: str, /, **fields: object) -> bytes:
    return b"".join(map(bytes, idl.load(name)(**fields).to_ros()))


def test_a_type_that_the_file_describes() -> None:
    data = bytes.fromhex("07000000 0c000000 0065cd1d 00000000 05000000 01000000 02000000 6869")
    found, value, envelope = reader("my_msgs/Own", "ros1msg", OWN)(data)
    assert (found.x, found.more[0].word, envelope) == (5, "hi", "7 12.500000000")
    assert value.to_text() == '(7 (12 500000000) "") 5 ((hi))'


def test_types_that_are_known_by_name() -> None:
    read = reader("std_msgs/msg/String", "ros1msg", "")
    found, value, envelope = read(body("std_msgs/String", data="hello"))
    assert (found.data, value, envelope) == ("hello", "hello", "")
    found, value, _ = reader("std_msgs/Float64MultiArray", "", "")(
        body("std_msgs/Float64MultiArray", data=[1.5, 2.0])
    )
    assert isinstance(value, yarpy.Vector) and value.array.tolist() == [1.5, 2.0]


def test_what_is_wrong() -> None:
    with pytest.raises(UnknownType, match="no definition of the message my_msgs/NullSink"):
        reader("my_msgs/NullSink", "ros1msg", "")
    with pytest.raises(DecodeError):
        reader("my_msgs/Own", "ros1msg", "int32 x x\n")
    with pytest.raises(DecodeError):
        reader("my_msgs/Own", "ros1msg", OWN)(b"\0" * 7)
    with pytest.raises(DecodeError):
        reader("no name", "ros1msg", OWN)


def test_played_as_a_node(graph: RosGraph, tmp_path: Path) -> None:
    """What is of ROS comes as it was, what is of YARP in the type that goes with it."""
    with McapWriter(tmp_path / "x.mcap") as writer:
        text = idl.load("sensor_msgs/JointState")._full_text
        schema = Schema("sensor_msgs/JointState", "ros1msg", text.encode())
        arm = Channel("/arm", "ros1", schema, {})
        data = body("sensor_msgs/JointState", name=["elbow"], position=[0.5])
        picture = yarpy.Image(np.zeros((2, 3), "u1"))
        for n in range(50):
            at = START + n * 10_000_000
            writer.add_other(Other(arm, n, at, at, data))
            writer.add("/eye", f"{n} 1.5", at, payload_of(picture))
    types = {"/arm": "sensor_msgs/JointState", "/eye": "sensor_msgs/Image"}
    with (
        record.open(tmp_path / "x.mcap") as found,
        record.Player(found, node="/player", loop=True) as player,
    ):
        assert player.ports == {"/arm": "/arm+@/player", "/eye": "/eye+@/player"}
        playing = threading.Thread(target=player.play)
        playing.start()
        # Before that, rostopic takes what it is to echo of a topic for a part of its name.
        wait_until(lambda: types.items() <= dict(graph.master.call("getTopicTypes", "/x")).items())
        with (
            graph.run("rostopic", "echo", "/arm") as arm_echo,
            graph.run("rostopic", "echo", "/eye/encoding") as eye_echo,
        ):
            wait_until(lambda: "elbow" in arm_echo.stdout)
            wait_until(lambda: "mono8" in eye_echo.stdout)
        player.stop()
        playing.join(HANG)
        assert not playing.is_alive()
