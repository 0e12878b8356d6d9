"""The services for a node's parameters, as an implementation of others asks them."""

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
from yarpy.peers.ros2.message.library import hash_of
from yarpy.peers.ros2.parameter.server import SERVICES, event
from yarpy.peers.ros2.parameter.store import Change, Descriptor

__all__ = ["names", "router"]


@pytest.fixture
def node(names: yarpy.LocalNames) -> Iterator[ros2.Node]:
    with ros2.Node("/robot/arm", parameters={"gain": 2.5, "joint.name": "elbow"}) as found:
        yield found


@pytest.mark.parametrize(
    ("service", "request_", "response", "asked", "answer"),
    [
        (
            "list_parameters",
            "string[] prefixes;uint64 depth",
            "string[] names;string[] prefixes",
            {"prefixes": [], "depth": 0},
            {"names": ["gain", "joint.name", "use_sim_time"], "prefixes": ["joint"]},
        ),
        (
            "get_parameter_types",
            "string[] names",
            "uint8[] types",
            {"names": ["gain", "joint.name", "nobody"]},
            {"types": [3, 4, 0]},
        ),
    ],
)
def test_zenoh_ros2_sdk_asks(
    node: ros2.Node,
    router: int,
    tmp_path: Path,
    service: str,
    request_: str,
    response: str,
    asked: object,
    answer: object,
) -> None:
    type_ = SERVICES[service]
    hash_ = hash_of(ros2.load(type_))
    words = (f"type={type_}", f"hash={hash_}", f"request={request_}", f"response={response}")
    command = peer_command(router, "ask", f"{node.name}/{service}", *words)
    with Process(command, env=peer_environment(tmp_path)) as peer:
        wait_until(lambda: "ready" in peer.stdout, 2 * HANG)
        peer.write(json.dumps(asked) + "\n")
        wait_until(lambda: len(peer.stdout.splitlines()) > 1)
        assert json.loads(peer.stdout.splitlines()[1]) == answer


def test_descriptors(node: ros2.Node) -> None:
    node.parameters.declare("steps", 4, Descriptor("how many", low=0, high=8, step=2))
    with ros2.Node("/asker") as asker:
        (found,) = asker.parameters_of("/robot/arm").describe("steps")
    assert (found.type, found.description) == (2, "how many")
    (limits,) = found.integer_range
    assert (limits.from_value, limits.to_value, limits.step) == (0, 8, 2)


def test_events() -> None:
    found = event("/n", Change(changed={"a": True}))
    assert found["node"] == "/n"
    assert found["changed_parameters"] == [{"name": "a", "value": {"type": 1, "bool_value": True}}]
    assert ros2.load("rcl_interfaces/msg/ParameterEvent").from_bottle(found).stamp.sec > 0
