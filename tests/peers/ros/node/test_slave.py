"""What nodes answer: three elements, always."""

from typing import Any

import pytest

from yarpy.names.node_name import NodeName
from yarpy.peers.ros.master import RosMaster
from yarpy.peers.ros.membership import Membership
from yarpy.peers.ros.node.parameters import Followed
from yarpy.peers.ros.node.slave import CALLS, answer


class Node:
    members = (
        Membership(NodeName("/n", "/out:o", "+"), "std_msgs/String"),
        Membership(NodeName("/n", "/in", "-")),
        Membership(NodeName("/n", "/srv", "-1")),
    )
    master_uri = "http://a:1/"
    host = "127.0.0.1"
    reason = ""
    parameters = Followed("/n", RosMaster(master_uri), "http://b:2/")

    def shut_down(self, reason: str) -> None:
        self.reason = reason


def ask(*words: Any) -> list[Any]:
    found = answer(Node(), words)
    assert found is not None
    return [*found]


def test_every_answer_has_three_elements() -> None:
    for name in CALLS:
        assert len(ask(name, "/rosnode")) == 3, name
        assert len(ask(name)) == 3, name


def test_topics_and_types() -> None:
    assert ask("getPublications", "/a") == [1, "", [["/out__o", "std_msgs/String"]]]
    assert ask("getSubscriptions", "/a") == [1, "", [["/in", "*"]]]
    assert ask("getMasterUri", "/a")[2] == "http://a:1/"
    assert ask("getPid", "/a")[2] == ask("pid", "/a")[2] > 0


def test_what_is_not_there_is_said() -> None:
    assert ask("requestTopic", "/a", "/in", [["TCPROS"]])[:2] == [0, "/in is not published here"]
    assert ask("publisherUpdate", "/a", "/out__o", [])[0] == 0
    assert ask("publisherUpdate", "/a", "/in", [])[0] == 1


@pytest.mark.parametrize("words", [[], [1], ["add", "/x"], ["list", "in"]])
def test_other_questions_are_left_to_the_port(words: list[Any]) -> None:
    assert answer(Node(), words) is None


def test_shutting_down() -> None:
    node = Node()
    answer(node, ["shutdown", "/master", "another node of that name"])
    assert node.reason == "another node of that name"
