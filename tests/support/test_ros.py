"""ROS 1 as a peer: its Python answers, and tells what is installed."""

import pytest
from support import ros

pytestmark = pytest.mark.peer("ros")


def test_it_answers() -> None:
    assert ros.ask("answer = given + 1", 41) == 42


def test_installed_types_are_listed() -> None:
    assert ros.installed()["msg std_msgs/String"][0] == "992ce8a1687cec8c8bd883ec73ca41d1"
