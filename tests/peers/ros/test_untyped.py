"""Publishers that nobody has given a type, and the tools of ROS, which want one."""

from typing import Any

import pytest
from support.ros_graph import RosGraph
from support.wait import wait_until

import yarpy
from yarpy.names.node_name import NodeName
from yarpy.peers.ros.membership import Membership
from yarpy.peers.ros.message.convert.native import natural_type


def type_of(graph: RosGraph, topic: str) -> str:
    types = graph.master.call("getTopicTypes", "/test")
    return dict(types).get(topic, "")


def test_rostopic_hears_what_is_written(graph: RosGraph) -> None:
    with yarpy.Port("/untyped+@/writes") as out:
        wait_until(lambda: type_of(graph, "/untyped") == "*")
        out.write("hello")
        wait_until(lambda: type_of(graph, "/untyped") == "std_msgs/String")
        with graph.run("rostopic", "echo", "-n", "1", "/untyped") as echo:
            wait_until(lambda: out.write("once more") < 9 and "once more" in echo.stdout)
        with graph.run("rostopic", "hz", "-w", "3", "/untyped") as hz:
            wait_until(lambda: out.write("often") < 9 and "average rate" in hz.stdout)


def test_who_wants_another_type_gets_that(graph: RosGraph) -> None:
    with yarpy.Port("/numbers+@/counts") as out, yarpy.peers.ros.Node("/hears") as node:
        out.write(yarpy.Bottle([5]))
        wait_until(lambda: type_of(graph, "/numbers") == "std_msgs/Int32")
        heard: list[Any] = []
        node.subscriber("/numbers", "std_msgs/Float64", heard.append)
        wait_until(lambda: out.write(yarpy.Bottle([6])) < 9 and heard)
        assert heard[0].data == 6.0


@pytest.mark.parametrize(
    ("value", "name"),
    [
        ("text", "std_msgs/String"),
        (yarpy.Bottle(["text"]), "std_msgs/String"),
        (yarpy.Bottle([1, 2.5]), "std_msgs/Float64MultiArray"),
        (7, "std_msgs/Int32"),
        (yarpy.Bottle(["two", "words"]), None),
        ({"a": 1}, None),
        (yarpy.Bottle(), None),
    ],
)
def test_what_values_say(value: object, name: str | None) -> None:
    assert natural_type(value) == name


def test_who_does_not_learn() -> None:
    subscriber = Membership(NodeName("/n", "/t", "-"))
    assert not subscriber.learn("text")
    typed = Membership(NodeName("/n", "/t", "+"), "std_msgs/Int32")
    assert not typed.learn("text") and typed.type == "std_msgs/Int32"
