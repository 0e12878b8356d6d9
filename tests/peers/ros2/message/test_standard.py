"""The definitions of ROS 2 that are always there."""

import json

import pytest
from support import rclpy_venv
from support.type_hashes import hashes_of, names_of, others

from yarpy.peers.ros2.message import standard as definitions
from yarpy.peers.ros2.message.library import Library, hash_of
from yarpy.peers.ros2.message.source import Rosbags, Standard
from yarpy.peers.ros2.message.standard import MESSAGES, SERVICES

EXAMPLES = "example_interfaces/"


def test_what_yarpy_brings_is_what_ros_has() -> None:
    standard, rosbags = Library([Standard()]), Library([Rosbags("jazzy")])
    for name in MESSAGES:
        # AudioData is not of ROS itself, and the examples rosbags does not know
        if name != "audio_common_msgs/AudioData" and not name.startswith(EXAMPLES):
            assert hash_of(standard.message(name)) == hash_of(rosbags.message(name)), name
    both = Library([Standard(), Rosbags("jazzy")])
    for name in SERVICES:
        both.service(name)


def test_examples_are_those_of_std_msgs() -> None:
    """With the names of their packages exchanged."""
    standard, rosbags = Library([Standard()]), Library([Rosbags("jazzy")])
    count = 0
    for name in MESSAGES:
        if not name.startswith(EXAMPLES) or "WString" in name:  # which rosbags does not know
            continue
        other = rosbags.message(name.replace(EXAMPLES, "std_msgs/"))
        found = standard.message(name)
        assert [*found().to_dict()] == [*other().to_dict()], name
        assert b"".join(found().to_ros()) == b"".join(other().to_ros()), name
        count += 1
    assert count == 28


def test_hashes_of_the_examples_are_those_of_ros() -> None:
    published = hashes_of("example_interfaces")
    named = {name for name in names_of(definitions) if name.startswith(EXAMPLES)}
    # those of the action are in test_action.py
    assert {name for name in named if "/action/" not in name} == published.keys()
    assert others(published, Library([Standard()])) == []


@pytest.mark.peer("rclpy")
def test_services_are_those_of_ros_itself() -> None:
    known = Library([Standard(), Rosbags("kilted")])
    compared = 0
    for name in SERVICES:
        package, _, type_ = name.partition("/")
        share = rclpy_venv.prepare().parents[1] / "share"
        file = share / package / "srv" / f"{type_}.json"
        if file.exists():  # example_interfaces and tf2_msgs are not among those wheels
            said = json.loads(file.read_text())["type_hashes"][0]
            assert said["type_name"] == f"{package}/srv/{type_}"
            assert hash_of(known.service(name)) == said["hash_string"], name
            compared += 1
    assert compared > 20
