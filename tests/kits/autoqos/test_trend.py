"""What counters of several looks say."""

from __future__ import annotations

from typing import Any

import pytest

from yarpy.kits.autoqos.trend import KEEP, Trend
from yarpy.network.traffic import End, Flow, Snapshot

PAIR = ("/a", "/b")


def trend(*looks: tuple[float, dict[str, Any], dict[str, Any]]) -> Trend:
    """From times and the counters of sender and receiver."""
    made = Trend()
    for at, sender, receiver in looks:
        flow = Flow(*PAIR, End(**sender), End(**receiver))
        made.add(Snapshot(at, flows={PAIR: flow}), at)
    return made


def counted(messages: int, missed: int) -> dict[str, Any]:
    return {"messages": messages, "timing": {"missed": missed}}


def test_missed_deadlines() -> None:
    made = trend((1.0, {}, counted(0, 0)), (2.0, {}, counted(100, 0)), (3.0, {}, counted(200, 50)))
    assert made.missed([PAIR], 0.0) == 0.25
    assert made.missed([PAIR], 2.0) == 0.5
    assert made.missed([PAIR], 3.0) is None
    assert made.missed([("/x", "/y")], 0.0) is None
    assert made.counts([PAIR]) and not made.counts([("/x", "/y")])


def test_a_single_late_message_is_chance() -> None:
    made = trend((1.0, {}, counted(0, 0)), (2.0, {}, counted(10, 1)), (3.0, {}, counted(20, 2)))
    assert made.missed([PAIR], 2.0) == 0.0
    assert made.missed([PAIR], 1.0) == 0.1


def test_messages_per_second() -> None:
    made = trend((1.0, {}, counted(0, 0)), (2.0, {}, counted(90, 0)), (3.0, {}, counted(100, 50)))
    assert made.pace([PAIR]) == 50.0
    assert made.pace([("/x", "/y")]) == 0.0
    assert Trend().pace([PAIR]) == 0.0
    assert trend((1.0, {}, {}), (2.0, {}, {})).pace([PAIR]) == 0.0


def test_silence_is_late_too() -> None:
    made = trend((1.0, {}, counted(10, 0)), (2.0, {}, counted(10, 3)))
    assert made.missed([PAIR], 0.0) == 1.0


def test_a_connection_that_was_made_again() -> None:
    made = trend((1.0, {}, counted(100, 90)), (2.0, {}, counted(10, 0)))
    assert made.missed([PAIR], 0.0) is None


def test_who_counts_nothing() -> None:
    made = trend((1.0, {}, {}), (2.0, {}, {}))
    assert made.missed([PAIR], 0.0) is None
    assert made.mbit(PAIR, 0.0) is None
    assert not made.counts([PAIR])
    assert not Trend().counts([PAIR])


def test_speed() -> None:
    made = trend((1.0, {"bytes": 0}, {}), (2.0, {"bytes": 125_000}, {}), (2.1, {"bytes": 9e9}, {}))
    assert made.mbit(PAIR, 2.0) is None  # too short to tell
    made = trend((1.0, {"bytes": 0}, {"bytes": 0}), (3.0, {"bytes": 0}, {"bytes": 250_000}))
    assert made.mbit(PAIR, 0.0) == pytest.approx(1.0)
    assert made.mbit(("/x", "/y"), 0.0) is None


@pytest.mark.parametrize(
    ("senders", "wants"),
    [
        ([{"unacknowledged": 1}] * 4, True),
        ([{"unacknowledged": 0}] * 4, False),
        ([{"drops": n} for n in range(4)], True),
        ([{"unacknowledged": n % 2} for n in range(6)], True),
        ([{}] * 4, False),
    ],
)
def test_who_wants_more(senders: list[dict[str, Any]], wants: bool) -> None:
    made = trend(*((float(at), sender, {}) for at, sender in enumerate(senders)))
    assert made.wants_more(PAIR, 0.0) is wants


def test_old_looks_are_forgotten() -> None:
    made = Trend()
    for at in range(1000):
        made.add(Snapshot(float(at)), float(at))
    assert len(made._looks) <= KEEP + 1
