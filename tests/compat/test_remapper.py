"""remotecontrolboardremapper: a script with joints of two boards."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest
from support.port import free_block
from support.process import Process
from support.wait import HANG

import yarpy
from yarpy.kits.devices import ControlBoardServer, SimulatedJoints

SCRIPT = Path(__file__).parent / "programs" / "remapper.py"


@pytest.fixture
def server() -> Iterator[yarpy.NameServer]:
    with yarpy.NameServer(free_block(200)) as found:
        yield found


def test_script(environment: Mapping[str, str], server: yarpy.NameServer) -> None:
    torso, head = SimulatedJoints(["yaw", "roll"]), SimulatedJoints(["neck", "eyes"])
    with (
        ControlBoardServer("/robot/torso", torso, 0.005),
        ControlBoardServer("/robot/head", head, 0.005),
    ):
        command = [sys.executable, SCRIPT, "/robot/torso", "/robot/head", "eyes", "yaw"]
        with Process(command, env={**environment, **server.environment}) as process:
            code = process.wait(2 * HANG)
        assert code == 0, process.stdout + process.stderr
        assert process.stdout.splitlines() == [
            "open True",
            "axes 2 eyes",
            "move True",
            "there 5.0",
            "wrong False",
        ]
        assert head.encoders() == [0.0, 5.0] and torso.encoders() == [6.0, 0.0]
