"""SimulatedPositionSensor: what tells where it is and how it is turned, without hardware;
fakePositionSensor in C++.

Rules: it moves along x, y and z, `SPEED` units a second by the clock that it is given, and turns as
fast the other way round.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from yarpy import clock

#: Metres, and degrees, per second: what C++ adds in its usual period of 20 ms.
SPEED: Final = 0.05


class SimulatedPositionSensor:
    """One sensor each of two kinds, see `multi_sensor.interface`, both called `name`.

    frame: what its frame is called.
    """

    def __init__(
        self,
        name: str = "sensorName",
        frame: str = "frameName",
        *,
        clock: Callable[[], float] = clock.now,
    ) -> None:
        self.frames = {name: frame}
        self._name = name
        self._clock = clock
        self._begin = clock()

    def position_sensors(self) -> dict[str, tuple[float, float, float]]:
        """Metres."""
        way = self._way()
        return {self._name: (way, way, way)}

    def orientations(self) -> dict[str, tuple[float, float, float]]:
        """Roll, pitch and yaw, degrees."""
        angle = -self._way()
        return {self._name: (angle, angle, angle)}

    def timestamps(self) -> dict[str, float]:
        """Seconds."""
        return {self._name: self._clock()}

    def _way(self) -> float:
        return (self._clock() - self._begin) * SPEED
