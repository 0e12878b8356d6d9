"""An eye as a device."""

from functools import cache

import pytest

from yarpy.kits.sim.body import Body
from yarpy.kits.sim.eye import PAIR, Eye, Shutter
from yarpy.kits.sim.icub import ICUB_HEAD
from yarpy.kits.sim.joint import Joint
from yarpy.kits.sim.render.scene import room

scene = cache(room)  # not before a test wants it: workers that run none would paint it, too


class Clock:
    now = 5.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def body(clock: Clock) -> Body:
    return Body([Joint(axis) for axis in ICUB_HEAD], clock)


def test_it_sees_where_the_head_looks(body: Body, clock: Clock):
    eye = Eye(Shutter(body), scene(), "left", 80, 60)
    before = eye.image()
    assert (before.width, before.height, before.code) == (80, 60, "rgb")
    assert eye.timestamp() == 5.0
    with body.present() as joints:
        joints[2].reference.move_to(40.0)
    clock.now = 8.0
    after = eye.image()
    assert eye.timestamp() == 8.0
    assert (before.array != after.array).any(-1).mean() > 0.5


def test_both_eyes_see_the_same_moment(body: Body, clock: Clock):
    shutter = Shutter(body)
    left, right = (Eye(shutter, scene(), side, 80, 60) for side in ("left", "right"))
    with body.present() as joints:
        joints[2].reference.move_to(40.0)
    for number in range(1, 10):
        clock.now = 5.0 + number / 30
        one = left.image()
        clock.now += 0.8 * PAIR
        assert one != right.image()
        assert left.timestamp() == right.timestamp() == 5.0 + number / 30
    clock.now += 0.1
    right.image()
    assert right.timestamp() == clock.now


def test_each_eye_sees_a_moment_once(body: Body, clock: Clock):
    left = Eye(Shutter(body), scene(), "left", 80, 60)
    for _ in range(3):
        clock.now += 0.001
        left.image()
        assert left.timestamp() == clock.now


def test_facts(body: Body):
    eye = Eye(Shutter(body), scene(), "right")
    assert eye.resolution == (320, 240)
    assert eye.field_of_view == pytest.approx((64.0, 50.2), abs=0.1)
    eye.resolution = (64, 48)
    assert eye.image().array.shape == (48, 64, 3)
    assert eye.field_of_view == pytest.approx((64.0, 50.2), abs=0.1)
    assert eye.intrinsics["focalLengthX"] == pytest.approx(51.2)
    with pytest.raises(ValueError, match="must be 16 to 2048"):
        eye.resolution = (5000, 10)
