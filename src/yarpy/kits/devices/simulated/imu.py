"""SimulatedImu: an inertial unit without hardware; fakeIMU in C++.

Rules: it turns around its y axis, `SPEED` degrees a second by the clock that it is given, and falls
nowhere. One that is constant does not turn.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, radians, sin
from typing import Final

from yarpy import clock

#: Degrees per second.
SPEED: Final = 100.0
_GRAVITY: Final = 9.81
_NORTH: Final = 48.0  # microtesla, about that of Europe, without its inclination


class SimulatedImu:
    """One sensor each of four kinds, see `multi_sensor.interface`, all called `name`.

    frame: what its frame is called. constant: it does not turn, so that values can be compared.
    """

    def __init__(
        self,
        name: str = "sensorName",
        frame: str = "frameName",
        *,
        constant: bool = False,
        clock: Callable[[], float] = clock.now,
    ) -> None:
        self.frames = {name: frame}
        self._name = name
        self._speed = 0.0 if constant else SPEED
        self._clock = clock
        self._begin = clock()

    def gyroscopes(self) -> dict[str, tuple[float, float, float]]:
        """Degrees per second."""
        return {self._name: (0.0, self._speed, 0.0)}

    def accelerometers(self) -> dict[str, tuple[float, float, float]]:
        """m/s^2: what holds it up against gravity."""
        angle = radians(self._angle())
        return {self._name: (-_GRAVITY * sin(angle), 0.0, _GRAVITY * cos(angle))}

    def magnetometers(self) -> dict[str, tuple[float, float, float]]:
        """Tesla; north is along x while it has not turned."""
        angle = radians(self._angle())
        north = _NORTH * 1e-6
        return {self._name: (north * cos(angle), 0.0, north * sin(angle))}

    def orientations(self) -> dict[str, tuple[float, float, float]]:
        """Roll, pitch and yaw, degrees."""
        return {self._name: (0.0, self._angle(), 0.0)}

    def timestamps(self) -> dict[str, float]:
        """Seconds."""
        return {self._name: self._clock()}

    def _angle(self) -> float:
        return (self._clock() - self._begin) * self._speed % 360.0
