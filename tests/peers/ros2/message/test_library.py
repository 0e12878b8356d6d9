"""Types of ROS 2 by name, and the version of one that a peer has."""

import copy
import os
import pickle
from pathlib import Path

import numpy as np
import pytest

import yarpy
from yarpy.errors import DecodeError, UnknownType
from yarpy.peers.ros.message.convert.native import stamp_of, to_message, to_value
from yarpy.peers.ros.message.source import Texts
from yarpy.peers.ros2.message.library import Library, default_library, hash_of
from yarpy.peers.ros2.message.source import Rosbags, Standard, installed

LIBRARY = Library([Rosbags("jazzy"), Standard()])


def test_names() -> None:
    assert LIBRARY.message("std_msgs/msg/String") is LIBRARY.message("std_msgs/String")
    assert LIBRARY.load("std_srvs/srv/Trigger") is LIBRARY.load("std_srvs/Trigger")
    assert LIBRARY.service("std_srvs/Trigger").Response._type == "std_srvs/Trigger_Response"
    for name in ("std_msgs/msg/Nothing", "std_srvs/srv/Nothing", "std_srvs/Nothing"):
        with pytest.raises(UnknownType, match="AMENT_PREFIX_PATH"):
            LIBRARY.load(name)
    with pytest.raises(DecodeError, match="no type of ROS"):
        LIBRARY.load("String")


def test_installed_packages(tmp_path: Path) -> None:
    folder = tmp_path / "share" / "robot_msgs"
    (folder / "msg").mkdir(parents=True)
    (folder / "srv").mkdir()
    (folder / "msg" / "Arm.msg").write_text("float64[<=7] angles\nHand hand\n")
    (folder / "msg" / "Hand.msg").write_text("uint8 fingers 5\n")
    (folder / "srv" / "Wave.srv").write_text("Arm arm\n---\n")
    library = Library([installed({"AMENT_PREFIX_PATH": f"/nowhere{os.pathsep}{tmp_path}"})])
    arm = library.message("robot_msgs/msg/Arm")()
    assert (arm.hand.fingers, arm.angles.tolist()) == (5, [])  # type: ignore[attr-defined]
    assert library.service("robot_msgs/Wave").Request().arm == arm  # type: ignore[attr-defined]


def test_the_version_that_a_peer_has() -> None:
    """Of sensor_msgs/Range Humble and Jazzy have different ones."""
    humble = Library([Rosbags("humble")]).message("sensor_msgs/Range")
    ours = LIBRARY.message("sensor_msgs/Range")
    assert hash_of(humble) != hash_of(ours)
    found = LIBRARY.having("sensor_msgs/msg/Range", hash_of(humble))
    assert (hash_of(found), found._names) == (hash_of(humble), humble._names)  # type: ignore[union-attr]
    assert LIBRARY.having("sensor_msgs/Range", hash_of(ours)) is ours
    with pytest.raises(UnknownType, match=f"RIHS01_{'0' * 64} there and {hash_of(ours)} here"):
        LIBRARY.having("sensor_msgs/Range", "RIHS01_" + "0" * 64)
    with pytest.raises(UnknownType, match="no definition"):
        LIBRARY.having("p/Nothing", hash_of(ours))
    service = LIBRARY.service("std_srvs/Trigger")
    assert LIBRARY.having("std_srvs/Trigger", hash_of(service), "srv") is service


def test_copies() -> None:
    string = default_library().message("std_msgs/String")(data="hi")
    for again in (copy.deepcopy(string), pickle.loads(pickle.dumps(string))):
        assert again == string


def test_circles_are_refused() -> None:
    library = Library([Texts({"p/A": "B b", "p/B": "A[] a"}, "here")])
    with pytest.raises(DecodeError, match="contain themselves"):
        library.message("p/A")


def test_types_of_yarp() -> None:
    """The same values as in ROS 1, but for the header, which has no number."""
    stamp = yarpy.Stamp(7, 12.5)
    pixels = np.arange(18, dtype="u1").reshape(2, 3, 3)
    cases = {
        "sensor_msgs/Image": yarpy.Image(pixels),
        "std_msgs/Float64MultiArray": yarpy.Vector([1.0, 2.5]),
        "sensor_msgs/JointState": yarpy.Vector([1.0, 2.5]),
    }
    for name, value in cases.items():
        cls = LIBRARY.message(name)
        message = to_message(value, cls, stamp, "base")
        again = cls.from_ros(b"".join(message.to_ros()))
        assert to_value(again, type(value)) == value
        if name.startswith("sensor_msgs"):
            assert again.header.frame_id == "base"  # type: ignore[attr-defined]
            assert stamp_of(again) == yarpy.Stamp(0, 12.5)
    for numbers in ([1.0, 2.5], yarpy.Bottle([1.0, 2.5])):  # as ports send the angles of joints
        for name in ("std_msgs/Float64MultiArray", "sensor_msgs/JointState"):
            message = to_message(numbers, LIBRARY.message(name))
            assert to_value(message, yarpy.Vector) == yarpy.Vector([1.0, 2.5])
    header = to_message(stamp, LIBRARY.message("std_msgs/Header"))
    assert (header.stamp.sec, header.stamp.nanosec) == (12, 500_000_000)  # type: ignore[attr-defined]
    cloud = yarpy.PointCloud(np.zeros((4, 3)))
    message = to_message(cloud, LIBRARY.message("sensor_msgs/PointCloud2"), stamp)
    assert to_value(message, yarpy.PointCloud).width == 4
