"""Joints that motors move together, as C++ reckons."""

import pytest

from yarpy.errors import LocalProtocolError
from yarpy.kits.devices.simulated.coupling import SimulatedCoupling


def test_what_c_plus_plus_reckons() -> None:
    it = SimulatedCoupling()
    zeros, ones = [0.0, 1.0, 2.0, 3.0], [10.0, 20.0, 30.0, 40.0]
    assert it.axis_positions(zeros) == [0.0, 1.0, 5.0]
    assert it.axis_speeds(zeros, ones) == [10.0, 20.0, 75.0]
    assert it.axis_accelerations(zeros, ones, [1.0, 2.0, 3.0, 4.0]) == [1.0, 2.0, 82.0]
    axes, speeds = [1.0, 2.0, 8.0], [3.0, 4.0, 6.0]
    assert it.joint_positions(axes) == [1.0, 2.0, 4.0, 4.0]
    assert it.joint_speeds(axes, speeds) == [3.0, 4.0, 1.0, 7.0]
    assert it.joint_accelerations(axes, speeds, [5.0, 6.0, 2.0]) == [5.0, 6.0, 0.0, 8.0]
    assert len(it.joint_limits) == len(it.joint_names)


def test_a_wrong_number() -> None:
    it = SimulatedCoupling()
    with pytest.raises(LocalProtocolError, match="there are 4 joints"):
        it.axis_positions([0.0])
    with pytest.raises(LocalProtocolError, match="there are 3 axes"):
        it.joint_speeds([0.0], [0.0, 0.0, 0.0])
    with pytest.raises(LocalProtocolError, match="there are 3 axes"):
        it.joint_positions([0.0])
