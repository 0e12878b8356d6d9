"""A node over DDS, and how a program of another kind makes use of it."""

from __future__ import annotations

from typing import Any

from support.wait import HANG

from yarpy.peers import ros2
from yarpy.peers.ros2.action.server import Goal

FIBONACCI = "example_interfaces/action/Fibonacci"


def count(goal: Goal) -> list[Any]:
    numbers = [0, 1]
    while len(numbers) < goal.request.order:
        numbers.append((numbers[-1] + numbers[-2]) % 2**31)
        goal.feedback([numbers])
        if goal.wait(0.001):
            return goal.canceled([numbers])  # type: ignore[return-value]
    return [numbers]


def test_parameters(node_peer: Any, own: str) -> None:
    with ros2.Node(own, parameters={"gain": 2.5}, rmw="dds") as node:
        names = node_peer.do("list", own)
        assert {"gain", "use_sim_time"} <= set(names)
        with ros2.Node(f"{own}_asker", rmw="dds") as asker:
            theirs = asker.parameters_of(own, timeout=HANG)
            theirs.set("gain", 3.5)
            assert node.parameters.get("gain") == theirs.get("gain") == 3.5


def test_actions(node_peer: Any, own: str) -> None:
    with ros2.Node(own, rmw="dds") as node, ros2.Node(f"{own}_asker", rmw="dds") as asker:
        node.action_server(f"{own}/count", FIBONACCI, count)
        assert node_peer.do("goal", f"{own}/count", 6) == [True, 4, [0, 1, 1, 2, 3, 5]]
        client = asker.action_client(f"{own}/count", FIBONACCI)
        assert client.wait_for_server(HANG)
        goal = client.send({"order": 5})
        assert [*goal.result(timeout=HANG).sequence] == [0, 1, 1, 2, 3]
        goal = client.send([100_000])
        goal.cancel()
        goal.result(timeout=HANG)
        assert goal.status.name == "CANCELED"
