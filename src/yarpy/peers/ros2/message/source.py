"""The sources of the text of a type of ROS 2: installed packages, what rosbags brings, a few that
are always there (`standard`), and the packages used most (`shipped`).

Rules: as in `ros/message/source.py`. Of the distributions that rosbags knows, the one of ROS_DISTRO
is asked first; the others only for a type whose hash a peer has named. Whoever has no hashes is not
asked with `Shipped`: definitions of Jazzy are others than those of Humble, and nobody would notice.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from yarpy.peers.ros.message import source
from yarpy.peers.ros.message.source import Packages
from yarpy.peers.ros2.message import shipped
from yarpy.peers.ros2.message.standard import ACTIONS, MESSAGES, SERVICES

#: with type hashes, the newest first; a computer without ROS takes the one with the longest support
DISTROS: Final = ("lyrical", "kilted", "jazzy", "iron", "humble")
USUAL: Final = "jazzy"


def installed(environment: Mapping[str, str]) -> Packages:
    """The packages of the ROS 2 that an environment was set up for, or that is installed."""
    prefixes = environment.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    folders = [Path(prefix) for prefix in prefixes if prefix]
    if not folders:
        folders = sorted(Path("/opt/ros").glob("*"), reverse=True)
    return Packages((), [folder / "share" for folder in folders])


def distro(environment: Mapping[str, str]) -> str:
    """The distribution of an environment."""
    named = environment.get("ROS_DISTRO", "")
    return named if named in DISTROS else USUAL


class Rosbags(source.Rosbags):
    """The messages of a distribution that the package rosbags knows."""

    def __init__(self, name: str) -> None:
        super().__init__(2, f"ROS2_{name.upper()}")
        self.name = name

    def __str__(self) -> str:
        return self.found_or_missing(f"the types of {self.name.title()} that rosbags brings")


class Standard(source.Standard):
    """The messages that yarpy's own types turn into, and the services that are asked for most."""

    messages = MESSAGES
    services = SERVICES
    actions: Mapping[str, str] = ACTIONS

    def find(self, name: str, kind: str) -> str | None:
        return self.actions.get(name) if kind == "action" else super().find(name, kind)


class Shipped(Standard):
    """The packages that programs of ROS 2 use most, of Jazzy."""

    messages = shipped.MESSAGES
    services = shipped.SERVICES
    actions = shipped.ACTIONS

    def __str__(self) -> str:
        return "the packages of Jazzy that yarpy brings"
