"""Joints and a clock that the test moves."""

import threading

import pytest
from support.wait import HANG

import yarpy.clock
from yarpy.kits.sim.axis import Axis
from yarpy.kits.sim.body import MEMORY, STEP, Body
from yarpy.kits.sim.icub import ICUB_HEAD
from yarpy.kits.sim.joint import Joint


class Clock:
    def __init__(self) -> None:
        self.now = 1000.0

    def __call__(self) -> float:
        return self.now


class Hand(yarpy.clock.SystemClock):
    time = 1000.0

    def now(self) -> float:
        return self.time


def positions(body: Body[Joint]) -> list[float]:
    with body.present() as joints:
        return [joint.position for joint in joints]


def test_its_clock_is_that_of_the_program(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(yarpy.clock, "_current", hand := Hand())
    body = Body([Joint(axis) for axis in ICUB_HEAD])
    assert body.time == 1000.0
    hand.time = 1001.0
    with body.present():
        assert body.time == 1001.0


def test_time_passes_when_somebody_looks():
    clock = Clock()
    body = Body([Joint(axis) for axis in ICUB_HEAD], clock)
    with body.present() as joints:
        joints[1].reference.move_to(45.0)
    assert positions(body) == [0.0] * 6
    clock.now += 0.4
    assert 15 < positions(body)[1] < 30
    assert body.time == clock.now
    clock.now += 2.0
    assert positions(body) == [0.0, 45.0, 0.0, 0.0, 0.0, 0.0]


def test_how_often_one_looks_makes_no_difference():
    found = []
    for count in (10, 1000):
        clock = Clock()
        body = Body([Joint(axis) for axis in ICUB_HEAD], clock)
        with body.present() as joints:
            joints[2].reference.move_to(-50.0)
        for _ in range(count):
            clock.now += 0.5 / count
            positions(body)
        found.append(positions(body)[2])
    assert found[0] == pytest.approx(found[1])


class Counting(Joint):
    """A joint that remembers how time passed."""

    def __init__(self, axis: Axis) -> None:
        super().__init__(axis)
        self.steps: list[float] = []

    def step(self, dt: float) -> None:
        self.steps.append(dt)


def test_steps_are_small():
    clock = Clock()
    joint = Counting(Axis("x", -10, 10))
    body = Body([joint], clock)
    clock.now += 0.0123
    positions(body)
    assert len(joint.steps) == 3
    assert sum(joint.steps) == pytest.approx(0.0123)
    joint.steps.clear()
    clock.now += 3600.0
    positions(body)
    assert sum(joint.steps) == pytest.approx(MEMORY)
    assert max(joint.steps) <= STEP


def test_clock_that_is_set_back():
    clock = Clock()
    body = Body([Joint(Axis("x", -10, 10))], clock)
    with body.present() as joints:
        joints[0].reference.move_to(5.0)
    clock.now -= 100.0
    assert positions(body) == [0.0]
    clock.now += 2.0
    assert positions(body) == [5.0]


def test_one_thread_at_a_time():
    body = Body([Joint(Axis("x", -10, 10))])
    inside, found = threading.Event(), []

    def look() -> None:
        inside.wait(HANG)
        found.append(positions(body)[0])

    thread = threading.Thread(target=look)
    thread.start()
    with body.present() as joints:
        inside.set()
        thread.join(0.05)
        assert not found
        joints[0].place(7.0)
    thread.join(HANG)
    assert found == [7.0]
