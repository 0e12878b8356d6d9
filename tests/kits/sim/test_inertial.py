"""The inertial unit as a device."""

import pytest

from yarpy.kits.sim.body import Body
from yarpy.kits.sim.head import GRAVITY
from yarpy.kits.sim.icub import ICUB_HEAD
from yarpy.kits.sim.inertial import NAME, Inertial
from yarpy.kits.sim.joint import Joint


class Clock:
    now = 5.0

    def __call__(self) -> float:
        return self.now


def test_it_feels_what_the_neck_does():
    clock = Clock()
    body = Body([Joint(axis) for axis in ICUB_HEAD], clock)
    imu = Inertial(body)
    assert imu.gyroscopes() == {NAME: (0, 0, 0)}
    assert imu.accelerometers()[NAME] == pytest.approx((0, 0, GRAVITY))
    assert imu.orientations()[NAME] == pytest.approx((0, 0, 0))
    with body.present() as joints:
        joints[2].reference.move_to(40.0)
    clock.now += 0.4
    yaw_speed = imu.gyroscopes()[NAME][2]
    with body.present() as joints:
        assert yaw_speed == pytest.approx(joints[2].speed)
    assert yaw_speed > 20
    assert imu.timestamps() == {NAME: clock.now}
    clock.now += 3.0
    assert imu.orientations()[NAME] == pytest.approx((0, 0, 40))
    assert set(imu.frames) == {NAME}


def test_at_rest_nothing_is_worked_out_anew(monkeypatch: pytest.MonkeyPatch):
    clock = Clock()
    imu = Inertial(Body([Joint(axis) for axis in ICUB_HEAD], clock))
    before = imu.accelerometers()
    monkeypatch.setattr("yarpy.kits.sim.inertial.inertia", None)
    clock.now += 0.5
    assert imu.accelerometers() == before
