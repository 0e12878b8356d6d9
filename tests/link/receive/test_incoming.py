"""Messages that have begun: they come along, or their connection ends, with a reason."""

from __future__ import annotations

import time

import pytest

from yarpy.errors import RemoteProtocolError
from yarpy.link.receive.budget import Budget
from yarpy.link.receive.incoming import FREE, LEAST, Incoming


class Clock:
    """The time of a test."""

    now = 1000.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    found = Clock()
    monkeypatch.setattr(time, "monotonic", found)
    return found


def incoming(silence: float | None = 30.0) -> Incoming:
    return Incoming(silence, lambda: None, lambda: None)


def test_message_that_comes_steadily_may_take_long(clock: Clock) -> None:
    slow = incoming()
    for second in range(3600):
        clock.now += 1
        slow.advance(1100 * (second + 1))
    assert not slow.reason


def test_byte_now_and_then_is_not_enough(clock: Clock) -> None:
    slow = incoming()
    with pytest.raises(RemoteProtocolError, match="bytes per second"):
        for count in range(1, 10):
            slow.advance(count)
            clock.now += 29
            slow.wait()
    assert 60 <= clock.now - 1000 <= 120
    with pytest.raises(RemoteProtocolError, match="bytes per second"):
        slow.advance(1000)  # whoever reads next meets the same


def test_fast_beginning_excuses_no_slow_end(clock: Clock) -> None:
    slow = incoming()
    slow.advance(100 * LEAST)
    with pytest.raises(RemoteProtocolError, match="bytes per second"):
        for second in range(200):
            clock.now += 1
            slow.advance(100 * LEAST + second)


def test_silence_in_the_middle_ends_it(clock: Clock) -> None:
    silent = incoming()
    silent.advance(5)
    clock.now += 10
    silent.wait()  # another limit of the wait was over
    clock.now += 20
    with pytest.raises(RemoteProtocolError, match="nothing has come for 30 s"):
        silent.wait()


def test_each_message_has_its_own_time(clock: Clock) -> None:
    several = incoming()
    for _ in range(10):
        several.advance(5)
        clock.now += 25
        several.since = 0.0
    assert not several.reason


def test_no_limit(clock: Clock) -> None:
    patient = incoming(None)
    for count in range(10):
        patient.advance(count)
        clock.now += 1000
        patient.wait()


def test_only_large_messages_ask_the_budget() -> None:
    budget = Budget(1 << 30)
    large = incoming()
    large.budget = budget
    large.advance(FREE)
    assert budget.total == 0
    large.advance(FREE + 1)
    assert budget.total == large.held == 2 * (FREE + 1)
    large.advance(2 * FREE)
    assert budget.total == large.held == 2 * (FREE + 1)
    large.leave()
    assert budget.total == 0


def test_message_that_the_budget_ends() -> None:
    woken: list[bool] = []
    ended = Incoming(30.0, lambda: woken.append(True), lambda: None)
    ended.end("too much")
    assert woken == [True]
    with pytest.raises(RemoteProtocolError, match="too much"):
        ended.advance(1)
