"""Poses: where a frame lies in another one, as a translation and a unit quaternion.

Rules: pure. Lengths are in meters, quaternions are (x, y, z, w). A pose maps the coordinates of a
point in the inner frame to those in the outer one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

Vector3 = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]

#: quaternions closer than that are interpolated along the line between them
_NEAR = 1.0 - 1e-6


@dataclass(frozen=True, slots=True)
class Pose:
    """`at` is the origin of the inner frame, `turned` its orientation."""

    at: Vector3 = (0.0, 0.0, 0.0)
    turned: Quaternion = (0.0, 0.0, 0.0, 1.0)

    def __matmul__(self, other: Pose) -> Pose:
        """Return the pose of `other`, which lies in our inner frame, in our outer one."""
        x, y, z = self.apply(other.at)
        return Pose((x, y, z), product(self.turned, other.turned))

    def apply(self, point: Vector3) -> Vector3:
        """Return a point of the inner frame in the outer one.

        >>> left = Pose((1.0, 0.0, 0.0), (0.0, 0.0, 0.5**0.5, 0.5**0.5))  # by 90 degrees
        >>> [round(value, 6) for value in left.apply((2, 0, 0))]
        [1.0, 2.0, 0.0]
        """
        x, y, z, w = self.turned
        px, py, pz = point
        # Twice the cross product of the quaternion's vector with the point.
        tx, ty, tz = 2 * (y * pz - z * py), 2 * (z * px - x * pz), 2 * (x * py - y * px)
        return (
            self.at[0] + px + w * tx + y * tz - z * ty,
            self.at[1] + py + w * ty + z * tx - x * tz,
            self.at[2] + pz + w * tz + x * ty - y * tx,
        )

    def inverse(self) -> Pose:
        """Return the pose of the outer frame in the inner one."""
        x, y, z, w = self.turned
        back = Pose(turned=(-x, -y, -z, w))
        ax, ay, az = back.apply(self.at)
        return Pose((-ax, -ay, -az), back.turned)


def product(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the rotation that does `b` first and then `a`."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def unit(turned: Quaternion) -> Quaternion:
    """Return a quaternion with length 1. Raises ValueError for one that is no rotation."""
    length = math.sqrt(sum(value * value for value in turned))
    if not math.isfinite(length) or length < 1e-3:
        raise ValueError(f"{turned} is no rotation: a quaternion (x, y, z, w) has the length 1")
    x, y, z, w = (value / length for value in turned)
    return x, y, z, w


def between(first: Pose, second: Pose, share: float) -> Pose:
    """Return the pose a `share` (0 to 1) of the way from one to another: along a straight line, at
    a steady turn, the shorter way round."""
    ax, ay, az = first.at
    bx, by, bz = second.at
    at = (ax + (bx - ax) * share, ay + (by - ay) * share, az + (bz - az) * share)
    a, b = first.turned, second.turned
    cosine = sum(p * q for p, q in zip(a, b, strict=True))
    if cosine < 0.0:
        b, cosine = (-b[0], -b[1], -b[2], -b[3]), -cosine
    if cosine > _NEAR:
        left, right = 1.0 - share, share
    else:
        angle = math.acos(cosine)
        left = math.sin((1.0 - share) * angle) / math.sin(angle)
        right = math.sin(share * angle) / math.sin(angle)
    x, y, z, w = (left * p + right * q for p, q in zip(a, b, strict=True))
    return Pose(at, unit((x, y, z, w)))
