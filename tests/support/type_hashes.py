"""Type hashes of ROS 2 that its own generator made, and whose names a module of definitions has."""

from collections.abc import Mapping
from pathlib import Path
from typing import Protocol

from yarpy.peers.ros2.message.library import Library, hash_of
from yarpy.peers.ros2.message.source import Rosbags, Shipped, Standard

_FILE = Path(__file__).parents[1] / "peers/ros2/message/hashes.txt"
#: what of an action has a hash of its own: the rest is in these
_PARTS = ("SendGoal", "GetResult", "FeedbackMessage")
JAZZY = Library([Rosbags("jazzy"), Standard(), Shipped()])


class Definitions(Protocol):
    MESSAGES: Mapping[str, str]
    SERVICES: Mapping[str, str]
    ACTIONS: Mapping[str, str]


def hashes_of(*packages: str) -> dict[str, str]:
    """The hashes of all that was published of packages, by name in full."""
    lines = _FILE.read_text("utf-8").splitlines()[1:]
    found = dict(line.split() for line in lines)
    return {name: hash_ for name, hash_ in found.items() if name.partition("/")[0] in packages}


def names_of(module: Definitions) -> set[str]:
    """The names in full of all that a module defines."""
    named = {name.replace("/", "/msg/") for name in module.MESSAGES}
    named |= {name.replace("/", "/srv/") for name in module.SERVICES}
    return named | {
        f"{name.replace('/', '/action/')}_{part}" for name in module.ACTIONS for part in _PARTS
    }


def others(published: Mapping[str, str], library: Library = JAZZY) -> list[str]:
    """Those among the published types that have another hash here."""
    return [
        name
        for name, hash_ in published.items()
        if hash_of(library.load(name)) != f"RIHS01_{hash_}"  # type: ignore[arg-type]
    ]
