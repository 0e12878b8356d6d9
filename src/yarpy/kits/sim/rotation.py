"""Rotations and vectors of three numbers, as tuples: for so few numbers numpy is slower.

A rotation is three rows; it converts vectors of a frame to those of the frame around it.
"""

from __future__ import annotations

from math import asin, atan2, copysign, cos, degrees, radians, sin, sqrt
from typing import TypeAlias

Vector: TypeAlias = tuple[float, float, float]
Rotation: TypeAlias = tuple[Vector, Vector, Vector]
Quaternion: TypeAlias = tuple[float, float, float, float]


def about_x(angle: float) -> Rotation:
    """Around x by degrees: y towards z."""
    c, s = cos(radians(angle)), sin(radians(angle))
    return ((1.0, 0.0, 0.0), (0.0, c, -s), (0.0, s, c))


def about_y(angle: float) -> Rotation:
    """Around y by degrees: z towards x."""
    c, s = cos(radians(angle)), sin(radians(angle))
    return ((c, 0.0, s), (0.0, 1.0, 0.0), (-s, 0.0, c))


def about_z(angle: float) -> Rotation:
    """Around z by degrees: x towards y."""
    c, s = cos(radians(angle)), sin(radians(angle))
    return ((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0))


def after(one: Rotation, other: Rotation) -> Rotation:
    """The rotation `other`, in a frame that `one` has turned: the product of the matrices."""
    (a, b, c), (d, e, f), (g, h, i) = one
    (j, k, m), (n, o, p), (q, r, s) = other
    return (
        (a * j + b * n + c * q, a * k + b * o + c * r, a * m + b * p + c * s),
        (d * j + e * n + f * q, d * k + e * o + f * r, d * m + e * p + f * s),
        (g * j + h * n + i * q, g * k + h * o + i * r, g * m + h * p + i * s),
    )


def inverse(rotation: Rotation) -> Rotation:
    """The inverse: it converts vectors of the frame around to those of the frame."""
    (a, b, c), (d, e, f), (g, h, i) = rotation
    return (a, d, g), (b, e, h), (c, f, i)


def turned(rotation: Rotation, vector: Vector) -> Vector:
    """A vector of the frame, in the frame around it."""
    (a, b, c), (d, e, f), (g, h, i) = rotation
    x, y, z = vector
    return (a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z)


def seen_from(rotation: Rotation, vector: Vector) -> Vector:
    """A vector of the frame around it, in the frame: the inverse of `turned`."""
    (a, b, c), (d, e, f), (g, h, i) = rotation
    x, y, z = vector
    return (a * x + d * y + g * z, b * x + e * y + h * z, c * x + f * y + i * z)


def plus(one: Vector, other: Vector) -> Vector:
    """The sum."""
    return (one[0] + other[0], one[1] + other[1], one[2] + other[2])


def times(vector: Vector, factor: float) -> Vector:
    """The product with a factor."""
    return (vector[0] * factor, vector[1] * factor, vector[2] * factor)


def cross(one: Vector, other: Vector) -> Vector:
    """The vector product."""
    (x, y, z), (u, v, w) = one, other
    return (y * w - z * v, z * u - x * w, x * v - y * u)


def roll_pitch_yaw(rotation: Rotation) -> Vector:
    """The angles in degrees: first around x, then y, then z of the frame around it."""
    return (
        degrees(atan2(rotation[2][1], rotation[2][2])),
        degrees(asin(max(-1.0, min(1.0, -rotation[2][0])))),
        degrees(atan2(rotation[1][0], rotation[0][0])),
    )


def quaternion(rotation: Rotation) -> Quaternion:
    """The unit quaternion x, y, z, w with w not below 0. Source: Shepperd, Quaternion from rotation
    matrix, 1978, with the largest component found first, so that nothing small is divided by."""
    (a, b, c), (d, e, f), (g, h, i) = rotation
    squares = (1 + a - e - i, 1 - a + e - i, 1 - a - e + i, 1 + a + e + i)  # four times
    largest = max(range(4), key=squares.__getitem__)
    twice = sqrt(squares[largest])
    if largest == 3:
        found = (h - f, c - g, d - b, squares[3])
    elif largest == 0:
        found = (squares[0], b + d, c + g, h - f)
    elif largest == 1:
        found = (b + d, squares[1], f + h, c - g)
    else:
        found = (c + g, f + h, squares[2], d - b)
    factor = copysign(1.0, found[3]) / (2 * twice)
    x, y, z, w = found
    return x * factor, y * factor, z * factor, w * factor
