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


def test_a_shoulder_that_carries_an_arm(rover, clock):
    model = load(rover, clock)
    sensors = Sensors(model)
    assert sensors.count == 1 and [*sensors.force_torques()] == ["shoulder_ft"]
    run(model, clock, 2.0)
    force, torque = (
        sensors.force_torques()["shoulder_ft"][:3],
        sensors.force_torques()["shoulder_ft"][3:],
    )
    # A kilogram hangs there, and its middle is 15 cm ahead.
    assert sum(part**2 for part in force) ** 0.5 == pytest.approx(9.81, rel=0.05)
    assert abs(torque[1]) == pytest.approx(9.81 * 0.15, rel=0.1)
    assert torque[0] == pytest.approx(0.0, abs=0.05)
