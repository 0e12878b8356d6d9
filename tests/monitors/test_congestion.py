"""Congestion control: a link of a given speed, in numbers."""

from __future__ import annotations

from math import inf

from yarpy.monitors.congestion import LEAST, Congestion

GOAL = 0.03


class Link:
    """Takes `size / speed` seconds for a message, and a little for each."""

    def __init__(self, speed: float) -> None:
        self.speed = speed
        self.control = Congestion()
        self.now = 0.0

    def run(self, seconds: float, wish: float = 200e3) -> list[float]:
        """Messages of at most `wish` bytes for so long; how long each was under way."""
        found, end = [], self.now + seconds
        while self.now < end:
            size = int(min(wish, self.control.budget(GOAL)))
            took = 0.001 + size / self.speed
            self.now += max(took, GOAL)
            self.control.confirmed(size, took, GOAL, self.now)
            found.append(took)
        return found


def test_a_fast_link_is_left_alone() -> None:
    link = Link(100e6)
    link.run(5)
    assert link.control.rate == inf


def test_messages_fit_a_slow_link() -> None:
    link = Link(600e3)
    before = link.run(2)
    after = link.run(20)
    assert max(before) > 5 * GOAL
    assert sum(took > GOAL for took in after) < len(after) / 20
    assert sum(after) / len(after) > 0.75 * GOAL  # and use it


def test_it_follows_a_link_down_and_up() -> None:
    link = Link(6e6)
    link.run(5)
    link.speed = 600e3
    falling = link.run(1.5)
    assert all(took < 1.1 * GOAL for took in falling[-5:])
    link.run(10)
    link.speed = 6e6
    growing = link.run(4)
    assert max(growing) > 0.7 * GOAL  # ten times more is sent again
    assert max(growing) < 2 * GOAL


def test_a_single_late_message_changes_nothing() -> None:
    link = Link(600e3)
    link.run(10)
    rate = link.control.rate
    link.control.confirmed(10_000, 1.5 * GOAL, GOAL, link.now)
    assert link.control.rate == rate
    link.control.confirmed(10_000, 1.5 * GOAL, GOAL, link.now)
    assert link.control.rate < rate


def test_a_very_late_one_costs_half_at_most() -> None:
    link = Link(600e3)
    link.run(10)
    rate = link.control.rate
    link.control.confirmed(10_000, 100.0, GOAL, link.now)
    assert link.control.rate == rate / 2


def test_it_never_falls_to_nothing() -> None:
    control = Congestion()
    for now in range(100):
        control.confirmed(1, 1000.0, GOAL, float(now))
    assert control.rate == LEAST
    control.confirmed(0, 0.0, GOAL, 1e9)
    assert control.rate >= LEAST
