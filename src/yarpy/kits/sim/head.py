"""The head of the simulated robot: where its eyes and its inertial unit are, given its joints.

World: x forward, y to the left, z up, metres; the robot stands at the origin. An eye's own frame,
as for every camera: x right, y down, z in viewing direction.

Positive angles: neck_pitch and eyes_tilt look up, neck_roll tilts to the right shoulder, neck_yaw
and eyes_version look to the left, eyes_vergence turns the eyes towards each other. Sizes are about
those of an iCub. Source: rigid-body kinematics.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import degrees, radians
from typing import Final, Literal

from yarpy.kits.sim import rotation as of
from yarpy.kits.sim.rotation import Rotation, Vector

Side = Literal["left", "right"]

SIDES: Final[tuple[Side, Side]] = ("left", "right")

NECK: Final = (0.0, 0.0, 0.92)  # where the axis of neck_pitch is
ROLL: Final = (0.0, 0.0, 0.03)  # from there to neck_roll, and on to neck_yaw
YAW: Final = (0.0, 0.0, 0.02)
EYES: Final = (0.055, 0.0, 0.09)  # from neck_yaw to the point between the eyes
BASELINE: Final = 0.068  # between the eyes
IMU: Final = (-0.01, 0.0, 0.12)  # from neck_yaw to the inertial unit
GRAVITY: Final = 9.81  # m/s^2

#: the frame of a camera, in one with x forward, y to the left, z up
CAMERA: Final = ((0.0, 0.0, 1.0), (-1.0, 0.0, 0.0), (0.0, -1.0, 0.0))
_H = 1e-4  # seconds, for the change of a speed


@dataclass(frozen=True, slots=True)
class Pose:
    """The pose of a frame: `rotation` converts its vectors to world vectors."""

    rotation: Rotation
    position: Vector


@dataclass(frozen=True, slots=True)
class Inertia:
    """A measurement of an inertial unit: deg/s and m/s^2 in its own frame; roll, pitch, yaw in
    degrees of its frame in the world."""

    gyroscope: Vector
    accelerometer: Vector
    orientation: Vector


def eye_pose(angles: Sequence[float], side: Side) -> Pose:
    """Return the pose of an eye, with the six joints at `angles` (degrees); its frame is a
    camera's."""
    head = _chain(angles)[-1]
    tilt, version, vergence = angles[3:6]
    eyes = Pose(of.after(head.rotation, of.about_y(-tilt)), _beyond(head, EYES))
    looking = of.after(eyes.rotation, of.about_z(eye_turn(version, vergence, side)))
    return Pose(of.after(looking, CAMERA), _beyond(eyes, eye_place(side)))


def eye_turn(version: float, vergence: float, side: Side) -> float:
    """Return by how many degrees an eye looks to the left of where both look with all at 0."""
    return version - vergence / 2 if side == "left" else version + vergence / 2


def eye_place(side: Side) -> Vector:
    """Return where an eye is, from the point between both."""
    return (0.0, BASELINE / 2 if side == "left" else -BASELINE / 2, 0.0)


def inertia(
    angles: Sequence[float], speeds: Sequence[float], accelerations: Sequence[float]
) -> Inertia:
    """Return the measurement of the inertial unit, given the neck joints in degrees, deg/s,
    deg/s^2. At rest it measures gravity."""
    head = _chain(angles)[-1]
    turning, moving = _imu_velocity(angles, speeds)
    later = [q + v * _H for q, v in zip(angles, speeds, strict=True)]
    faster = [v + a * _H for v, a in zip(speeds, accelerations, strict=True)]
    _, moving_later = _imu_velocity(later, faster)
    change = of.times(of.plus(moving_later, of.times(moving, -1.0)), 1 / _H)
    x, y, z = of.seen_from(head.rotation, turning)
    return Inertia(
        (degrees(x), degrees(y), degrees(z)),
        of.seen_from(head.rotation, of.plus(change, (0.0, 0.0, GRAVITY))),
        of.roll_pitch_yaw(head.rotation),
    )


def _chain(angles: Sequence[float]) -> tuple[Pose, Pose, Pose]:
    """The frames after neck_pitch, neck_roll and neck_yaw."""
    first = Pose(of.about_y(-angles[0]), NECK)
    second = Pose(of.after(first.rotation, of.about_x(angles[1])), _beyond(first, ROLL))
    third = Pose(of.after(second.rotation, of.about_z(angles[2])), _beyond(second, YAW))
    return first, second, third


def _beyond(frame: Pose, place: Vector) -> Vector:
    """A point given in a frame, in the world."""
    return of.plus(frame.position, of.turned(frame.rotation, place))


def _imu_velocity(angles: Sequence[float], speeds: Sequence[float]) -> tuple[Vector, Vector]:
    """Return the angular velocity (rad/s) and the velocity (m/s) of the inertial unit, in the
    world."""
    first, second, third = frames = _chain(angles)
    place = _beyond(third, IMU)
    axes = (
        (0.0, -1.0, 0.0),
        of.turned(first.rotation, (1.0, 0.0, 0.0)),
        of.turned(second.rotation, (0.0, 0.0, 1.0)),
    )
    turning = moving = (0.0, 0.0, 0.0)
    for axis, frame, speed in zip(axes, frames, speeds, strict=False):
        part = of.times(axis, radians(speed))
        turning = of.plus(turning, part)
        arm = of.plus(place, of.times(frame.position, -1.0))
        moving = of.plus(moving, of.cross(part, arm))
    return turning, moving
