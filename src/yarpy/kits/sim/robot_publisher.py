"""RobotPublisher: shows a simulated robot in the graph of another system, beside its ports of YARP.

Rules: a contract alone. Publishers are found by name (registry kind `robots`), each a class without
parameters.
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from typing import Protocol

from yarpy.kits.sim.robot import Robot


class RobotPublisher(Protocol):
    """One other system."""

    title: str

    def find(self, everywhere: bool) -> str:
        """Return where the system can be reached now, "" if it cannot within a second.
        `everywhere`: on other computers too."""

    def show(self, robot: Robot, where: str = "") -> AbstractContextManager[object]:
        """Show the robot there while the result is open; "" is the usual place. YarpError."""

    def advice(self, robot: str, where: str) -> str:
        """Return what to try, for people, with the name of the robot."""
