"""SimulatedBattery: a battery that is used evenly; fakeBattery in C++.

Rules: it lives by the clock that it is given, and lasts `LASTS` seconds.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from yarpy import clock

#: Seconds from full to empty.
LASTS: Final = 3600.0


class SimulatedBattery:
    """Every member of `battery.interface.BatteryLike`."""

    info = "a simulated battery, 24 V"

    def __init__(self, clock: Callable[[], float] = clock.monotonic) -> None:
        self._clock = clock
        self._begin = clock()

    def charge(self) -> float:
        """Percent."""
        return max(100.0 * (1.0 - (self._clock() - self._begin) / LASTS), 0.0)

    def voltage(self) -> float:
        """V."""
        return 20.0 + 0.04 * self.charge()

    def current(self) -> float:
        """A."""
        return 2.0 if self.charge() else 0.0

    def temperature(self) -> float:
        """Degrees Celsius."""
        return 25.0

    def status(self) -> str:
        """In use, then low, then critical."""
        charge = self.charge()
        return "in use" if charge > 20.0 else "low" if charge > 5.0 else "critical"
