"""The interface of a sensor whose values are numbers on channels: a force sensor, a skin.

    class ForceSensor:
        def channels(self):                           # needed
            return [0.0, 0.0, -9.81, 0.0, 0.0, 0.0]

    AnalogSensorServer("/robot/left_arm/analog:o", ForceSensor())

Rules: as for control boards (`devices.control_board.interface`): your class inherits nothing and
defines only what it has. Robots of today serve the same by kind, see `devices.multi_sensor`.

Source: IAnalogSensor of YARP 2.3 and 3.x, behind analogServer.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Protocol

#: What a channel, or the sensor, can be; the index here is the number in the protocol.
STATES: Final = ("ok", "error", "overflow", "timeout")


class AnalogSensorLike(Protocol):
    """Everything that such a sensor can have. For reading; classes need not inherit it."""

    def channels(self) -> Sequence[float]:
        """A number for each channel, in the sensor's own units."""

    def states(self) -> Sequence[str]:
        """One of `STATES` for each channel."""

    def calibrate(self, values: Sequence[float] | None) -> None:
        """Let the present values count as zero, or as these."""

    def calibrate_channel(self, channel: int, value: float | None) -> None:
        """Let the present value of a channel count as zero, or as this."""


class VirtualSensorLike(Protocol):
    """A device that is told measurements that somebody else has estimated, such as a robot's motor
    boards: they act on them as if they had measured them."""

    def update_measures(self, values: Sequence[float]) -> None:
        """Take these for measured, a number for each channel; torques in Nm."""
