"""What a receiver of datagrams is taken to keep up with, by a clock of the test's own."""

from __future__ import annotations

import pytest

from yarpy.transports.pace import BURST, RATE, Pace


class Clock:
    """Time that passes by sleeping, `late` seconds too long each time."""

    def __init__(self, late: float = 0.0) -> None:
        self.now = 100.0
        self.late = late
        self.slept: list[float] = []

    def sleep(self, seconds: float) -> None:
        self.slept.append(seconds)
        self.now += seconds + self.late


def pace(clock: Clock) -> Pace:
    return Pace(lambda: clock.now, clock.sleep)


@pytest.mark.parametrize("late", [0.0, 60e-6, 5e-3])
def test_receiver_of_a_picture_never_has_two_datagrams_waiting(late: float) -> None:
    clock = Clock(late)
    keeper = pace(clock)
    waiting, read_until = 0.0, clock.now
    for _ in range(15):
        keeper.wait(65499)
        waiting = max(0.0, waiting - (clock.now - read_until) * RATE)
        read_until = clock.now
        waiting += 65499
        assert waiting <= BURST + 1
    assert len(clock.slept) == 14
    assert sum(clock.slept) == pytest.approx(14 * 65499 / RATE, rel=0.01)


def test_small_messages_do_not_wait() -> None:
    clock = Clock()
    keeper = pace(clock)
    for _ in range(10_000):
        keeper.wait(200)
        clock.now += 5e-6  # faster than Python sends
    assert clock.slept == []


def test_flood_of_messages_waits() -> None:
    clock = Clock()
    keeper = pace(clock)
    for _ in range(1000):
        keeper.wait(1000)
    assert sum(clock.slept) == pytest.approx((1_000_000 - BURST) / RATE, rel=0.01)


def test_silence_is_not_saved_up() -> None:
    clock = Clock()
    keeper = pace(clock)
    for _ in range(2):
        keeper.wait(65000)
    clock.now += 60.0
    slept = len(clock.slept)
    keeper.wait(65000)
    assert len(clock.slept) == slept
    keeper.wait(65000)
    assert len(clock.slept) == slept + 1
