"""The level of a node's log, as others see and set it."""

from __future__ import annotations

import logging
from types import SimpleNamespace
from typing import Any

import pytest
from support.wait import HANG

import yarpy
from yarpy.peers import ros2
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.node.logger_level import SERVICES, LoggerLevels
from yarpy.peers.ros2.node.rosout import node_logger


def asked(served: LoggerLevels, service: str, **request: Any) -> Any:
    """What a question is answered by."""
    found: list[Any] = []
    question = SimpleNamespace(request=SimpleNamespace(**request), answer=found.append)
    served.handlers[service](question)  # type: ignore[arg-type]
    (answer,) = found
    return answer


def test_the_level_of_the_node() -> None:
    own = node_logger(Node("/robot", "arm"), "error")
    levels = LoggerLevels(own)
    assert asked(levels, "get_logger_levels", names=["robot.arm", "rcl"]) == {
        "levels": [{"name": "robot.arm", "level": 40}, {"name": "rcl", "level": 0}]
    }
    for level, found in ((10, logging.DEBUG), (50, logging.CRITICAL), (0, logging.INFO)):
        said = SimpleNamespace(name="robot.arm", level=level)
        assert asked(levels, "set_logger_levels", levels=[said]) == {
            "results": [{"successful": True, "reason": ""}]
        }
        assert own.level == found


@pytest.mark.parametrize(
    ("name", "level", "why"),
    [("rcl", 10, "no logger rcl: its own is arm"), ("arm", 15, "15 is no level of a log")],
)
def test_what_cannot_be_set(name: str, level: int, why: str) -> None:
    own = node_logger(Node("/", "arm"))
    said = [SimpleNamespace(name=name, level=level), SimpleNamespace(name="arm", level=10)]
    answer = asked(LoggerLevels(own), "set_logger_levels", levels=said)
    first, second = answer["results"]
    assert not first["successful"] and why in first["reason"]
    assert second["successful"] and own.level == logging.DEBUG


def test_another_node_sets_it(names: yarpy.LocalNames) -> None:
    with (
        ros2.Node("/robot/arm", enable_logger_service=True) as arm,
        ros2.Node("/console") as console,
    ):
        place = {service: f"/robot/arm/{service}" for service in SERVICES}
        said = {"levels": [{"name": "robot.arm", "level": 40}]}
        setting, getting = (SERVICES[f"{verb}_logger_levels"] for verb in ("set", "get"))
        assert console.client(place["set_logger_levels"], setting).wait(HANG)
        found = console.call(place["set_logger_levels"], setting, said, timeout=HANG)
        assert found.results[0].successful
        assert not arm.logger.isEnabledFor(logging.WARNING)
        assert console.client(place["get_logger_levels"], getting).wait(HANG)
        asked_for = {"names": ["robot.arm"]}
        found = console.call(place["get_logger_levels"], getting, asked_for, timeout=HANG)
        assert found.levels[0].level == 40
