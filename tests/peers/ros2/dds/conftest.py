"""DDS on this computer alone, a name service for ports, and programs of another kind."""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterator

import pytest
from support.dds_program import NodePeer, Peer
from support.peer import brings
from support.rclpy_program import Rclpy

import yarpy
from yarpy.names.default import DEFAULT
from yarpy.peers.ros2.dds.participant import LOCAL

_numbers = itertools.count()


@pytest.fixture(scope="module")
def here() -> Iterator[None]:
    """Nothing leaves this computer. What takes long on a busy one is loaded before it counts."""
    pytest.importorskip("cyclonedds.builtin")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("CYCLONEDDS_URI", LOCAL)
        patch.delenv("ROS_DOMAIN_ID", raising=False)
        names = yarpy.LocalNames()
        DEFAULT.push(names)
        yield
        DEFAULT.pop(names)


@pytest.fixture(scope="module")
def node_peer(here: None) -> Iterator[NodePeer]:
    with NodePeer() as found:
        yield found


@pytest.fixture(scope="module")
def peer(here: None) -> Iterator[Peer]:
    with Peer() as found:
        yield found


@pytest.fixture(scope="module")
@brings("rclpy")
def rclpy(here: None, request: pytest.FixtureRequest) -> Iterator[Rclpy]:
    with Rclpy(f"rclpy_peer_{os.getpid()}") as found:  # others may run these tests meanwhile
        yield found


@pytest.fixture
def topic(own: str) -> str:
    """A topic of its own for each test, of all that run on this computer."""
    return own


@pytest.fixture
def own(here: None) -> str:
    """A name that nothing else on this computer has, of a topic, service or node."""
    return f"/n{os.getpid()}_{next(_numbers)}"
