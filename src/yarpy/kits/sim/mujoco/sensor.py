"""Inertial and force sensors of a MuJoCo model, for `yarpy.devices.MultiSensorServer`.

Rules: a force and a torque sensor at the same site are one of six axes, with the site's name; N and
Nm, in the axes of the site, as the body with the site pushes and turns what it is fixed to.
"""

from __future__ import annotations

from collections.abc import Callable
from math import degrees
from typing import Any, Final

from yarpy.kits.sim.mujoco.model import Model, mujoco
from yarpy.kits.sim.rotation import Rotation, Vector, roll_pitch_yaw

#: MuJoCo's kind of sensor -> the method of a device that returns it.
KINDS: Final = {
    "gyro": "gyroscopes",
    "accelerometer": "accelerometers",
    "magnetometer": "magnetometers",
    "framequat": "orientations",
    "framepos": "position_sensors",
}

Values = dict[str, Vector]
Wrenches = dict[str, tuple[float, ...]]


class Sensors:
    """All sensors of these kinds that a model has; `count` says how many."""

    def __init__(self, model: Model) -> None:
        self._model = model
        self._places: dict[str, dict[str, int]] = {method: {} for method in KINDS.values()}
        kinds = mujoco().mjtSensor
        methods = {int(getattr(kinds, f"mjSENS_{kind.upper()}")): m for kind, m in KINDS.items()}
        for number in range(model.model.nsensor):
            method = methods.get(int(model.model.sensor_type[number]))
            if method is not None:
                name = model.name_of("sensor", number)
                self._places[method][name] = int(model.model.sensor_adr[number])
        self._wrenches = _wrenches(model)
        self.count = sum(map(len, self._places.values())) + len(self._wrenches)

    def gyroscopes(self) -> Values:
        return self._values("gyroscopes", lambda data: _three([degrees(x) for x in data[:3]]))

    def accelerometers(self) -> Values:
        return self._values("accelerometers", _three)

    def magnetometers(self) -> Values:
        return self._values("magnetometers", _three)

    def orientations(self) -> Values:
        return self._values("orientations", lambda data: roll_pitch_yaw(_rotation(*data[:4])))

    def position_sensors(self) -> Values:
        return self._values("position_sensors", _three)

    def force_torques(self) -> Wrenches:
        with self._model.present():
            data: Any = self._model.data.sensordata
            return {
                name: (*data[force : force + 3].tolist(), *data[torque : torque + 3].tolist())
                for name, (force, torque) in self._wrenches.items()
            }

    def _values(self, method: str, read: Callable[[list[float]], Vector]) -> Values:
        with self._model.present():
            data: Any = self._model.data.sensordata
            return {
                name: read(data[place : place + 4].tolist())
                for name, place in self._places[method].items()
            }


def _wrenches(model: Model) -> dict[str, tuple[int, int]]:
    """Return where force and torque at each site are in the data of the sensors."""
    kinds = mujoco().mjtSensor
    found: dict[int, dict[int, int]] = {int(kinds.mjSENS_FORCE): {}, int(kinds.mjSENS_TORQUE): {}}
    for number in range(model.model.nsensor):
        at = found.get(int(model.model.sensor_type[number]))
        if at is not None:
            at[int(model.model.sensor_objid[number])] = int(model.model.sensor_adr[number])
    forces, torques = found.values()
    return {
        model.name_of("site", site): (forces[site], torques[site])
        for site in forces
        if site in torques
    }


def _three(values: list[float]) -> Vector:
    x, y, z = values[:3]
    return x, y, z


def _rotation(w: float, x: float, y: float, z: float) -> Rotation:
    """A unit quaternion as a rotation."""
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
