"""Trajectories, speeds and positions, without a clock."""

from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

from yarpy.kits.sim.axis import Axis
from yarpy.kits.sim.reference import Move, Reference

AXIS = Axis("neck", -70.0, 60.0, speed=100.0, acceleration=1000.0, top_speed=300.0)
DT = 0.005


def run(reference: Reference, seconds: float) -> list[tuple[float, float]]:
    """Positions and speeds on the way."""
    found = []
    for _ in range(round(seconds / DT)):
        reference.step(DT)
        found.append((reference.position, reference.speed))
    return found


def test_minimum_jerk():
    """From rest to rest the polynomial is 10 s^3 - 15 s^4 + 6 s^5, with its peak in the middle."""
    move = Move(0.0, 0.0, 0.0, 1.0, 2.0)
    assert move.at(0) == (0, 0, 0)
    assert move.at(1.0) == pytest.approx((0.5, 1.875 / 2, 0))
    assert move.at(0.5)[0] == pytest.approx(10 / 64 - 15 / 256 + 6 / 1024)
    assert move.at(2.0) == move.at(9.0) == (1, 0, 0)


def test_move_takes_the_time_that_its_speed_allows():
    reference = Reference(AXIS)
    reference.move_to(45.0)
    assert not reference.done
    way = run(reference, 0.83)
    assert not reference.done
    way += run(reference, 0.03)
    assert reference.done and reference.still
    assert reference.position == 45.0
    assert max(speed for _, speed in way) == pytest.approx(100.0, abs=0.5)
    assert [p for p, _ in way] == sorted(p for p, _ in way)


def test_reference_acceleration_bounds_short_moves():
    reference = Reference(AXIS)
    reference.move_to(1.0)
    speeds = [0.0, *(speed for _, speed in run(reference, 0.2))]
    steps = [(b - a) / DT for a, b in pairwise(speeds)]
    assert max(steps) <= 1000.0


def test_target_beyond_the_limit_is_the_limit():
    reference = Reference(AXIS)
    reference.move_to(500.0)
    run(reference, 3.0)
    assert reference.target == reference.position == 60.0


def test_limits_can_be_changed():
    reference = Reference(AXIS)
    reference.limits = (-10.0, 10.0)
    reference.move_to(45.0)
    run(reference, 2.0)
    assert reference.position == 10.0


def test_speeds():
    reference = Reference(AXIS)
    reference.switch("vel")
    reference.move_at(20.0)
    way = run(reference, 1.0)
    assert way[1][1] == pytest.approx(10.0)  # reached with the reference acceleration
    assert reference.speed == 20.0
    assert reference.position == pytest.approx(20.0, abs=0.5)
    assert reference.wanted_speed == 20.0
    run(reference, 4.0)
    assert (reference.position, reference.speed) == (60.0, 0.0)
    assert reference.still, "at the limit nothing moves any more"


def test_speed_beyond_what_the_motor_can_do():
    reference = Reference(AXIS)
    reference.switch("vel")
    reference.move_at(-1e9)
    run(reference, 0.31)
    assert reference.speed in (-300.0, 0.0)
    assert reference.wanted_speed == -300.0


def test_direct_positions():
    reference = Reference(AXIS)
    reference.switch("posd")
    reference.go_to(1.0)
    run(reference, DT)
    assert reference.position == 1.0
    reference.go_to(60.0)
    run(reference, 0.1)
    assert reference.position == pytest.approx(1.0 + 0.1 * 300.0)
    reference.go_to(1000.0)
    run(reference, 0.5)
    assert (reference.position, reference.direct_target) == (60.0, 60.0)
    assert reference.still


def test_stop_in_the_middle_of_a_move():
    reference = Reference(AXIS)
    reference.move_to(45.0)
    run(reference, 0.4)
    assert reference.speed > 90
    reference.stop()
    assert reference.done
    run(reference, 1.0)
    assert reference.still
    assert 20 < reference.position < 35


def test_modes():
    reference = Reference(AXIS)
    for act in (lambda: reference.move_at(1.0), lambda: reference.go_to(1.0)):
        with pytest.raises(ValueError, match="neck is in mode pos: switch it to"):
            act()
    reference.switch("vel")
    with pytest.raises(ValueError, match="icmd cmod JOINT pos"):
        reference.move_to(1.0)
    reference.switch("mix")
    reference.move_at(5.0)
    reference.move_to(1.0)
    reference.switch("fidl")
    assert reference.mode == "idl"
    with pytest.raises(ValueError, match="neck has no mode torq; it has pos vel"):
        reference.switch("torq")


def test_switching_brings_it_to_rest():
    reference = Reference(AXIS)
    reference.switch("vel")
    reference.move_at(50.0)
    run(reference, 0.5)
    reference.switch("pos")
    run(reference, 0.5)
    assert reference.still
    reference.switch("pos")  # the same mode again changes nothing
    reference.move_to(10.0)
    reference.switch("pos")
    assert not reference.done


@settings(max_examples=60)
@given(
    some.lists(
        some.tuples(
            some.sampled_from(["move", "speed", "direct", "stop"]),
            some.floats(-200, 200),
            some.integers(1, 120),
        ),
        max_size=8,
    )
)
def test_it_never_jumps_and_never_leaves_the_limits(commands):
    reference = Reference(AXIS)
    for kind, value, steps in commands:
        if kind == "move":
            reference.switch("pos")
            reference.move_to(value)
        elif kind == "speed":
            reference.switch("vel")
            reference.move_at(value)
        elif kind == "direct":
            reference.switch("posd")
            reference.go_to(value)
        else:
            reference.stop()
        for _ in range(steps):
            before = reference.position
            reference.step(DT)
            assert -70 <= reference.position <= 60
            assert abs(reference.position - before) <= 2 * AXIS.top_speed * DT
