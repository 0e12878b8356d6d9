"""Goals that are carried out, asked for by ours and by an implementation of others."""

import json
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from peers.ros2.conftest import names, router
from support.process import Process
from support.ros2_peer import ACTION, peer_command, peer_environment
from support.wait import HANG, wait_until

import yarpy
from yarpy.peers import ros2
from yarpy.peers.ros2.action import server as module
from yarpy.peers.ros2.action.client import ActionClient
from yarpy.peers.ros2.action.server import ActionServer, Goal
from yarpy.peers.ros2.action.status import Status, new_id

__all__ = ["names", "router"]
FIBONACCI = "example_interfaces/action/Fibonacci"


def execute(goal: Goal) -> object:
    """The numbers, at once; of negative ones those until it is canceled; none of 12 and 13."""
    numbers = [0, 1]
    order = goal.request.order
    if order == 13:
        raise RuntimeError("no thirteen")
    if order == 12:
        sys.exit("no twelve")
    while len(numbers) < order or order < 0:
        numbers.append(numbers[-1] + numbers[-2] & 0xFFFF)
        goal.feedback([numbers])
        if goal.wait(0.01 if order < 0 else 0.0):
            return goal.canceled([numbers])
    return goal.aborted([[]]) if order == 4 else [numbers]


@pytest.fixture
def node(names: yarpy.LocalNames) -> Iterator[ros2.Node]:
    with ros2.Node("/robot/server") as found:
        yield found


@pytest.fixture
def server(node: ros2.Node) -> ActionServer:
    return node.action_server("fib", FIBONACCI, execute, accept=lambda goal: goal.order != 0)


@pytest.fixture
def client(server: ActionServer) -> Iterator[ActionClient]:
    with ros2.Node("/asker") as asker:
        found = asker.action_client("/robot/fib", FIBONACCI)
        assert found.wait_for_server(HANG)
        yield found


@pytest.mark.parametrize(
    ("order", "status", "numbers"),
    [
        (6, 4, [0, 1, 1, 2, 3, 5]),
        (13, Status.ABORTED, []),
        (12, Status.ABORTED, []),
        (4, Status.ABORTED, []),
    ],
)
def test_a_goal(client: ActionClient, order: int, status: int, numbers: list[int]) -> None:
    told: list[Any] = []
    goal = client.send([order], told.append)
    assert [*goal.result(HANG).sequence] == numbers
    assert goal.status == status and goal.done
    wait_until(lambda: len(told) == (0 if order in (12, 13) else order - 2))


def test_a_goal_that_is_canceled(client: ActionClient, server: ActionServer) -> None:
    first, second = client.send([-1]), client.send([-1])
    wait_until(lambda: first.status == Status.EXECUTING)
    first.cancel(HANG)
    assert len(first.result(HANG).sequence) > 2
    assert first.status == Status.CANCELED
    assert not second.done
    with pytest.raises(yarpy.errors.RemoteProtocolError, match="TERMINATED"):
        first.cancel(HANG)
    with pytest.raises(yarpy.errors.RemoteProtocolError, match="UNKNOWN_GOAL"):
        client.cancel(new_id(), HANG)
    client.cancel(bytes(16), HANG)  # all of them
    second.result(HANG)
    assert second.status == Status.CANCELED
    assert [goal.status for goal in server.goals] == [Status.CANCELED] * 2


def test_what_is_not_accepted(client: ActionClient, server: ActionServer) -> None:
    with pytest.raises(yarpy.errors.LocalProtocolError, match="does not accept"):
        client.send([0])
    assert not server.goals


def test_a_result_that_is_not_known(client: ActionClient) -> None:
    answer = client.ask_result(new_id()).result(HANG)
    assert (answer.status, [*answer.result.sequence]) == (Status.UNKNOWN, [])


def test_goals_that_are_over_are_forgotten(
    client: ActionClient, server: ActionServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "REMEMBERED", 2)
    for _ in range(4):
        client.send([3]).result(HANG)
    assert len(server.goals) == 2


def test_a_refused_cancel(node: ros2.Node) -> None:
    free = threading.Event()

    def wait(goal: Goal) -> object:
        free.wait(HANG)
        return [[7]]

    node.action_server("stubborn", FIBONACCI, wait, cancel=lambda goal: False)
    with ros2.Node("/asker") as asker:
        client = asker.action_client("/robot/stubborn", FIBONACCI)
        assert client.wait_for_server(HANG)
        goal = client.send([1])
        with pytest.raises(yarpy.errors.RemoteProtocolError, match="REJECTED"):
            goal.cancel(HANG)
        free.set()
        assert [*goal.result(HANG).sequence] == [7]


def test_a_server_that_ends_cancels_what_is_under_way(
    names: yarpy.LocalNames,
) -> None:
    ended = threading.Event()

    def run(goal: Goal) -> object:
        ended.wait(0) or goal.wait(HANG)
        ended.set()
        return goal.canceled()

    with ros2.Node("/asker") as asker:
        with ros2.Node("/short") as short:
            short.action_server("/end", FIBONACCI, run)
            client = asker.action_client("/end", FIBONACCI)
            assert client.wait_for_server(HANG)
            client.send([1])
        assert ended.wait(HANG)


def test_zenoh_ros2_sdk_sends_a_goal(server: ActionServer, router: int, tmp_path: Path) -> None:
    peers = []
    for what in ACTION:
        type_, hash_, request, response = ACTION[what]
        words = (f"type={type_}", f"hash={hash_}", f"request={request}", f"response={response}")
        command = peer_command(router, "ask", f"/robot/fib/_action/{what}", *words)
        peers.append(Process(command, env=peer_environment(tmp_path)))
    with peers[0] as send, peers[1] as get:
        for peer in peers:
            wait_until(lambda: "ready" in peer.stdout, 2 * HANG)  # noqa: B023
        id_ = [*new_id()]
        send.write(json.dumps({"goal_id": id_, "order": 5}) + "\n")
        wait_until(lambda: len(send.stdout.splitlines()) > 1)
        assert json.loads(send.stdout.splitlines()[1])["accepted"] is True
        get.write(json.dumps({"goal_id": id_}) + "\n")
        wait_until(lambda: len(get.stdout.splitlines()) > 1)
        assert json.loads(get.stdout.splitlines()[1]) == {"status": 4, "sequence": [0, 1, 1, 2, 3]}
