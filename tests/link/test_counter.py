"""Counters: how a link is doing, as numbers."""

from __future__ import annotations

import time

import pytest
from support.build import COMPILED
from support.moments import moments

from yarpy.link.counter import KEEP, Counter, Past


def test_regular_messages_have_a_period_and_no_jitter() -> None:
    counter = Counter()
    for number in range(100):
        counter.count(number * 0.01)
    assert counter.messages == 100
    assert counter.period == pytest.approx(0.01)
    assert counter.jitter == pytest.approx(0.0, abs=1e-9)


def test_messages_that_come_together_share_their_period() -> None:
    counter = Counter()
    for number in range(100):
        counter.messages += 50
        counter.count(number * 0.5, 0, 50)
    assert counter.period == pytest.approx(0.01, rel=0.01)


def test_irregular_messages_have_jitter() -> None:
    counter = Counter()
    now = 0.0
    for number in range(200):
        now += 0.01 if number % 2 else 0.03
        counter.count(now)
    assert counter.period == pytest.approx(0.02, rel=0.1)
    assert counter.jitter == pytest.approx(0.01, rel=0.2)


def test_rate_falls_once_messages_stop() -> None:
    counter = Counter()
    assert counter.rate == 0.0
    now = time.perf_counter()
    for number in range(10):
        counter.count(now - 0.001 * (10 - number))
    assert counter.rate == pytest.approx(1000, rel=0.5)
    counter.last -= 1.0
    assert counter.rate < 1.1


def test_latency_is_smoothed() -> None:
    counter = Counter()
    counter.measure(0.001)
    assert counter.latency == 0.001
    counter.measure(0.017)
    assert counter.latency == pytest.approx(0.002)


def test_numbers_by_name() -> None:
    counter = Counter(since=5.0)
    counter.count(1.0)
    counter.drops = 3
    counter.bytes = 70
    found = counter.as_dict()
    assert found["messages"] == 1
    assert found["drops"] == 3
    assert found["bytes"] == 70
    assert found["since"] == 5.0
    assert set(found) == {
        *(
            "messages",
            "bytes",
            "replaced",
            "drops",
            "unconfirmed",
            "period",
            "jitter",
            "latency",
            "since",
            "rate",
        ),
    }


def test_sums_over_links_that_are_over() -> None:
    past = Past()
    assert past.as_dict() == {
        "messages": 0,
        "bytes": 0,
        "replaced": 0,
        "drops": 0,
        "unconfirmed": 0,
    }
    counters = [Counter(1, 10, 5, drops=2, unconfirmed=4) for _ in range(3 * KEEP)]
    for counter in counters:
        past.add(counter, 1)
    expected = {"messages": 3 * KEEP, "bytes": 30 * KEEP, "drops": 9 * KEEP}
    expected["unconfirmed"], expected["replaced"] = 12 * KEEP, 15 * KEEP
    assert past.as_dict() == expected
    counters[-1].drops += 5  # what waited is dropped later
    assert past.as_dict()["drops"] == 9 * KEEP + 5


@pytest.mark.skipif(COMPILED, reason="handlers do not run in the middle of compiled code")
def test_a_signal_handler_above_adds_another_one() -> None:
    """At every moment of an addition: both are counted, once."""
    for moment in moments():
        past, one, other = Past(), Counter(1), Counter(2)
        for _ in range(KEEP):
            past.add(Counter(4))
        with moment.interrupts(lambda past=past, other=other: past.add(other)):
            past.add(one)
        past.add(one)
        if moment.came:
            assert past.as_dict()["messages"] == 4 * KEEP + 3
