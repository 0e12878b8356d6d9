"""Where definitions of ROS 2 come from."""

from pathlib import Path

from yarpy.idl.ros2msg.library import Library, hash_of
from yarpy.idl.ros2msg.source import MESSAGES, SERVICES, Rosbags, Standard, distro, installed


def test_what_yarpy_brings_is_what_ros_has() -> None:
    standard, rosbags = Library([Standard()]), Library([Rosbags("jazzy")])
    for name in MESSAGES:
        if name != "audio_common_msgs/AudioData":  # which is not of ROS itself
            assert hash_of(standard.message(name)) == hash_of(rosbags.message(name)), name
    for name in SERVICES:
        standard.service(name)


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
    assert [*installed({"AMENT_PREFIX_PATH": "/a::/b"}).shares] == [
        Path("/a/share"),
        Path("/b/share"),
    ]
