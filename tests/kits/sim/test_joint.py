"""A motor that follows its reference."""

from itertools import pairwise

import pytest

from yarpy.kits.sim.axis import Axis
from yarpy.kits.sim.joint import Joint

AXIS = Axis("neck", -70.0, 60.0)
DT = 0.005


def run(joint: Joint, seconds: float) -> list[float]:
    positions = []
    for _ in range(round(seconds / DT)):
        joint.step(DT)
        positions.append(joint.position)
    return positions


def test_it_arrives():
    joint = Joint(AXIS)
    joint.reference.move_to(45.0)
    way = run(joint, 0.8)
    assert not joint.done
    assert max(abs(b - a) for a, b in pairwise(way)) < 1.0
    run(joint, 0.3)
    assert joint.done
    assert joint.position == pytest.approx(45.0, abs=0.01)
    run(joint, 1.0)
    assert (joint.position, joint.speed, joint.acceleration) == (45.0, 0.0, 0.0)


def test_it_lags_a_little_behind_a_jump():
    joint = Joint(AXIS)
    joint.reference.switch("posd")
    joint.reference.go_to(1.0)
    run(joint, 0.01)
    assert 0.0 < joint.position < 1.0
    run(joint, 0.02)  # the neck swings under iKinGazeCtrl if it takes 60 ms instead
    assert joint.position == pytest.approx(1.0, abs=0.05)
    way = run(joint, 0.5)
    assert max(way) < 1.5, "critically damped"
    assert joint.position == pytest.approx(1.0, abs=1e-3)


def test_the_length_of_steps_changes_nothing():
    one, other = Joint(AXIS), Joint(AXIS)
    for joint, count in ((one, 4), (other, 400)):
        joint.reference.move_to(-50.0)
        for _ in range(count):
            joint.step(0.4 / count)
    assert one.position == pytest.approx(other.position)


def test_speed_and_acceleration_are_those_of_the_position():
    joint = Joint(AXIS)
    joint.reference.move_to(30.0)
    run(joint, 0.2)
    position, speed = joint.position, joint.speed
    joint.step(DT)
    assert (joint.speed + speed) / 2 == pytest.approx((joint.position - position) / DT, rel=0.01)
    assert joint.acceleration == pytest.approx((joint.speed - speed) / DT)


def test_it_stops_at_the_limit():
    joint = Joint(AXIS)
    joint.reference.switch("vel")
    joint.reference.move_at(300.0)
    assert max(run(joint, 2.0)) == 60.0
    assert joint.speed == 0.0


def test_limits_that_are_moved_under_it_draw_it_in():
    joint = Joint(AXIS, 50.0)
    joint.reference.limits = (-10.0, 10.0)
    joint.reference.move_to(0.0)
    run(joint, 3.0)
    assert joint.position == 0.0


def test_idle_it_swings_out_and_stays():
    joint = Joint(AXIS)
    joint.reference.switch("vel")
    joint.reference.move_at(50.0)
    run(joint, 0.5)
    joint.reference.switch("idl")
    run(joint, 3.0)
    assert joint.speed == 0.0
    where = joint.position
    assert 25 < where < 40
    joint.reference.switch("pos")
    run(joint, 1.0)
    assert joint.position == pytest.approx(where)


def test_place():
    joint = Joint(AXIS)
    joint.reference.move_to(40.0)
    run(joint, 0.3)
    joint.place(-5.0)
    assert run(joint, 0.2) == [-5.0] * 40
    assert joint.done


def test_it_begins_within_its_range():
    assert Joint(Axis("x", 10.0, 20.0)).position == 10.0
