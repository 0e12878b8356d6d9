"""Whether messages come in time."""

from __future__ import annotations

import math

import pytest

from yarpy.link.timing import Timing, age_of, expected
from yarpy.qos import Qos
from yarpy.wire.message import DATA, Message

NOW = 1.7e9


class Clock:
    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


class World:
    """A timing with a clock that is set by hand."""

    def __init__(self, **wanted: object) -> None:
        self.clock = Clock()
        self.told: list[tuple[float, bool]] = []
        self.timing = Timing(
            Qos(**wanted),  # type: ignore[arg-type]
            lambda late, silent: self.told.append((round(late, 6), silent)),
            lambda: NOW + self.clock.now,
            self.clock,
        )

    def come(self, after: float, age: float | None = None) -> bool:
        self.clock.now += after
        stamp = "" if age is None else f"1 {NOW + self.clock.now - age:.6f}"
        return self.timing.accept(Message(DATA, b"", stamp))


def test_a_stamp_says_how_old_a_message_is() -> None:
    world = World(deadline=0.02)
    assert [world.come(1.0, age) for age in (0.0, 0.019, 0.05, -5.0)] == [True] * 4
    assert world.timing.missed == 1
    assert world.told == [(0.03, False)]
    assert world.timing.as_dict()["worst"] == pytest.approx(0.03, abs=1e-5)


def test_late_messages_may_be_dropped() -> None:
    world = World(deadline=0.02, late="drop")
    assert [world.come(1.0, age) for age in (0.0, 0.03, 0.01)] == [True, False, True]
    assert (world.timing.missed, world.timing.late) == (1, 1)


def test_without_stamps_arrival_decides_and_nothing_is_dropped() -> None:
    world = World(deadline=0.02, rate=50, late="drop")
    assert all(world.come(after) for after in (0.02, 0.039, 0.06, 0.02))
    assert world.told == [(0.02, False)]
    assert world.timing.missing == 0 + 1 + 2 + 0


@pytest.mark.parametrize(("wanted", "gap"), [
    ({"rate": 50}, 0.04), ({"rate": 50, "deadline": 0.01}, 0.03), ({"deadline": 0.5}, 0.5),
])  # fmt: skip
def test_the_longest_pause(wanted: dict[str, float], gap: float) -> None:
    world = World(**wanted)
    assert world.timing.gap == pytest.approx(gap)
    assert world.come(gap * 0.99) and not world.told
    assert world.come(gap * 1.01) and len(world.told) == 1


def test_a_silence_counts_once() -> None:
    world = World(rate=10)
    world.come(0.1)
    world.clock.now += 5
    world.timing.look()
    world.timing.look()
    assert world.told == [(4.8, True)]
    assert world.timing.due == math.inf
    assert world.come(1.0)
    assert world.timing.missed == 1
    assert world.timing.worst == pytest.approx(5.8)
    assert world.come(0.5)
    assert world.timing.missed == 2


def test_a_deadline_alone_does_not_ask_for_messages() -> None:
    world = World(deadline=0.02)
    world.clock.now += 100
    world.timing.look()
    assert world.timing.missed == 0


@pytest.mark.parametrize("envelope", ["", "hello", "1 12.5", "1 nan", "1 inf", "5", "1 1e5000"])
def test_what_is_no_time_of_day_is_no_age(envelope: str) -> None:
    age = age_of(envelope, lambda: NOW)
    assert age is None or age == -math.inf


def test_what_is_played_back_is_not_late() -> None:
    assert age_of(f"1 {NOW - 7200}", lambda: NOW) is None
    assert age_of(f"1 {NOW - 7}", lambda: NOW) == pytest.approx(7)


def test_what_is_not_said_stays_and_zero_ends_it() -> None:
    first = expected(None, Qos(deadline=0.02))
    assert first == Qos(deadline=0.02)
    both = expected(first, Qos(rate=50, late="drop"))
    assert both == Qos(deadline=0.02, rate=50, late="drop")
    assert expected(both, Qos(deadline=0, late="keep")) == Qos(rate=50)
