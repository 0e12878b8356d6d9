"""The pytest plug-in: a network and a robot for the tests of your project.

    def test_mine(network):
        with yarpy.Port("/a"), yarpy.Port("/b"):      # nobody else sees them
            ...

    def test_head(robot):
        head = yarpy.devices.ControlBoard("/icubSim/head")

Rules: nothing is loaded before a test asks for it. Each test has a network of its own, which the
programs that it starts use, too, since it is in their environment.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from yarpy.kits.sim.robot import Robot
    from yarpy.nameserver.server import NameServer


@pytest.fixture
def network(monkeypatch: pytest.MonkeyPatch) -> Iterator[NameServer]:
    """A name server of this test alone, on the loopback; ports, and programs that the test starts,
    use it without being told."""
    from yarpy.testing.names import private_server

    monkeypatch.setenv("YARPY_BIND", "local")
    with private_server() as server:
        for name, value in server.environment.items():
            monkeypatch.setenv(name, value)
        yield server


@pytest.fixture
def robot(network: NameServer) -> Iterator[Robot]:
    """The simulated robot `/icubSim`, a head with two cameras (160 x 120) and an inertial unit, in
    the network of this test."""
    from yarpy.kits.sim.robot import NAME, Robot, icub_head

    with Robot(NAME, icub_head((160, 120)), names=network.client) as found:
        yield found
