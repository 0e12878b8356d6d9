"""Goals that are carried out, for ours and for actionlib's own clients."""

import json
import sys
import threading
from typing import Any

import pytest
from peers.ros.conftest import graph
from support.ros_graph import RosGraph
from support.wait import HANG, wait_until

from yarpy.peers.ros import ActionClient, ActionServer, Node
from yarpy.peers.ros.action.server import Goal
from yarpy.peers.ros.action.status import Status

__all__ = ["graph"]
FIBONACCI = "actionlib_tutorials/Fibonacci"

ASKS = """
import json, sys
import actionlib, rospy
from actionlib.msg import TestAction, TestGoal
rospy.init_node("asks", disable_signals=True)
client = actionlib.SimpleActionClient(sys.argv[1], TestAction)
def say(*words):
    print(json.dumps(words), flush=True)
say("server", client.wait_for_server(rospy.Duration(60)))
for number in map(int, sys.argv[2:]):
    told = []
    with client.action_client.manager.list_mutex:  # it forgets what comes while it still sends
        client.send_goal(TestGoal(number), feedback_cb=lambda f: told.append(f.feedback))
    if number < 0:
        while not told:
            rospy.sleep(0.01)
        client.cancel_goal()
    say("came", client.wait_for_result(rospy.Duration(60)))
    say(number, client.get_state(), client.get_result().result, len(told) > 0)
"""


def count(goal: Goal) -> object:
    """Twice the number; of a negative one how often feedback was told until it was canceled."""
    number = goal.request.goal
    if number == 13:
        raise RuntimeError("no thirteen")
    goal.feedback([number])
    told = 1
    while number < 0:
        if goal.wait(0.01):
            return goal.preempted([told])
        goal.feedback([told])
        told += 1
    return goal.aborted([-1], "too large") if number > 100 else [2 * number]


@pytest.mark.peer("actionlib")
def test_a_client_of_actionlib(graph: RosGraph) -> None:
    with Node("/serves") as node:
        server = ActionServer(node, "twice", "actionlib/Test", count, accept=lambda g: g.goal != 0)
        with graph.python(ASKS, "/twice", "21", "13", "0", "-1", "101") as peer:
            wait_until(lambda: len(peer.stdout.splitlines()) == 11, 2 * HANG, "eleven lines")
        said = [json.loads(line) for line in peer.stdout.splitlines()]
        server.close()
    assert said[0] == ["server", True]
    # Feedback that overtakes nothing may come behind the result, and is not told then.
    found = {item[0]: item[1:3] for item in said if isinstance(item[0], int)}
    assert found[21] == [Status.SUCCEEDED, 42]
    assert found[13] == [Status.ABORTED, 0]
    assert found[0] == [Status.REJECTED, 0]
    assert found[101] == [Status.ABORTED, -1]
    state, told = found[-1]
    assert state == Status.PREEMPTED and told > 0


def test_no_older_status_follows_a_newer_one(graph: RosGraph) -> None:
    """A client takes a goal that is not listed any more for lost."""
    told: list[int] = []
    entered, newer = threading.Event(), threading.Event()

    class Slow:
        def write(self, message: Any) -> None:
            goals = len(message.status_list)
            if not goals and not entered.is_set():
                entered.set()
                newer.wait(0.5)
            told.append(goals)
            if goals:
                newer.set()

    with Node("/serves") as node, Node("/asks") as asker:
        server = ActionServer(node, "/slow", "actionlib/Test", lambda goal: [1])
        client = ActionClient(asker, "/slow", "actionlib/Test")
        assert client.wait_for_server(HANG)
        server._status, status = Slow(), server._status
        assert entered.wait(HANG)
        goal = client.send([1])
        assert goal.result(HANG).result == 1
        wait_until(lambda: 1 in told)
        assert told == sorted(told)
        server._status = status


def test_a_client_of_ours(graph: RosGraph) -> None:
    told: list[object] = []

    def fibonacci(goal: Goal) -> object:
        numbers = [0, 1]
        while len(numbers) < goal.request.order:
            numbers.append(numbers[-1] + numbers[-2])
            goal.feedback([numbers])
            wait_until(lambda: len(told) == len(numbers) - 2)
        return {"sequence": numbers}

    with Node("/serves") as node, Node("/asks") as asker:
        ActionServer(node, "/fib", FIBONACCI, fibonacci)
        client = ActionClient(asker, "/fib", FIBONACCI)
        assert client.wait_for_server(HANG)
        goal = client.send({"order": 6}, told.append)
        assert [*goal.result(HANG).sequence] == [0, 1, 1, 2, 3, 5]
        assert goal.status == Status.SUCCEEDED and goal.done
        assert len(told) == 4


def test_what_accepts_goals_and_what_carries_them_out_may_fail(
    graph: RosGraph, caplog: pytest.LogCaptureFixture
) -> None:
    def accept(request: Any) -> bool:
        if request.goal == 1:
            raise ValueError("of the test")
        return True

    def run(goal: Goal) -> object:
        if goal.request.goal == 2:
            sys.exit("of the test")
        return [7]

    with Node("/serves") as node, Node("/asks") as asker:
        ActionServer(node, "/fails", "actionlib/Test", run, accept=accept, single=True)
        client = ActionClient(asker, "/fails", "actionlib/Test")
        assert client.wait_for_server(HANG)
        came = []
        for number in (1, 2, 3):
            goal = client.send([number])
            goal.result(HANG)
            came.append((goal.status.name, goal.text))
    assert came == [
        ("REJECTED", "ValueError: of the test"),
        ("ABORTED", "SystemExit: of the test"),
        ("SUCCEEDED", ""),
    ]
    assert "sys.exit() in a thread" in caplog.text


def test_a_single_goal_at_a_time(graph: RosGraph) -> None:
    running: list[int] = []
    most: list[int] = []
    lock = threading.Lock()

    def run(goal: Goal) -> object:
        with lock:
            running.append(goal.request.goal)
            most.append(len(running))
        while goal.request.goal < 3 and not goal.wait(0.05):
            pass
        with lock:
            running.remove(goal.request.goal)
        return goal.preempted([0]) if goal.canceling else [7]

    with Node("/serves") as node, Node("/asks") as asker:
        server = ActionServer(node, "/one", "actionlib/Test", run, single=True)
        client = ActionClient(asker, "/one", "actionlib/Test")
        assert client.wait_for_server(HANG)
        goals = []
        for number in (1, 2, 3):
            goals.append(client.send([number]))
            wait_until(lambda: len(server.goals) == len(goals))
        results = [goal.result(HANG).result for goal in goals]
    assert results[-1] == 7 and goals[-1].status == Status.SUCCEEDED
    assert all(goal.status in (Status.PREEMPTED, Status.RECALLED) for goal in goals[:2])
    assert max(most) == 1


def test_what_is_canceled(graph: RosGraph) -> None:
    with Node("/serves") as node, Node("/asks") as asker:
        server = ActionServer(node, "/twice", "actionlib/Test", count)
        client = ActionClient(asker, "/twice", "actionlib/Test")
        assert client.wait_for_server(HANG)
        first, second = client.send([-1]), client.send([-2])
        wait_until(lambda: first.status == second.status == Status.ACTIVE)
        first.cancel()
        assert first.result(HANG).result > 0
        assert first.status == Status.PREEMPTED
        assert not second.done
        client.cancel("")  # all
        second.result(HANG)
        assert second.status == Status.PREEMPTED
        wait_until(lambda: all(goal.status.is_over for goal in server.goals))


def test_a_goal_that_was_canceled_before_it_came(graph: RosGraph) -> None:
    with Node("/serves") as node, Node("/asks") as asker:
        server = ActionServer(node, "/twice", "actionlib/Test", count)
        client = ActionClient(asker, "/twice", "actionlib/Test")
        assert client.wait_for_server(HANG)
        kind = asker.publisher("/x", "actionlib_msgs/GoalID").type
        made = kind()
        made.id = "later"
        server._cancel(made)
        message = client.types.ActionGoal()
        message.goal_id.id = "later"  # type: ignore[attr-defined]
        server._take(message)
        (goal,) = server.goals
        assert goal.status == Status.RECALLED
        server._take(message)  # the same once more
        assert len(server.goals) == 1


def test_goals_that_are_over_are_forgotten(
    graph: RosGraph, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("yarpy.peers.ros.action.server.REMEMBERED", 0.0)
    with Node("/serves") as node, Node("/asks") as asker:
        server = ActionServer(node, "/twice", "actionlib/Test", count)
        client = ActionClient(asker, "/twice", "actionlib/Test")
        assert client.wait_for_server(HANG)
        assert client.send([4]).result(HANG).result == 8
        wait_until(lambda: not server.goals)


def test_the_end_of_the_node_ends_goals(graph: RosGraph) -> None:
    ended = threading.Event()

    def run(goal: Goal) -> object:
        goal.wait(HANG)
        ended.set()
        return goal.preempted()

    with Node("/asks") as asker:
        with Node("/serves") as node:
            server = ActionServer(node, "/slow", "actionlib/Test", run)
            client = ActionClient(asker, "/slow", "actionlib/Test")
            assert client.wait_for_server(HANG)
            client.send([1])
            wait_until(lambda: server.goals and server.goals[0].status == Status.ACTIVE)
        assert ended.wait(HANG)
        server._thread.join(HANG)
        assert not server._thread.is_alive()
