"""Both that carry messages do all that a node asks of them, in the same words."""

from __future__ import annotations

import inspect
from typing import Any

import pytest

from yarpy.peers.ros2 import rmw
from yarpy.peers.ros2.dds.rmw import DdsRmw
from yarpy.peers.ros2.zenoh.rmw import ZenohRmw

PARTS = ("Writer", "Reader", "Answerer", "Caller")


def words(kind: Any, name: str) -> list[str]:
    return [*inspect.signature(getattr(kind, name)).parameters]


def members(kind: Any) -> list[str]:
    return [
        name for name in dir(kind) if not name.startswith("_") and callable(getattr(kind, name))
    ]


@pytest.mark.parametrize("part", PARTS)
def test_endpoints(part: str) -> None:
    asked = getattr(rmw, part)
    for made in (getattr(ZenohRmw, f"{part.lower()}s"), getattr(DdsRmw, f"{part.lower()}s")):
        for name in members(asked):
            assert words(made, name) == words(asked, name), (made, name)
