"""The interface of a set of sensors, as an inertial unit: a method for each kind of sensor.

    class Imu:
        def gyroscopes(self):
            return {"imu": (0.0, 0.1, 0.0)}           # sensor name -> values

        def accelerometers(self):
            return {"imu": (0.0, 0.0, 9.81)}

    MultiSensorServer("/robot/imu", Imu(), period=0.01)

Rules: as for control boards (`devices.control_board.interface`): your class inherits nothing
and has at least one of the methods. Each returns a dict with the values of every sensor of its
kind; the names and their order must not change while the server runs. If a method raises, the error
is logged and the last values of that kind are sent again with their old time.

Source: interfaces of YARP 3.x behind multipleanalogsensorsserver.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol, TypeAlias

#: Sensor name -> its values, or a single number.
Readings: TypeAlias = Mapping[str, Sequence[float] | float]

#: The kinds of sensors in the order of the protocol, and how many values one has (0: any number).
#: The last two are in YARP 3.11 and later, where all programs must have them.
KINDS = {
    "gyroscopes": 3,
    "accelerometers": 3,
    "magnetometers": 3,
    "orientations": 3,
    "thermometers": 1,
    "force_torques": 6,
    "contact_loads": 0,
    "encoder_arrays": 0,
    "skin_patches": 0,
    "position_sensors": 3,
    "linear_velocities": 3,
    "angular_accelerations": 3,
}
#: how many kinds programs before 3.11 have, and those since
OLDER, NEWER = 10, 12


class MultiSensorLike(Protocol):
    """Everything a set of sensors can have. For reading; classes need not inherit it."""

    frames: Mapping[str, str]  # sensor name -> name of its frame; default: the sensor's name

    def timestamps(self) -> Mapping[str, float]:
        """Return the times when sensors were last read, in seconds, by name; default: the time of
        the call.

        Called after the methods of all kinds.
        """

    def gyroscopes(self) -> Readings:
        """Angular speeds around x, y, z, deg/s."""

    def accelerometers(self) -> Readings:
        """Linear accelerations along x, y, z, m/s^2; at rest they show gravity."""

    def magnetometers(self) -> Readings:
        """Magnetic field along x, y, z, tesla."""

    def orientations(self) -> Readings:
        """Roll, pitch and yaw, degrees."""

    def thermometers(self) -> Readings:
        """Degrees Celsius."""

    def force_torques(self) -> Readings:
        """Three forces in N and three torques in Nm, along and around x, y, z."""

    def contact_loads(self) -> Readings:
        """Loads, N or Nm."""

    def encoder_arrays(self) -> Readings:
        """Angles, degrees."""

    def skin_patches(self) -> Readings:
        """A value for each taxel."""

    def position_sensors(self) -> Readings:
        """Positions x, y, z, m."""

    def linear_velocities(self) -> Readings:
        """Linear velocities along x, y, z, m/s."""

    def angular_accelerations(self) -> Readings:
        """Angular accelerations around x, y, z, deg/s^2."""
