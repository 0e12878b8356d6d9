"""Devices whose views follow from their interface: a script that navigates, talks and builds."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest
from support.port import free_block
from support.process import Process
from support.wait import HANG

import yarpy

SCRIPT = Path(__file__).parent / "programs" / "navigation.py"


@pytest.fixture
def server() -> Iterator[yarpy.NameServer]:
    with yarpy.NameServer(free_block(200)) as found:
        yield found


def test_script(environment: Mapping[str, str], server: yarpy.NameServer) -> None:
    with Process([sys.executable, SCRIPT], env={**environment, **server.environment}) as process:
        code = process.wait(2 * HANG)
    assert code == 0, process.stdout + process.stderr
    assert process.stdout.splitlines() == [
        "navigation2D_nws_yarp True",
        "localization2D_nws_yarp True",
        "map2D_nws_yarp True",
        "store True",
        "get True map_id:map x:2 y:1 theta:90desc:",
        "list True ['sink'] ['sink']",
        "area True True",
        "area True (3.0, 0.0) False",
        "path True 6.0 3",
        "go True True",
        "target 2.0 1.0 True True",
        "velocity True True",
        "last True 0.1 5.0",
        "here True True",
        "poses 1 True",
        "status True 0.0",
        "none None False",
        "ask True True You said: Hello",
        "lines True 3 True be short",
        "ball True",
        "world ['ball'] 2.0 0.0",
        "battery True",
        "charge True 2 a simulated battery, 24 V",
        "place True base",
        "pose True 1.5 1.0",
        "turn True",
        "turn True",
        "turn True",
        "frames True False",
        "sorted ['base', 'hand'] True",
    ]
