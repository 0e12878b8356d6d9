"""Where definitions of ROS 2 come from."""

import os
from pathlib import Path

from yarpy.peers.ros2.message.source import Rosbags, Standard, distro, installed


def test_rosbags_is_asked_for_messages_alone() -> None:
    source = Rosbags("humble")
    assert source.find("std_msgs/String", "srv") is None
    assert source.find("std_msgs/Nothing", "msg") is None
    assert (source.find("std_msgs/String", "msg") or "").split() == ["string", "data"]
    assert "Humble" in str(source)
    assert "yarpy" in str(Standard())


def test_distribution() -> None:
    assert distro({"ROS_DISTRO": "kilted"}) == "kilted"
    assert distro({}) == distro({"ROS_DISTRO": "noetic"}) == "jazzy"


def test_prefixes() -> None:
    assert [*installed({"AMENT_PREFIX_PATH": os.pathsep.join(("/a", "", "/b"))}).shares] == [
        Path("/a/share"),
        Path("/b/share"),
    ]
