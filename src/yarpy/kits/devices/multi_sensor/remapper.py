"""Sensors of several devices as one device of a robot's file: multipleanalogsensorsremapper.

    <device name="all" type="multipleanalogsensorsremapper">
      <param name="ThreeAxisGyroscopesNames">(head_imu chest_imu)</param>
      <param name="TemperatureSensorsNames">(motor_1)</param>
      <action phase="startup" level="5" type="attach">
        <param name="networks">(h c)</param>
        <param name="h">head</param>
        <param name="c">chest</param>
      </action>
    </device>

Rules: it has the sensors that are named, in that order; of kinds that are not named it has none.
Where no kind is named at all, it has all sensors of what is attached.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any, Final

from yarpy.data.bottle import Property
from yarpy.kits.devices.multi_sensor.interface import KINDS, Readings
from yarpy.kits.devices.simulated.plugin import values
from yarpy.names.base import NameClient

#: Parameter -> the kind of sensors.
NAMES: Final = {
    "ThreeAxisGyroscopesNames": "gyroscopes",
    "ThreeAxisLinearAccelerometersNames": "accelerometers",
    "ThreeAxisMagnetometersNames": "magnetometers",
    "OrientationSensorsNames": "orientations",
    "TemperatureSensorsNames": "thermometers",
    "SixAxisForceTorqueSensorsNames": "force_torques",
    "ContactLoadCellArraysNames": "contact_loads",
    "EncoderArraysNames": "encoder_arrays",
    "SkinPatchesNames": "skin_patches",
    "PositionSensorsNames": "position_sensors",
    "LinearVelocitySensorsNames": "linear_velocities",
    "ThreeAxisAngularAccelerometersNames": "angular_accelerations",
}


class RemappedSensors:
    """Sensors of others, see `multi_sensor.interface`: it has the methods of its kinds alone.

    wanted: the names for each kind. Raises ValueError for a sensor that no part has, or two.
    """

    def __init__(self, parts: Sequence[Any], wanted: Mapping[str, Sequence[str]]) -> None:
        self._parts = parts
        self.kinds = [*wanted]
        for kind, names in wanted.items():
            found = _names(parts, kind)
            for name in names:
                if found.count(name) != 1:
                    much = "two devices have" if name in found else "no device has"
                    there = ", ".join(found) or "none"
                    raise ValueError(f'{much} a sensor "{name}" among {kind}; there are {there}')
            setattr(self, kind, partial(self._read, kind, [*names]))

    @property
    def frames(self) -> dict[str, str]:
        """The frames of sensors, by name."""
        return {
            name: frame
            for part in self._parts
            for name, frame in (getattr(part, "frames", None) or {}).items()
        }

    def timestamps(self) -> dict[str, float]:
        """Return the times when sensors were read, for those whose devices say so."""
        found: dict[str, float] = {}
        for part in self._parts:
            if hasattr(part, "timestamps"):
                found.update(part.timestamps())
        return found

    def _read(self, kind: str, names: Sequence[str]) -> Readings:
        found: dict[str, Any] = {}
        for part in self._parts:
            if hasattr(part, kind):
                found.update(getattr(part, kind)())
        return {name: found[name] for name in names}


class Remapper:
    """`multipleanalogsensorsremapper`: `served` are the sensors, once devices are attached."""

    def __init__(self, options: Property, *, names: NameClient | None = None) -> None:
        listed = {kind: [str(one) for one in values(options, key)] for key, kind in NAMES.items()}
        self._wanted = {kind: found for kind, found in listed.items() if found}
        self._sensors: RemappedSensors | None = None

    @property
    def served(self) -> object:
        """The sensors. Raises ValueError before any are attached."""
        if self._sensors is None:
            raise ValueError("it has no sensors yet: attach devices to it at a lower level")
        return self._sensors

    def attach(self, devices: Mapping[str, object]) -> None:
        """Have the sensors of these devices; with `all`, of those among them that have any. Raises
        ValueError for a sensor that none of them has, or two."""
        parts = [one for one in devices.values() if any(hasattr(one, kind) for kind in KINDS)]
        if not parts:
            raise ValueError("it attaches devices with sensors, and none of these has any")
        self._sensors = RemappedSensors(parts, self._wanted or _all(parts))

    def detach(self) -> None:
        """Have no sensors."""
        self._sensors = None


def _names(parts: Sequence[Any], kind: str) -> list[str]:
    return [name for part in parts if hasattr(part, kind) for name in getattr(part, kind)()]


def _all(parts: Sequence[Any]) -> dict[str, list[str]]:
    listed = {kind: _names(parts, kind) for kind in KINDS}
    return {kind: names for kind, names in listed.items() if names}
