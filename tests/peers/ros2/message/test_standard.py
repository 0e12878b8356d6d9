"""The definitions of ROS 2 that are always there."""

from yarpy.peers.ros2.message.library import Library, hash_of
from yarpy.peers.ros2.message.source import Rosbags, Standard
from yarpy.peers.ros2.message.standard import MESSAGES, SERVICES


def test_what_yarpy_brings_is_what_ros_has() -> None:
    standard, rosbags = Library([Standard()]), Library([Rosbags("jazzy")])
    for name in MESSAGES:
        if name != "audio_common_msgs/AudioData":  # which is not of ROS itself
            assert hash_of(standard.message(name)) == hash_of(rosbags.message(name)), name
    for name in SERVICES:
        standard.service(name)
