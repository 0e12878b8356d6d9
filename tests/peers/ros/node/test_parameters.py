"""Parameters: what is kept of them, and who is told that they changed."""

from __future__ import annotations

import queue
import sys
from typing import Any

import pytest
from support.ros_graph import RosGraph
from support.wait import HANG, wait_until

from yarpy.errors import NoNameServer, UnknownName
from yarpy.peers.ros.master import RosMaster, call, parse_uri
from yarpy.peers.ros.node.node import Node
from yarpy.peers.ros.node.parameters import UNSET, Followed

CACHING = """
import rospy
rospy.init_node("caching", disable_signals=True)
last = None
while True:
    now = rospy.get_param_cached("/leg/rate")
    if now != last:
        print("has", now, flush=True)
    last = now
    rospy.sleep(0.05)
"""


class Master:
    """Counts questions, and answers from `values`."""

    uri = "http://a:1/"

    def __init__(self, **values: Any) -> None:
        self.values = {f"/{name}": value for name, value in values.items()}
        self.asked: list[tuple[str, str]] = []
        self.during: Any = lambda: None

    def call(self, method: str, *words: Any, timeout: float | None = None) -> Any:
        self.asked.append((method, words[-1]))
        found = self.values.get(words[-1], {})
        self.during()
        return found


def followed(master: Any) -> Followed:
    return Followed("/n", master, "http://b:2/")


def test_it_is_asked_once_until_it_changes() -> None:
    master = Master(rate=5)
    known = followed(master)
    assert not known
    assert [known.get("/rate"), known.get("/rate"), known.get("/none")] == [5, 5, UNSET]
    assert master.asked == [("subscribeParam", "/rate"), ("subscribeParam", "/none")]
    assert known
    master.values["/rate"] = 6
    assert known.get("/rate") == 5  # nobody has told
    assert known.change("/rate/") and known.get("/rate") == 6
    known.end()
    assert sorted(master.asked[3:]) == [
        ("unsubscribeParam", "/none"),
        ("unsubscribeParam", "/rate"),
    ]


@pytest.mark.parametrize(
    ("changed", "told"),
    [("/a/b", True), ("/a", True), ("/a/b/c", True), ("/", True), ("/a/bc", False), ("/b", False)],
)
def test_what_is_above_and_below_changes_too(changed: str, told: bool) -> None:
    master = Master()
    known = followed(master)
    known.get("/a/b")
    assert known.change(changed) is told
    known.get("/a/b")
    assert len(master.asked) == (2 if told else 1)


def test_a_change_while_it_is_asked_is_not_missed() -> None:
    master = Master(rate=5)
    known = followed(master)
    master.during = lambda: known.change("/rate")
    assert known.get("/rate") == 5
    master.during, master.values["/rate"] = (lambda: None), 6
    assert known.get("/rate") == 6


def test_a_master_that_does_not_answer_is_told_of_the_end_once() -> None:
    """Else closing a node would take two seconds for each of its parameters."""
    master = Master(a=1, b=2, c=3)
    known = followed(master)
    for name in ("/a", "/b", "/c"):
        known.get(name)

    def silent() -> None:
        raise NoNameServer("silent")

    master.asked.clear()
    master.during = silent
    known.end()
    assert [method for method, _ in master.asked] == ["unsubscribeParam"]


def test_our_node_hears_of_changes(graph: RosGraph) -> None:
    told: queue.SimpleQueue[Any] = queue.SimpleQueue()

    def heard() -> Any:
        return told.get(timeout=HANG)

    with Node("/caching_node") as node:
        with pytest.raises(UnknownName, match="no parameter /arm/rate at http"):
            node.get_param_cached("/arm/rate")
        assert node.get_param_cached("/arm/rate", 7) == 7
        node.subscribe_param("/arm", told.put)
        assert heard() is None
        graph.tool("rosparam", "set", "/arm/rate", "30")
        assert heard() == {"rate": 30}
        assert node.get_param_cached("/arm/rate") == 30
        graph.tool("rosparam", "set", "/arm", "{rate: 31, name: '[send]'}")
        assert heard() == {"rate": 31, "name": "[send]"}
        wait_until(lambda: node.get_param_cached("/arm/rate") == 31, HANG, "it is told")
        node.set_param("/arm/rate", 32)  # the master does not tell who sets it
        assert node.get_param_cached("/arm/rate") == 32
        assert heard()["rate"] == 32
        node.set_param("/arm/rate", 32)  # as it was: nobody is told
        graph.tool("rosparam", "delete", "/arm")
        assert heard() is None
        wait_until(lambda: node.get_param_cached("/arm/rate", 0) == 0, HANG, "it is told")
        where = parse_uri(node.uri)
    with pytest.raises(NoNameServer):
        RosMaster(f"http://{where.contact.address}/").call("paramUpdate", "/m", "/arm/", 1)


def test_whoever_is_not_told_of_a_parameter_says_so(graph: RosGraph) -> None:
    with Node("/indifferent") as node, pytest.raises(Exception, match="nobody here subscribes to"):
        call(parse_uri(node.uri), "paramUpdate", "/master", "/arm/rate/", 1)


def test_a_callback_that_fails_is_called_again(
    graph: RosGraph, caplog: pytest.LogCaptureFixture
) -> None:
    seen: queue.SimpleQueue[Any] = queue.SimpleQueue()

    def fails(value: Any) -> None:
        seen.put(value)
        if value is None:
            sys.exit("too early")
        raise ValueError("too fast")

    with Node("/failing") as node:
        node.subscribe_param("~speed", fails)
        assert seen.get(timeout=HANG) is None
        node.set_param("~speed", 2)
        assert seen.get(timeout=HANG) == 2
    assert "the callback of /failing/speed failed" in caplog.text


def test_rospy_hears_what_we_set(graph: RosGraph) -> None:
    """A node of rospy that caches a parameter has what ours sets."""
    with Node("/setting") as node:
        node.set_param("/leg/rate", 1)
        with graph.python(CACHING) as caching:
            caching.wait_line("has 1")
            node.set_param("/leg/rate", 2)
            caching.wait_line("has 2")


def test_a_master_that_was_away_is_asked_again(graph: RosGraph) -> None:
    told: queue.SimpleQueue[Any] = queue.SimpleQueue()
    with Node("/patient") as node:
        node.subscribe_param("/wheel", told.put)
        assert told.get(timeout=HANG) is None
        graph.core.stop()
        graph.start()  # it knows neither of the parameter nor of us
        assert node.get_param("/wheel", 0) == 0
        graph.tool("rosparam", "set", "/wheel", "3")
        assert told.get(timeout=HANG) == 3
        graph.tool("rosparam", "set", "/wheel", "4")
        assert told.get(timeout=HANG) == 4
