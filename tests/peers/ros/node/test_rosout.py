"""The log of a node, as rospy and the tools of ROS hear it."""

from __future__ import annotations

import logging
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
from support.ros_graph import RosGraph
from support.wait import HANG, wait_until

from yarpy.errors import PortClosed
from yarpy.peers.ros.node.node import Node
from yarpy.peers.ros.node.rosout import LEVELS, TOPIC, TYPE, Rosout

CONSOLE = """
import rospy
from rosgraph_msgs.msg import Log
rospy.init_node("console", disable_signals=True)
def hear(m):
    if m.name == "/arm":
        print(m.level, m.header.stamp.to_sec() > 1e9, m.function, m.msg, flush=True)
rospy.Subscriber("/rosout", Log, hear)
print("ready", flush=True)
rospy.spin()
"""


class Place:
    """Stands in for a node: what is opened, and what is published."""

    name = "/arm"

    def __init__(self) -> None:
        self.opened: list[str] = []
        self.said: list[Any] = []
        self.handlers: dict[str, Callable[[Any], Any]] = {}
        self.closed = False

    def publisher(self, topic: str, type_: Any, *, latch: bool, queue_size: int) -> Place:
        assert (topic, type_, latch) == (TOPIC, TYPE, True)
        self.opened.append(topic)
        return self

    def service(self, service: str, type_: Any, handler: Callable[[Any], object]) -> None:
        self.opened.append(service)
        self.handlers[service] = handler

    def write(self, value: Any) -> None:
        if self.closed:
            raise PortClosed("/arm was closed")
        if "refuse" in value["msg"]:
            raise ValueError("it does not fit")
        self.said.append(value)


def test_records_become_messages(caplog: pytest.LogCaptureFixture) -> None:
    place, rosout = Place(), Rosout()
    logger = rosout.of(place)
    assert rosout.of(place) is logger
    assert place.opened == [TOPIC, "~get_loggers", "~set_logger_level"]
    logger.debug("nobody wants this")
    logger.warning("%s is hot", "it")
    try:
        raise ValueError("too far")
    except ValueError:
        logger.exception("it moved")
    logger.log(25, "between two levels")
    logger.critical("the end")
    assert [(each["level"], each["msg"]) for each in place.said] == [
        (4, "it is hot"),
        (8, "it moved: ValueError('too far')"),
        (2, "between two levels"),
        (16, "the end"),
    ]
    first = place.said[0]
    assert (first["name"], first["file"]) == ("/arm", __file__)
    assert first["function"] == "test_records_become_messages" and first["line"] > 0
    assert "it is hot" in caplog.text


def test_levels_are_set_by_others() -> None:
    place, rosout = Place(), Rosout()
    logger = rosout.of(place)

    def set_level(name: str, level: str) -> None:
        place.handlers["~set_logger_level"](SimpleNamespace(logger=name, level=level))

    def levels() -> Any:
        return place.handlers["~get_loggers"](None)

    assert levels() == [[{"name": "rosout", "level": "info"}]]
    for level, (number, _) in LEVELS.items():
        set_level("rosout", level.upper())
        assert logger.level == number
        assert levels() == [[{"name": "rosout", "level": level}]]
    with pytest.raises(LookupError, match='"loud" is no level: take debug, info'):
        set_level("rosout", "loud")
    with pytest.raises(LookupError, match='no logger "other" here: there is rosout'):
        set_level("other", "info")
    logger.setLevel(5)
    assert levels() == [[{"name": "rosout", "level": "debug"}]]


def test_what_cannot_be_told(capsys: pytest.CaptureFixture[str]) -> None:
    place, rosout = Place(), Rosout()
    logger = rosout.of(place)
    logger.propagate = False
    logger.info("refuse this")  # the program goes on
    assert "ValueError: it does not fit" in capsys.readouterr().err
    place.closed = True
    logger.info("after the end")
    assert not capsys.readouterr().err


def test_the_console_of_rospy(graph: RosGraph) -> None:
    """What was said before somebody listens comes, too: the last of it."""
    with Node("/arm") as node, graph.python(CONSOLE) as console:
        assert "/arm" not in graph.tool("rosservice", "list")  # it has said nothing yet
        node.logger.info("before anybody hears")
        console.wait_line("ready")
        console.wait_line("2 True test_the_console_of_rospy before anybody hears")
        node.logger.error("hot: %d degrees", 80)
        console.wait_line("8 True test_the_console_of_rospy hot: 80 degrees")
        loggers = graph.tool("rosservice", "call", "/arm/get_loggers")
        assert 'name: "rosout"' in loggers and 'level: "info"' in loggers
        graph.tool("rosservice", "call", "/arm/set_logger_level", "rosout", "debug")
        assert node.logger.isEnabledFor(logging.DEBUG)
        node.logger.debug("now this, too")
        console.wait_line("1 True test_the_console_of_rospy now this, too")
        refused = graph.tool("rosservice", "call", "/arm/set_logger_level", "rosout", "loud")
        assert "is no level" in refused


def test_two_nodes_hear_each_other(graph: RosGraph) -> None:
    heard: list[Any] = []
    with Node("/one") as one, Node("/two") as two:
        two.subscriber(TOPIC, TYPE, heard.append)
        one.logger.warning("hello")
        wait_until(lambda: any(each.msg == "hello" for each in heard), timeout=HANG)
        found = next(each for each in heard if each.msg == "hello")
        assert (found.name, found.level) == ("/one", found.WARN)
