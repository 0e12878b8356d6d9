import logging
import threading

import pytest
from support.wait import HANG, wait_until

from yarpy import clock
from yarpy.kits.devices.publisher import Publisher


def test_it_goes_on_until_it_is_closed(caplog):
    steps = []

    def step():
        steps.append(threading.current_thread().name)
        if len(steps) == 2:
            raise OSError("cable")

    with caplog.at_level(logging.WARNING):
        publisher = Publisher("/head", 0.001, step)
        wait_until(lambda: len(steps) > 5)
        publisher.close()
    count = len(steps)
    assert set(steps) == {"yarpy device /head"}
    assert "/head: publishing: OSError: cable" in caplog.text
    assert "yarpy device /head" not in {thread.name for thread in threading.enumerate()}
    assert len(steps) == count
    publisher.close()


def test_a_step_may_end_it():
    ended = threading.Event()

    def step():
        ready.wait(HANG)
        publisher.close()
        ended.set()

    ready = threading.Event()
    publisher = Publisher("/head", 0.001, step)
    ready.set()
    assert ended.wait(HANG)


class Hand(clock.SystemClock):
    """A clock that is set by hand; `over`: until when it is waited for."""

    time, over = 1000.0, 0.0

    def monotonic(self) -> float:
        return self.time

    def wait(self, event, seconds):
        self.over = self.time + seconds
        while not event.wait(0.002):
            if self.time >= self.over:
                return False
        return True


def test_it_has_the_clock_of_the_program(monkeypatch):
    hand, steps = Hand(), []

    def step():
        steps.append(hand.time)
        if len(steps) == 2:
            hand.time = 3.0  # set back: it goes on a period later, not when it is 1020 again

    monkeypatch.setattr(clock, "_current", hand)
    publisher = Publisher("/head", 10.0, step)
    for until in (1010.0, 13.0):
        wait_until(lambda until=until: hand.over == until)
        hand.time = until
    wait_until(lambda: len(steps) == 3)
    publisher.close()
    assert steps == [1000.0, 1010.0, 13.0]


@pytest.mark.parametrize("period", [0, -1.0, float("nan"), float("inf")])
def test_periods_are_positive(period):
    with pytest.raises(ValueError, match="period"):
        Publisher("/head", period, lambda: None)


def test_a_step_that_does_not_end_is_left_behind(monkeypatch):
    monkeypatch.setattr("yarpy.kits.devices.publisher.TIMEOUT", 0.05)
    stuck, leave = threading.Event(), threading.Event()

    def step():
        stuck.set()
        leave.wait(HANG)

    publisher = Publisher("/head", 0.001, step)
    assert stuck.wait(HANG)
    publisher.close()
    leave.set()
