"""Inertial: the inertial unit in a head, for `yarpy.devices.MultiSensorServer`."""

from __future__ import annotations

from typing import Final

from yarpy.kits.sim.body import Body
from yarpy.kits.sim.head import Inertia, inertia
from yarpy.kits.sim.joint import Joint
from yarpy.kits.sim.rotation import Vector

NAME: Final = "head_imu"


class Inertial:
    """Gyroscope (deg/s), accelerometer (m/s^2, gravity included) and orientation (degrees)."""

    frames = {NAME: "head"}

    def __init__(self, body: Body[Joint]) -> None:
        self._body = body
        self._felt: Inertia | None = None
        self._state: tuple[tuple[float, ...], ...] = ()  # of the joints at the last measurement
        self._time = body.time

    def timestamps(self) -> dict[str, float]:
        """The time of the last measurement."""
        return {NAME: self._time}

    def gyroscopes(self) -> dict[str, Vector]:
        return {NAME: self._feel().gyroscope}

    def accelerometers(self) -> dict[str, Vector]:
        return {NAME: self._feel().accelerometer}

    def orientations(self) -> dict[str, Vector]:
        return {NAME: self._feel().orientation}

    def _feel(self) -> Inertia:
        with self._body.present() as joints:
            neck = joints[:3]
            state = (
                tuple(joint.position for joint in neck),
                tuple(joint.speed for joint in neck),
                tuple(joint.acceleration for joint in neck),
            )
            self._time = self._body.time
        if self._felt is None or state != self._state:
            self._felt = inertia(*state)
            self._state = state
        return self._felt
