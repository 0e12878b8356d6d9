"""SimulatedArm: its kinematics and its motion."""

import math

import numpy as np
import pytest

from yarpy.kits.devices.refusal import Refused
from yarpy.kits.devices.simulated.arm import SimulatedArm, _axis_angle, _rotation


def test_rotations_there_and_back():
    for axis_angle in [(0.0, 0.0, 1.0, 2.0), (0.6, 0.0, 0.8, 0.1), (1.0, 0.0, 0.0, math.pi)]:
        m = _rotation(axis_angle)
        assert np.allclose(m @ m.T, np.eye(3))
        assert np.allclose(_rotation(_axis_angle(m)), m)
    assert _axis_angle(np.eye(3))[3] == 0.0


def test_it_reaches_and_keeps_its_limits():
    arm = SimulatedArm()
    found = arm.solve((0.2, 0.1, -0.2))
    assert np.allclose(found.position, (0.2, 0.1, -0.2), atol=1e-4)
    arm.change_limits(3, -10.0, 0.0)
    assert -10.001 <= arm.solve((0.2, 0.1, -0.2)).joints[3] <= 0.001
    with pytest.raises(Refused):
        arm.solve((math.nan, 0.0, 0.0))
    with pytest.raises(Refused):
        arm.solve((0.0, 0.0, 0.0), start=[0.0])


def test_motion_takes_its_time():
    arm = SimulatedArm()
    before = arm.joints()
    arm.go_to((0.1, 0.0, -0.3), seconds=1000.0)
    assert not arm.motion_done() and np.allclose(arm.joints(), before, atol=1.0)
    assert any(arm.joint_velocities()) or arm.progress() == 0.0
    arm.stop()
    assert arm.motion_done() and len(arm.state()) == 7
