"""The head of the simulated robot: where its eyes and its inertial unit are, given its joints.

World: x forward, y to the left, z up, metres; the robot stands at the origin. An eye's own frame,
as for every camera: x right, y down, z where it looks.

Positive angles: neck_pitch and eyes_tilt look up, neck_roll tilts to the right shoulder, neck_yaw
and eyes_version look to the left, eyes_vergence turns the eyes towards each other. Sizes are about
those of an iCub. Source: rigid-body kinematics, nothing else.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import asin, atan2, cos, degrees, radians, sin
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array: TypeAlias = NDArray[np.float64]

Side = Literal["left", "right"]

NECK: Final = (0.0, 0.0, 0.92)  # where the axis of neck_pitch is
ROLL: Final = (0.0, 0.0, 0.03)  # from there to neck_roll, and on to neck_yaw
YAW: Final = (0.0, 0.0, 0.02)
EYES: Final = (0.055, 0.0, 0.09)  # from neck_yaw to the point between the eyes
BASELINE: Final = 0.068  # between the eyes
IMU: Final = (-0.01, 0.0, 0.12)  # from neck_yaw to the inertial unit
GRAVITY: Final = 9.81  # m/s^2

_H = 1e-4  # seconds, for the change of a speed


@dataclass(frozen=True, slots=True)
class Pose:
    """`rotation` (3, 3) turns vectors of a frame into those of the world; `position` (3,)."""

    rotation: Array
    position: Array


@dataclass(frozen=True, slots=True)
class Inertia:
    """What an inertial unit feels: deg/s and m/s^2 in its own frame; roll, pitch, yaw in degrees
    of its frame in the world."""

    gyroscope: tuple[float, float, float]
    accelerometer: tuple[float, float, float]
    orientation: tuple[float, float, float]


def eye_pose(angles: Sequence[float], side: Side) -> Pose:
    """Where an eye is, with the six joints at `angles` (degrees); its frame is a camera's."""
    import numpy as np

    head = _chain(angles)[-1]
    lateral = BASELINE / 2 if side == "left" else -BASELINE / 2
    position = head.position + head.rotation @ (EYES[0], EYES[1] + lateral, EYES[2])
    tilt, version, vergence = angles[3:6]
    pan = version - vergence / 2 if side == "left" else version + vergence / 2
    looking = head.rotation @ _about_y(-tilt) @ _about_z(pan)
    camera = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    return Pose(looking @ camera, position)


def imu_pose(angles: Sequence[float]) -> Pose:
    """Where the inertial unit is: x forward, y left, z up when the head is upright."""
    head = _chain(angles)[-1]
    return Pose(head.rotation, head.position + head.rotation @ IMU)


def inertia(
    angles: Sequence[float], speeds: Sequence[float], accelerations: Sequence[float]
) -> Inertia:
    """What the inertial unit feels: joints in degrees, deg/s, deg/s^2. Resting it feels gravity."""
    import numpy as np

    pose = imu_pose(angles)
    turning, moving = _imu_velocity(angles, speeds)
    later = [q + v * _H for q, v in zip(angles, speeds, strict=True)]
    faster = [v + a * _H for v, a in zip(speeds, accelerations, strict=True)]
    _, moving_later = _imu_velocity(later, faster)
    felt = (moving_later - moving) / _H + (0.0, 0.0, GRAVITY)
    return Inertia(
        _triple(np.degrees(pose.rotation.T @ turning)),
        _triple(pose.rotation.T @ felt),
        orientation(pose.rotation),
    )


def orientation(rotation: Array) -> tuple[float, float, float]:
    """Roll, pitch and yaw of a rotation, degrees: first around x, then y, then z of the world."""
    return (
        degrees(atan2(rotation[2, 1], rotation[2, 2])),
        degrees(asin(max(-1.0, min(1.0, -rotation[2, 0])))),
        degrees(atan2(rotation[1, 0], rotation[0, 0])),
    )


def _chain(angles: Sequence[float]) -> tuple[Pose, Pose, Pose]:
    """The frames behind neck_pitch, neck_roll and neck_yaw."""
    import numpy as np

    pitch, roll, yaw = angles[:3]
    first = Pose(_about_y(-pitch), np.array(NECK))
    second = Pose(first.rotation @ _about_x(roll), first.position + first.rotation @ ROLL)
    third = Pose(second.rotation @ _about_z(yaw), second.position + second.rotation @ YAW)
    return first, second, third


def _imu_velocity(angles: Sequence[float], speeds: Sequence[float]) -> tuple[Array, Array]:
    """How fast the inertial unit turns (rad/s) and moves (m/s), in the world."""
    import numpy as np

    first, second, third = _chain(angles)
    position = third.position + third.rotation @ IMU
    axes = (np.array((0.0, -1.0, 0.0)), first.rotation[:, 0], second.rotation[:, 2])
    turning, moving = np.zeros(3), np.zeros(3)
    for axis, frame, speed in zip(axes, (first, second, third), speeds, strict=False):
        part = axis * radians(speed)
        turning += part
        moving += _cross(part, position - frame.position)
    return turning, moving


def _cross(a: Array, b: Array) -> Array:
    """The vector product; numpy's own takes ten times as long for two vectors."""
    import numpy as np

    (x, y, z), (u, v, w) = a.tolist(), b.tolist()
    return np.array((y * w - z * v, z * u - x * w, x * v - y * u))


def _about_x(angle: float) -> Array:
    import numpy as np

    c, s = cos(radians(angle)), sin(radians(angle))
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def _about_y(angle: float) -> Array:
    import numpy as np

    c, s = cos(radians(angle)), sin(radians(angle))
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def _about_z(angle: float) -> Array:
    import numpy as np

    c, s = cos(radians(angle)), sin(radians(angle))
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _triple(values: Array) -> tuple[float, float, float]:
    x, y, z = values.tolist()
    return x, y, z
