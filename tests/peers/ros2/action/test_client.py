"""Goals that are sent to an implementation of others, and to nobody."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from peers.ros2.conftest import names, router
from support.process import Process
from support.ros2_peer import peer_command, peer_environment
from support.wait import HANG, wait_until

import yarpy
from yarpy.peers import ros2
from yarpy.peers.ros2.action.status import Status

__all__ = ["names", "router"]
FIBONACCI = "example_interfaces/action/Fibonacci"


@pytest.fixture
def node(names: yarpy.LocalNames) -> Iterator[ros2.Node]:
    with ros2.Node("/asker") as found:
        yield found


def test_a_server_of_zenoh_ros2_sdk(node: ros2.Node, router: int, tmp_path: Path) -> None:
    command = peer_command(router, "act", "/fib")
    with Process(command, env=peer_environment(tmp_path)) as peer:
        wait_until(lambda: "ready" in peer.stdout, 2 * HANG)
        client = node.action_client("/fib", FIBONACCI)
        assert client.wait_for_server(HANG)
        goal = client.send({"order": 3})
        assert [*goal.result(HANG).sequence] == [0, 1, 1]
        assert goal.status == Status.SUCCEEDED
        with pytest.raises(yarpy.errors.LocalProtocolError, match="does not accept"):
            client.send([0])
        said = [json.loads(line) for line in peer.stdout.splitlines()]
        assert ["send_goal", [*goal.id], 3] in said
        with pytest.raises(yarpy.errors.UnknownName):
            goal.cancel(HANG)  # it has no such service


def test_nobody_takes_goals(node: ros2.Node) -> None:
    client = node.action_client("/nobody", FIBONACCI)
    assert not client.wait_for_server(0.01)
    with pytest.raises(yarpy.errors.UnknownName, match="nobody serves /nobody/_action/send_goal"):
        client.send([1])
    assert not client._goals


def test_a_goal_of_another_type(node: ros2.Node) -> None:
    client = node.action_client("/nobody", FIBONACCI)
    with pytest.raises((TypeError, ValueError)):
        client.send(["many"])
    with pytest.raises(yarpy.errors.UnknownType):
        node.action_client("/nobody", "p/action/T")
