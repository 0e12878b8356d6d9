"""Poses, against matrices of four by four."""

import math
import random

import numpy as np
import pytest

from yarpy.peers.ros.transform.pose import Pose, between, product, unit


def matrix(pose: Pose) -> np.ndarray:
    x, y, z, w = pose.turned
    found = np.eye(4)
    found[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    found[:3, 3] = pose.at
    return found


def poses(count: int) -> list[Pose]:
    number = random.Random(7).gauss
    return [
        Pose(
            (number(0, 3), number(0, 3), number(0, 3)),
            unit((number(0, 1), number(0, 1), number(0, 1), number(0, 1))),
        )
        for _ in range(count)
    ]


def test_as_matrices_do() -> None:
    for a, b in zip(poses(20), reversed(poses(20)), strict=True):
        assert np.allclose(matrix(a @ b), matrix(a) @ matrix(b))
        assert np.allclose(matrix(a.inverse()), np.linalg.inv(matrix(a)))
        assert np.allclose([*a.apply(b.at), 1.0], matrix(a) @ [*b.at, 1.0])


def test_between() -> None:
    first, second = Pose(), Pose((2.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0))  # half a turn
    half = between(first, second, 0.5)
    assert half.at == (1.0, 0.0, 0.0)
    assert np.allclose(half.turned, (0, 0, math.sqrt(0.5), math.sqrt(0.5)))
    same = Pose(turned=(-0.0, -0.0, -0.0, -1.0))  # the same rotation
    assert np.allclose(np.abs(between(first, same, 0.3).turned), (0, 0, 0, 1))
    for a, b in zip(poses(5), reversed(poses(5)), strict=True):
        assert np.allclose(matrix(between(a, b, 0.0)), matrix(a))
        assert np.allclose(matrix(between(a, b, 1.0)), matrix(b))


def test_rotations() -> None:
    assert np.allclose(unit((0, 0, 0, 2)), (0, 0, 0, 1))
    assert product((0, 0, 0, 1), (1, 0, 0, 0)) == (1, 0, 0, 0)
    for wrong in ((0.0, 0.0, 0.0, 0.0), (math.nan, 0.0, 0.0, 1.0)):
        with pytest.raises(ValueError, match="no rotation"):
            unit(wrong)
