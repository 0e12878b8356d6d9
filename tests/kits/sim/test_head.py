"""Where the eyes look, and what the inertial unit feels."""

import math

import numpy as np
import pytest

from yarpy.kits.sim.head import BASELINE, GRAVITY, IMU, Pose, _beyond, _chain, eye_pose, inertia

REST = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def axes(angles, side="left"):
    """Where an eye looks, what is right of it and what is above it, in the world."""
    rotation = np.array(eye_pose(angles, side).rotation)
    return rotation[:, 2], rotation[:, 0], -rotation[:, 1]


def imu_pose(angles):
    """The pose of the inertial unit, x forward, y left, z up when the head is upright."""
    head = _chain(angles)[-1]
    return Pose(head.rotation, _beyond(head, IMU))


def moved(joint, angle):
    return tuple(angle if number == joint else 0.0 for number in range(6))


def test_at_rest_it_looks_ahead():
    looking, right, up = axes(REST)
    assert looking == pytest.approx([1, 0, 0])
    assert right == pytest.approx([0, -1, 0])
    assert up == pytest.approx([0, 0, 1])
    left_eye, right_eye = (np.array(eye_pose(REST, s).position) for s in ("left", "right"))
    assert left_eye - right_eye == pytest.approx([0, BASELINE, 0])
    assert 1.0 < left_eye[2] < 1.1


@pytest.mark.parametrize("joint", [0, 3])
def test_up(joint):
    looking, right, _ = axes(moved(joint, 30.0))
    assert looking == pytest.approx([math.cos(math.pi / 6), 0, 0.5])
    assert right == pytest.approx([0, -1, 0])


def test_roll_tilts_to_the_right_shoulder():
    looking, right, _ = axes(moved(1, 45.0))
    assert looking == pytest.approx([1, 0, 0])
    assert right == pytest.approx([0, -math.sqrt(0.5), -math.sqrt(0.5)])


@pytest.mark.parametrize("joint", [2, 4])
def test_to_the_left(joint):
    looking, _, up = axes(moved(joint, 30.0))
    assert looking == pytest.approx([math.cos(math.pi / 6), 0.5, 0])
    assert up == pytest.approx([0, 0, 1])


def test_vergence_turns_the_eyes_towards_each_other():
    left, _, _ = axes(moved(5, 20.0), "left")
    right, _, _ = axes(moved(5, 20.0), "right")
    assert left == pytest.approx([math.cos(math.radians(10)), -math.sin(math.radians(10)), 0])
    assert right == pytest.approx(left * [1, -1, 1])


def test_rotations_are_rotations():
    angles = (-20.0, 30.0, 40.0, 10.0, -25.0, 15.0)
    for pose in (eye_pose(angles, "left"), imu_pose(angles)):
        rotation = np.array(pose.rotation)
        assert rotation @ rotation.T == pytest.approx(np.eye(3))
        assert np.linalg.det(rotation) == pytest.approx(1)


def test_resting_it_feels_gravity():
    for joint, angle, expected in (
        (0, 0.0, (0, 0, GRAVITY)),
        (0, 30.0, (GRAVITY / 2, 0, GRAVITY * math.sqrt(0.75))),
        (1, 45.0, (0, GRAVITY * math.sqrt(0.5), GRAVITY * math.sqrt(0.5))),
        (2, 50.0, (0, 0, GRAVITY)),
    ):
        felt = inertia(moved(joint, angle), REST, REST)
        assert felt.accelerometer == pytest.approx(expected, abs=1e-6)
        assert felt.gyroscope == (0, 0, 0)


def test_orientation():
    assert inertia(moved(1, 45.0), REST, REST).orientation == pytest.approx((45, 0, 0))
    assert inertia(moved(0, 30.0), REST, REST).orientation == pytest.approx((0, -30, 0))
    assert inertia(moved(2, -50.0), REST, REST).orientation == pytest.approx((0, 0, -50))


def test_turning_it_feels_the_speed():
    assert inertia(REST, moved(2, 60.0), REST).gyroscope == pytest.approx((0, 0, 60))
    assert inertia(REST, moved(0, 60.0), REST).gyroscope == pytest.approx((0, -60, 0))
    assert inertia(moved(2, 90.0), moved(1, 10.0), REST).gyroscope == pytest.approx((0, -10, 0))


def test_motion_agrees_with_where_the_unit_is():
    """Against differences of positions and rotations along a path."""
    h = 1e-4

    def angles(t):
        return (20 * math.sin(3 * t), 30 * math.sin(2 * t + 1), 40 * math.cos(2.5 * t), 0, 0, 0)

    def derivative(function):
        return lambda t: tuple(
            (a - b) / (2 * h) for a, b in zip(function(t + h), function(t - h), strict=True)
        )

    speeds = derivative(angles)
    accelerations = derivative(speeds)
    t = 0.7
    poses = [imu_pose(angles(t + k * h)) for k in (-1, 0, 1)]
    before, now, after = (np.array(pose.position) for pose in poses)
    turned = [np.array(pose.rotation) for pose in poses]
    felt = inertia(angles(t), speeds(t), accelerations(t))
    acceleration = (after - 2 * now + before) / h**2
    expected = turned[1].T @ (acceleration + np.array((0, 0, GRAVITY)))
    assert felt.accelerometer == pytest.approx(expected, abs=0.01)
    turn = turned[1].T @ (turned[2] - turned[0]) / (2 * h)
    expected_gyro = np.degrees([turn[2, 1], turn[0, 2], turn[1, 0]])
    assert felt.gyroscope == pytest.approx(expected_gyro, abs=0.01)
