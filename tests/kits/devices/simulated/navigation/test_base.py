"""A base that drives by a clock of the test."""

import math

import pytest

from yarpy.kits.devices.interfaces.place import Path, Place
from yarpy.kits.devices.refusal import Refused
from yarpy.kits.devices.simulated.navigation.base import SimulatedBase


class Clock:
    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def base(clock: Clock) -> SimulatedBase:
    return SimulatedBase("kitchen", clock)


def at(base: SimulatedBase) -> tuple[float, float, float]:
    place = base.position()
    return round(place.x, 6), round(place.y, 6), round(place.theta, 6)


def test_driving(base: SimulatedBase, clock: Clock) -> None:
    base.apply_velocity(1.0, 0.5, 0.0, 2.0)
    clock.now += 1.0
    assert at(base) == (1.0, 0.5, 0.0) and base.odometry().base_vel_x == 1.0
    clock.now += 5.0
    assert at(base) == (2.0, 1.0, 0.0) and base.odometry().base_vel_x == 0.0
    base.apply_velocity(0.0, 0.0, 90.0, 1.0)
    clock.now += 1.0
    assert at(base) == (2.0, 1.0, 90.0)
    base.reset_odometry()
    base.apply_velocity(1.0, 0.0, 0.0, 1.0)
    clock.now += 0.5
    found = base.odometry()
    assert (round(found.odom_x, 6), round(found.odom_y, 6)) == (0.5, 0.0)
    assert at(base) == (2.0, 1.5, 90.0) and base.last_velocity() == (1.0, 0.0, 0.0)


def test_going(base: SimulatedBase, clock: Clock) -> None:
    base.go_named(Place("kitchen", 1.0, 0.0, 60.0), "sink")
    assert base.status() == "movg" and base.target_name() == "sink"
    clock.now += 1.0
    assert at(base) == (0.5, 0.0, 30.0) and base.waypoint() == base.target()
    assert base.waypoints("glob") == Path([Place("kitchen", 1.0, 0.0, 60.0)])
    ahead, left, turn = base.target_from_here()
    assert round(math.hypot(ahead, left), 6) == 0.5 and round(turn, 6) == 30.0
    base.suspend()
    clock.now += 10.0
    assert base.status() == "paus" and at(base) == (0.5, 0.0, 30.0)
    base.resume()
    clock.now += 1.0
    assert base.status() == "rech" and at(base) == (1.0, 0.0, 60.0)


def test_a_path(base: SimulatedBase, clock: Clock) -> None:
    base.follow(Path([Place("kitchen", 1.0), Place("kitchen", 1.0, 1.0)]))
    clock.now += 3.0
    assert at(base) == (1.0, 0.5, 0.0) and len(base.waypoints("glob").waypoints) == 1
    clock.now += 3.0
    assert base.status() == "rech"
    base.locate(Place("garden", 0.0, 0.0, 90.0))
    base.go_by(1.0, 0.0)
    assert round(base.target().y, 6) == 1.0
    base.stop()
    assert base.status() == "idle"
    with pytest.raises(Refused, match="nowhere"):
        base.target()


def test_what_cannot_be(base: SimulatedBase) -> None:
    with pytest.raises(Refused, match="in the map 'kitchen'"):
        base.go(Place("garden"))
    with pytest.raises(Refused, match="without places"):
        base.follow(Path())
    base.stop_localization()
    assert base.localization_status() == "locn"
    with pytest.raises(Refused, match="stopped"):
        base.position()
    base.start_localization()
    assert base.localization_status() == "locy" and len(base.estimates()) == 1
    assert base.position_with_covariance()[1].array.shape == (3, 3)
