"""Rotations and vectors, against numpy."""

import numpy as np
import pytest

from yarpy.kits.sim import rotation as of

ONE, OTHER = (1.0, -2.0, 0.5), (0.3, 4.0, -1.0)
TURN = of.after(of.after(of.about_z(30), of.about_y(-40)), of.about_x(50))


def test_each_axis_turns_the_next_to_the_one_after_it():
    for turn, vector, expected in (
        (of.about_x, (0, 1, 0), (0, 0, 1)),
        (of.about_y, (0, 0, 1), (1, 0, 0)),
        (of.about_z, (1, 0, 0), (0, 1, 0)),
    ):
        assert of.turned(turn(90), vector) == pytest.approx(expected)


def test_products():
    expected = np.array(of.about_z(30)) @ np.array(of.about_y(-40)) @ np.array(of.about_x(50))
    assert np.array(TURN) == pytest.approx(expected)
    assert of.turned(TURN, ONE) == pytest.approx(expected @ ONE)
    assert of.seen_from(TURN, of.turned(TURN, ONE)) == pytest.approx(ONE)
    assert of.seen_from(TURN, ONE) == pytest.approx(expected.T @ ONE)


def test_vectors():
    assert of.cross(ONE, OTHER) == pytest.approx(np.cross(ONE, OTHER))
    assert of.plus(ONE, OTHER) == pytest.approx((1.3, 2.0, -0.5))
    assert of.times(ONE, -2.0) == (-2.0, 4.0, -1.0)


def test_roll_pitch_yaw():
    assert of.roll_pitch_yaw(TURN) == pytest.approx((50, -40, 30))
    assert of.roll_pitch_yaw(of.about_y(90))[1] == pytest.approx(90)


def test_quaternions():
    """Each component the largest once; the rotation of each is what it was made of."""
    for turn in (TURN, of.about_x(170), of.about_y(170), of.about_z(170), of.about_z(-170)):
        x, y, z, w = of.quaternion(turn)
        assert w >= 0 and x * x + y * y + z * z + w * w == pytest.approx(1.0)
        rows = (
            (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
        )
        assert np.array(rows) == pytest.approx(np.array(turn))
    assert of.quaternion(of.about_x(180)) == pytest.approx((1, 0, 0, 0))


def test_the_inverse():
    assert np.array(of.after(TURN, of.inverse(TURN))) == pytest.approx(np.eye(3), abs=1e-12)
