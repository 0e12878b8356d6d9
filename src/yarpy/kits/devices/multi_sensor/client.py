"""MultiSensor: remote sensors, C++ or Python, used like local ones.

    with MultiSensor("/icub/imu") as imu:
        print(imu.gyroscopes())               # {"imu": (0.0, 0.1, 0.0)}

Rules: it has every member listed in `devices.multi_sensor.interface`, so it can be served
again.

Source: multipleanalogsensorsclient of YARP 3.x.
"""

from __future__ import annotations

from typing import Any

from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError, RemoteProtocolError
from yarpy.kits.devices.multi_sensor.interface import KINDS, NEWER, OLDER
from yarpy.kits.devices.remote_device import TIMEOUT, RemoteDevice
from yarpy.wire.message import Message

#: For each kind, the values and the time of each sensor.
_Measures = list[list[tuple[tuple[float, ...], float]]]


def read_names(reply: Any) -> list[list[tuple[str, str]]]:
    """The sensors of each kind, each with its frame, from the answer to `getMetadata`.

    Raises TypeError, ValueError.
    """
    lists = reply[0] if isinstance(reply, list) and len(reply) == 1 else reply
    if len(lists) not in (OLDER, NEWER):
        raise ValueError(f"{len(lists)} kinds of sensors, not {OLDER} or {NEWER}")
    return [[(str(name), str(frame)) for name, frame, *_ in sensors] for sensors in lists]


class MultiSensor(RemoteDevice[_Measures]):
    """The sensors whose ports begin with `remote`."""

    RPC = "/rpc:o", "/rpc:i"
    DATA = "/measures:o", "/measures:i"

    def __repr__(self) -> str:
        pairs = zip(KINDS, self._sensors, strict=False)
        listed = ", ".join(f"{len(names)} {kind}" for kind, names in pairs if names)
        return f"<MultiSensor {self.remote}, {listed}>"

    def timestamps(self) -> dict[str, float]:
        """Return the time when each sensor was read, seconds (of the sender's clock)."""
        measures = self._latest.value()
        return {
            name: at
            for names, row in zip(self._sensors, measures, strict=True)
            for name, (_, at) in zip(names, row, strict=True)
        }

    def gyroscopes(self) -> dict[str, tuple[float, ...]]:
        """Angular speeds around x, y, z, deg/s."""
        return self._values("gyroscopes")

    def accelerometers(self) -> dict[str, tuple[float, ...]]:
        """Linear accelerations along x, y, z, m/s^2."""
        return self._values("accelerometers")

    def magnetometers(self) -> dict[str, tuple[float, ...]]:
        """Magnetic field along x, y, z, tesla."""
        return self._values("magnetometers")

    def orientations(self) -> dict[str, tuple[float, ...]]:
        """Roll, pitch and yaw, degrees."""
        return self._values("orientations")

    def thermometers(self) -> dict[str, tuple[float, ...]]:
        """Degrees Celsius."""
        return self._values("thermometers")

    def force_torques(self) -> dict[str, tuple[float, ...]]:
        """Three forces in N and three torques in Nm."""
        return self._values("force_torques")

    def contact_loads(self) -> dict[str, tuple[float, ...]]:
        """Loads, N or Nm."""
        return self._values("contact_loads")

    def encoder_arrays(self) -> dict[str, tuple[float, ...]]:
        """Angles, degrees."""
        return self._values("encoder_arrays")

    def skin_patches(self) -> dict[str, tuple[float, ...]]:
        """A value for each taxel."""
        return self._values("skin_patches")

    def position_sensors(self) -> dict[str, tuple[float, ...]]:
        """Positions x, y, z, m."""
        return self._values("position_sensors")

    def linear_velocities(self) -> dict[str, tuple[float, ...]]:
        """Linear velocities along x, y, z, m/s; of YARP 3.11 and later."""
        return self._values("linear_velocities")

    def angular_accelerations(self) -> dict[str, tuple[float, ...]]:
        """Angular accelerations around x, y, z, deg/s^2; of YARP 3.11 and later."""
        return self._values("angular_accelerations")

    # -- within -------------------------------------------------------------------------------

    def _values(self, kind: str) -> dict[str, tuple[float, ...]]:
        index = [*KINDS].index(kind)
        if index >= len(self._sensors) or not self._sensors[index]:
            return {}
        row = self._latest.value()[index]
        return {name: values for name, (values, _) in zip(self._sensors[index], row, strict=True)}

    def _learn(self) -> None:
        self.frames: dict[str, str] = {}
        self._sensors: list[list[str]] = []
        reply = self._rpc.call(Bottle(["getMetadata"]), timeout=TIMEOUT)
        try:
            for sensors in read_names(reply):
                self._sensors.append([name for name, _ in sensors])
                self.frames.update(sensors)
        except (TypeError, ValueError) as error:
            raise RemoteProtocolError(f'"{self.remote}" names no sensors: {error}') from error

    def _decode(self, message: Message) -> _Measures:
        bottle = message.as_(Bottle)
        try:
            found = [
                [(tuple(map(float, values)), float(at)) for values, at in sensors]
                for sensors in bottle
            ]
        except (TypeError, ValueError) as error:
            raise DecodeError(f'"{self.remote}" sends no measurements: {error}') from error
        if [len(row) for row in found] != [len(names) for names in self._sensors]:
            raise DecodeError(f'"{self.remote}" sends other sensors than it announced')
        return found
