"""The parameters of another node."""

from collections.abc import Iterator
from typing import Any

import pytest
from peers.ros2.conftest import names, router
from support.wait import HANG, wait_until

import yarpy
from yarpy.peers import ros2
from yarpy.peers.ros2.parameter.client import RemoteParameters

__all__ = ["names", "router"]


@pytest.fixture
def node(names: yarpy.LocalNames) -> Iterator[ros2.Node]:
    with ros2.Node("/robot/arm", parameters={"gain": 2.5, "on": False, "list": [1, 2]}) as found:
        yield found


@pytest.fixture
def remote(node: ros2.Node) -> Iterator[RemoteParameters]:
    with ros2.Node("/asker") as asker:
        found = asker.parameters_of("/robot/arm", timeout=HANG)
        assert found.wait(HANG)
        yield found


def test_what_it_has(remote: RemoteParameters) -> None:
    values = {"gain": 2.5, "list": [1, 2], "on": False, "use_sim_time": False}
    assert remote.all() == values
    assert remote.get("gain") == 2.5
    assert remote.names("gain", "on") == ["gain", "on"]
    with pytest.raises(yarpy.errors.UnknownName, match='no parameter "x"'):
        remote.get("x")


def test_changes_are_told(node: ros2.Node, remote: RemoteParameters) -> None:
    told: list[Any] = []
    with ros2.Node("/watcher") as watcher:
        watcher.subscriber("/parameter_events", "rcl_interfaces/msg/ParameterEvent", told.append)

        def changed() -> bool:
            remote.set("gain", 3.5)
            return any(item.changed_parameters for item in told)

        wait_until(changed)
    found = next(item for item in told if item.changed_parameters)
    assert found.node == "/robot/arm"
    assert found.changed_parameters[0].value.double_value == 3.5
    assert node.parameters.get("gain") == 3.5


def test_all_or_none(node: ros2.Node, remote: RemoteParameters) -> None:
    with pytest.raises(ValueError, match="not a string"):
        remote.set_all({"on": True, "gain": "x"})
    assert node.parameters.get("on") is False
    remote.set_all({"on": True, "gain": 1.0})
    assert (node.parameters.get("on"), node.parameters.get("gain")) == (True, 1.0)
    with pytest.raises(ValueError, match="no parameter"):
        remote.set("x", 1)


def test_a_node_that_is_not_there(names: yarpy.LocalNames) -> None:
    with ros2.Node("/asker") as asker:
        remote = asker.parameters_of("/nobody")
        assert not remote.wait(0.01)
        with pytest.raises(yarpy.errors.UnknownName, match="nobody serves"):
            remote.all()
