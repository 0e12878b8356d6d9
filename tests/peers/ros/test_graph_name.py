"""Names and types as ROS spells them."""

import doctest

import pytest

from yarpy.errors import AddressError
from yarpy.peers.ros import graph_name
from yarpy.peers.ros.graph_name import check_graph_name, master_type


def test_types_for_the_master() -> None:
    assert [master_type(item) for item in ("", "*", "yarp/vector", "std_msgs/String")] == [
        *("*", "*", "yarp/vector", "std_msgs/String")
    ]
    assert master_type("std_msgs/msg/String") == "std_msgs/String"
    for refused in ("a/b/c", "bad~x/Type", "two words", "/x", "x/", "std_msgs/String\n", "é/Type"):
        assert master_type(refused) == "*", refused


@pytest.mark.parametrize("name", ["/", "chatter", "/1st", "/a-b", "/a/", "//a", "/a b", "/a/\n"])
def test_what_ros_cannot_spell_is_refused(name: str) -> None:
    with pytest.raises(AddressError, match="ROS has no names like"):
        check_graph_name(name)


def test_examples() -> None:
    assert doctest.testmod(graph_name).failed == 0
