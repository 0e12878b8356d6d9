"""Inertial sensors of a MuJoCo model."""

import pytest

from yarpy.kits.sim.mujoco.model import load
from yarpy.kits.sim.mujoco.sensor import Sensors


@pytest.fixture
def model(arm, clock):
    return load(arm, clock)


def run(model, clock, seconds):
    for _ in range(round(seconds / 0.02)):
        clock.now += 0.02
        with model.present():
            pass


def test_what_they_feel(model, clock):
    sensors = Sensors(model)
    assert sensors.count == 4
    run(model, clock, 1.0)
    assert sensors.gyroscopes()["gyro"] == pytest.approx((0, 0, 0), abs=0.5)
    assert sensors.accelerometers()["accelerometer"] == pytest.approx((0, 0, 9.81), abs=0.1)
    assert sensors.orientations()["attitude"] == pytest.approx((0, 0, 0), abs=0.5)
    assert sensors.position_sensors()["place"] == pytest.approx((0, 0, 1.12), abs=0.01)
    assert sensors.magnetometers() == {}


def test_moving(model, clock):
    sensors = Sensors(model)
    with model.present() as joints:
        joints[0].reference.move_to(45.0)
    run(model, clock, 0.4)
    assert sensors.gyroscopes()["gyro"][1] > 20
    run(model, clock, 2.0)
    assert sensors.orientations()["attitude"] == pytest.approx((0, 45, 0), abs=6)
    assert sensors.accelerometers()["accelerometer"] == pytest.approx((-6.94, 0, 6.94), abs=0.8)
