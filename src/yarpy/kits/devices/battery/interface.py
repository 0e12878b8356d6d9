"""The interface of a battery.

    class Battery:
        info = "24 V, 10 Ah"

        def charge(self):                             # needed, percent
            return 80.0

    BatteryServer("/robot/battery", Battery())

Rules: as for control boards (`devices.control_board.interface`): your class inherits nothing
and defines only what it has; what is missing is sent as 0.

Source: interfaces of YARP 3.x behind battery_nws_yarp.
"""

from __future__ import annotations

from typing import Final, Protocol

#: What a battery is doing; the index here is the number in the protocol.
BATTERY: Final = ("standby", "charging", "in use", "error", "timeout", "low", "critical")


class BatteryLike(Protocol):
    """Everything a battery can have. For reading; classes need not inherit it."""

    info: str  # what it is, for people

    def charge(self) -> float:
        """Percent."""

    def voltage(self) -> float:
        """V."""

    def current(self) -> float:
        """A; positive when it is used, mostly."""

    def temperature(self) -> float:
        """Degrees Celsius."""

    def status(self) -> str:
        """One of `BATTERY`; default: `in use`."""
