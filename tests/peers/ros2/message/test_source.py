"""Where definitions of ROS 2 come from."""

import os
from pathlib import Path

import pytest

from yarpy.errors import UnknownType
from yarpy.peers.ros2.kind import humble
from yarpy.peers.ros2.message.library import default_library
from yarpy.peers.ros2.message.source import Rosbags, Shipped, Standard, distro, installed


def test_rosbags_is_asked_for_messages_alone() -> None:
    source = Rosbags("humble")
    assert source.find("std_msgs/String", "srv") is None
    assert source.find("std_msgs/Nothing", "msg") is None
    assert (source.find("std_msgs/String", "msg") or "").split() == ["string", "data"]
    assert "Humble" in str(source)
    assert "yarpy" in str(Standard())


def test_packages_of_jazzy_are_not_taken_for_those_of_humble() -> None:
    """Which has another NavigateToPose, and no hash that would tell."""
    name = "nav2_msgs/action/NavigateToPose"
    assert Shipped().find("nav2_msgs/NavigateToPose", "action")
    assert "Jazzy" in str(Shipped())
    default_library().load(name)
    with pytest.raises(UnknownType, match="AMENT_PREFIX_PATH"):
        humble().load(name)


def test_distribution() -> None:
    assert distro({"ROS_DISTRO": "kilted"}) == "kilted"
    assert distro({}) == distro({"ROS_DISTRO": "noetic"}) == "jazzy"


def test_prefixes() -> None:
    assert [*installed({"AMENT_PREFIX_PATH": os.pathsep.join(("/a", "", "/b"))}).shares] == [
        Path("/a/share"),
        Path("/b/share"),
    ]
