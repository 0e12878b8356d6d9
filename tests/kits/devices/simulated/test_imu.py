"""An inertial unit that turns."""

from math import hypot

import pytest

from yarpy.kits.devices.simulated.imu import SimulatedImu


def test_it_turns_by_its_clock() -> None:
    now = [50.0]
    imu = SimulatedImu("head", "head_frame", clock=lambda: now[0])
    assert imu.frames == {"head": "head_frame"}
    assert imu.gyroscopes() == {"head": (0.0, 100.0, 0.0)}
    assert imu.accelerometers() == {"head": (0.0, 0.0, 9.81)}
    now[0] += 0.9
    assert imu.orientations()["head"] == pytest.approx((0.0, 90.0, 0.0))
    assert imu.accelerometers()["head"] == pytest.approx((-9.81, 0.0, 0.0))
    assert imu.magnetometers()["head"] == pytest.approx((0.0, 0.0, 48e-6))
    assert imu.timestamps() == {"head": 50.9}
    now[0] += 3.3
    assert imu.orientations()["head"][1] == pytest.approx(60.0)
    assert hypot(*imu.accelerometers()["head"]) == pytest.approx(9.81)


def test_a_constant_one_does_not() -> None:
    now = [0.0]
    imu = SimulatedImu(constant=True, clock=lambda: now[0])
    before = (imu.gyroscopes(), imu.accelerometers(), imu.magnetometers(), imu.orientations())
    now[0] = 10.0
    assert before == (
        imu.gyroscopes(),
        imu.accelerometers(),
        imu.magnetometers(),
        imu.orientations(),
    )
    assert before[0] == {"sensorName": (0.0, 0.0, 0.0)}
