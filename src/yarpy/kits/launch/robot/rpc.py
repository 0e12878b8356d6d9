"""The answers of a running robot, on `PREFIX/yarprobotinterface`."""

from __future__ import annotations

import threading

from yarpy.kits.launch.robot.functions import RobotInterface
from yarpy.kits.launch.robot.robot import Robot


class Answers(RobotInterface):
    """Answers for a robot; `over` is set by whoever asks it to end."""

    def __init__(self, robot: Robot, over: threading.Event) -> None:
        self._robot = robot
        self._over = over

    def get_phase(self) -> str:
        """Return the phase."""
        return self._robot.phase

    def get_level(self) -> int:
        """Return the level of the phase."""
        return self._robot.level

    def get_robot(self) -> str:
        """Return the name of the robot."""
        return self._robot.description.name

    def is_ready(self) -> bool:
        """Return whether it runs."""
        return self._robot.ready

    def quit(self) -> str:
        """End the robot."""
        self._over.set()
        return "bye"

    bye = exit = quit

    def get_devices(self) -> list[str]:
        """Return a line for each device."""
        return [
            f"{name} {slot.state} {slot.detail}".rstrip()
            for name, slot in self._robot.slots.items()
        ]

    def retry(self, device: str) -> bool:
        """Open a device that has failed. Raises UnknownName."""
        return self._robot.retry(device)


def port_name(portprefix: str) -> str:
    """Return the name of the port of a robot.

    >>> port_name("icub")
    '/icub/yarprobotinterface'
    """
    return f"/{portprefix.strip('/')}/yarprobotinterface"
