"""Goals that are sent to actionlib's own server, and to nobody."""

import threading

import pytest
from peers.ros.conftest import graph
from support.ros_graph import RosGraph
from support.wait import HANG, wait_until

from yarpy.errors import LinkClosed, Timeout
from yarpy.peers.ros import ActionClient, ActionServer, Node
from yarpy.peers.ros.action import client as module
from yarpy.peers.ros.action.status import Status

__all__ = ["graph"]

SERVES = """
import sys
import actionlib, rospy
from actionlib.msg import TestAction, TestFeedback, TestResult
rospy.init_node("serves_theirs", disable_signals=True)
def run(goal):
    if goal.goal == 13:
        return server.set_aborted(TestResult(-13), "no thirteen")
    server.publish_feedback(TestFeedback(goal.goal))
    while goal.goal < 0:
        if server.is_preempt_requested():
            return server.set_preempted(TestResult(-1))
        rospy.sleep(0.01)
    server.set_succeeded(TestResult(2 * goal.goal))
server = actionlib.SimpleActionServer(sys.argv[1], TestAction, run, False)
server.start()
print("ready", flush=True)
rospy.spin()
"""


@pytest.mark.peer("actionlib")
def test_a_server_of_actionlib(graph: RosGraph) -> None:
    with graph.python(SERVES, "/theirs") as peer, Node("/asks") as node:
        wait_until(lambda: "ready" in peer.stdout, 2 * HANG)
        client = ActionClient(node, "/theirs", "actionlib/TestAction")
        assert client.wait_for_server(HANG)
        told: list[int] = []
        goal = client.send([21], lambda feedback: told.append(feedback.feedback))
        assert goal.result(HANG).result == 42
        assert goal.status == Status.SUCCEEDED
        wait_until(lambda: told == [21], what="feedback, which may come behind the result")
        goal = client.send([13])
        assert goal.result(HANG).result == -13
        assert (goal.status, goal.text) == (Status.ABORTED, "no thirteen")
        goal = client.send([-1])
        wait_until(lambda: goal.status == Status.ACTIVE)
        with pytest.raises(Timeout, match="no result within"):
            goal.result(0.01)
        goal.cancel()
        assert goal.result(HANG).result == -1
        assert goal.status == Status.PREEMPTED


def test_nobody_is_there(graph: RosGraph) -> None:
    with Node("/asks") as node:
        client = ActionClient(node, "/nobody", "actionlib/Test")
        assert not client.wait_for_server(0.05)
        with pytest.raises((TypeError, ValueError)):
            client.send(["many"])
        client.close()


def test_another_server_at_once_does_not_know_the_goal(
    graph: RosGraph, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As one that was killed, and was started again by roslaunch."""
    monkeypatch.setattr(module, "GRACE", 0.5)
    with Node("/asks") as asker:
        client = ActionClient(asker, "/again", "actionlib/Test")
        first = Node("/serves")
        server = ActionServer(first, "/again", "actionlib/Test", lambda goal: goal.wait(HANG))
        assert client.wait_for_server(HANG)
        goal = client.send([1])
        wait_until(lambda: goal.listed)
        monkeypatch.setattr(server, "_end", lambda goal, found: None)  # no last words
        with Node("/serves_again") as second:
            ActionServer(second, "/again", "actionlib/Test", lambda goal: None)
            wait_until(lambda: len(client._goal.outputs) == 2)
            threading.Thread(target=first.close, daemon=True).start()
            with pytest.raises(LinkClosed, match="went away"):
                goal.result(HANG)
            assert goal.status == Status.LOST
            wait_until(lambda: goal.forgotten)
        first.close()


def test_a_server_that_goes(graph: RosGraph, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "GRACE", 0.2)
    with Node("/asks") as asker:
        with Node("/short") as short:
            ActionServer(short, "/goes", "actionlib/Test", lambda goal: goal.wait(HANG) and None)
            client = ActionClient(asker, "/goes", "actionlib/Test")
            assert client.wait_for_server(HANG)
            goal = client.send([1])
            wait_until(lambda: goal.status == Status.ACTIVE)
        try:  # its last words may come, and may not
            goal.result(HANG)
        except LinkClosed as error:
            assert "went away" in str(error) and goal.status == Status.LOST
        else:
            assert goal.done
