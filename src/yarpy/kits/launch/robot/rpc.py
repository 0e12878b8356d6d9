"""The answers of a running robot, on `PREFIX/yarprobotinterface`: the words of C++ YARP, and two
more."""

from __future__ import annotations

from collections.abc import Callable

from yarpy.kits.launch.robot.robot import Robot
from yarpy.kits.thrift import Service, i32, method


class Answers(Service):
    """Answers for a robot; `over` is called by whoever asks it to end."""

    def __init__(self, robot: Robot, over: Callable[[], object]) -> None:
        self._robot = robot
        self._over = over

    @method
    def get_phase(self) -> str:
        """Return the phase: startup, run, interrupt1, interrupt2, interrupt3 or shutdown."""
        return self._robot.phase

    @method
    def get_level(self) -> i32:
        """Return the level of the phase, from 0 on."""
        return self._robot.level

    @method
    def get_robot(self) -> str:
        """Return the name of the robot."""
        return self._robot.description.name

    @method
    def is_ready(self) -> bool:
        """Return whether the robot has started and runs."""
        return self._robot.ready

    @method
    def quit(self) -> str:
        """End the robot."""
        self._over()
        return "bye"

    bye = exit = quit

    @method
    def get_devices(self) -> list[str]:
        """(yarpy) Return a line for each device: its name, its state, the reason of that."""
        return [
            f"{name} {slot.state} {slot.detail}".rstrip()
            for name, slot in self._robot.slots.items()
        ]

    @method
    def retry(self, device: str) -> bool:
        """(yarpy) Open a device that has failed, and do what could not be done without it."""
        return self._robot.retry(device)


def port_name(portprefix: str) -> str:
    """Return the name of the port of a robot.

    >>> port_name("icub")
    '/icub/yarprobotinterface'
    """
    return f"/{portprefix.strip('/')}/yarprobotinterface"
