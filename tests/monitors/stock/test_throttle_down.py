"""throttleDown: at most one message in a period, with a clock that the test turns."""

from __future__ import annotations

import pytest
from support.monitor import place

from yarpy import LocalProtocolError
from yarpy.data.bottle import Property
from yarpy.monitors.stock import throttle_down
from yarpy.monitors.stock.throttle_down import ThrottleDown
from yarpy.wire.message import DATA, Message

MESSAGE = Message(DATA)


class Clock:
    now = 1000.0

    def monotonic(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    made = Clock()
    monkeypatch.setattr(throttle_down, "time", made)
    return made


def passed(monitor: ThrottleDown, clock: Clock, *times: float) -> list[float]:
    """Which of the messages at these times (seconds) pass."""
    found = []
    for at in times:
        clock.now = 1000.0 + at
        if monitor.accept(MESSAGE):
            found.append(at)
    return found


def test_one_in_a_period(clock: Clock) -> None:
    monitor = ThrottleDown(place("period_ms.500"))
    assert passed(monitor, clock, 0, 0.1, 0.4, 0.5, 0.9, 1.1, 5, 5.4, 5.5) == [0, 0.5, 1.1, 5, 5.5]


def test_lateness_does_not_add_up(clock: Clock) -> None:
    monitor = ThrottleDown(place("period_ms.100"))
    late = [0.03 * number for number in range(100)]  # 3 seconds, of which every 30 ms bring one
    assert 29 <= len(passed(monitor, clock, *late)) <= 31


def test_a_second_without_a_parameter(clock: Clock) -> None:
    assert passed(ThrottleDown(place()), clock, 0, 0.9, 1.0) == [0, 1.0]


def test_everything_passes_at_period_0(clock: Clock) -> None:
    assert passed(ThrottleDown(place("period_ms.0")), clock, 0, 0, 0) == [0, 0, 0]


def test_parameters_while_running(clock: Clock) -> None:
    monitor = ThrottleDown(place("period_ms.500"))
    assert monitor.parameters() == {"period_ms": 500}
    monitor.configure(Property(period_ms=10))
    assert passed(monitor, clock, 0, 0.02) == [0, 0.02]
    with pytest.raises(LocalProtocolError):
        monitor.configure(Property(period_ms="often"))
    assert monitor.parameters() == {"period_ms": 10}


def test_wrong_period() -> None:
    with pytest.raises(LocalProtocolError, match="period_ms"):
        ThrottleDown(place("period_ms.-1"))
