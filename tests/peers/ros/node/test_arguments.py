"""The command line of nodes of ROS 1, and what the tools of ROS see of it."""

import sys
from typing import Any

import pytest
from support.ros_graph import RosGraph

from yarpy.errors import AddressError
from yarpy.peers.ros.node.arguments import Arguments, parse_arguments, parse_value
from yarpy.peers.ros.node.node import Node


def test_what_is_the_programs_own() -> None:
    found = parse_arguments(["me", "-v", "a:=b", "file", "--x:=y", ":=z"], {})
    assert found.rest == ("me", "-v", "file", "--x:=y", ":=z")
    assert (found.special, dict(found.remaps), found.parameters) == ({}, {"a": "b"}, {})


@pytest.mark.parametrize(
    ("words", "namespace", "asked", "name"),
    [
        ([], "", "talker", "/talker"),
        ([], "/lab", "talker", "/lab/talker"),
        ([], "/lab", "/talker", "/talker"),
        (["__name:=left"], "", "/talker", "/left"),
        (["__name:=left"], "/lab", "/talker", "/lab/left"),  # <group ns="lab"> of roslaunch
        (["__name:=left"], "", "/lab/talker", "/lab/left"),
        (["__ns:=/lab"], "/other", "/talker", "/lab/talker"),
        (["__ns:=lab/two", "__name:=left"], "", "talker", "/lab/two/left"),
    ],
)
def test_the_name_of_the_node(words: list[str], namespace: str, asked: str, name: str) -> None:
    assert parse_arguments(words, {"ROS_NAMESPACE": namespace}).node(asked) == name


@pytest.mark.parametrize(
    ("word", "name", "found"),
    [
        ("chatter:=/news", "/lab/chatter", "/news"),
        ("chatter:=news", "/lab/chatter", "/lab/news"),
        ("~goal:=/goal", "/lab/arm/goal", "/goal"),
        ("/lab/chatter:=~mine", "/lab/chatter", "/lab/arm/mine"),
        ("chatter:=/news", "/chatter", "/chatter"),
    ],
)
def test_remappings(word: str, name: str, found: str) -> None:
    assert parse_arguments([word], {}).remap(name, "/lab/arm") == found


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("3", 3),
        ("2.5", 2.5),
        ("True", True),
        ("no", False),
        ("[1, 2]", [1, 2]),
        ("hello", "hello"),
        ("'3'", "3"),
        ("a: [", "a: ["),
    ],
)
def test_values(monkeypatch: pytest.MonkeyPatch, text: str, value: object) -> None:
    for _ in range(2):
        found = parse_value(text)
        assert found == value and type(found) is type(value)
        monkeypatch.setitem(sys.modules, "yaml", None)  # once more without


def test_names_that_are_none() -> None:
    with pytest.raises(AddressError):
        parse_arguments(["__name:=a b"], {}).node("/talker")
    assert Arguments().node("talker") == "/talker"


def test_as_the_tools_of_ros_see_it(graph: RosGraph) -> None:
    words = ["__name:=left", "__ns:=/lab", "chatter:=/news", "_gain:=2.5", "__log:=/tmp/x.log"]
    with Node("/talker", arguments=words) as node:
        node.publisher("chatter", "std_msgs/String", latch=True).write("hello")
        assert graph.tool("rosnode", "list").split() == ["/lab/left"]
        assert "hello" in graph.tool("rostopic", "echo", "-n1", "/news")
        listed: Any = node.get_param("~gain")
        assert listed == 2.5 and "2.5" in graph.tool("rosparam", "get", "/lab/left/gain")
