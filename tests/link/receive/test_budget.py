"""The total of unfinished messages: who may go on, and who is ended, when it is spent."""

from __future__ import annotations

import time

import pytest

from yarpy.link.receive.budget import PROCESS, SETTING, Budget, port_budget, start_over


class Holder:
    """A connection with an unfinished message."""

    def __init__(self, age: float = 1.0, idle: bool = False) -> None:
        self.held = 0
        self.since = 0.0 if idle else time.monotonic() - age
        self.forgot = False
        self.reason = ""

    def forget(self) -> None:
        self.forgot = True

    def end(self, reason: str) -> None:
        self.reason = reason


def test_lone_message_passes_whatever_its_size() -> None:
    budget = Budget(100)
    alone, small = Holder(), Holder()
    budget.take(alone, 10_000)
    budget.take(small, 90)
    assert budget.total == 10_090
    assert not alone.reason
    assert not small.reason


def test_who_has_held_most_for_longest_is_ended() -> None:
    budget = Budget(100)
    trickling = [Holder(age=30.0) for _ in range(5)]
    for one in trickling:
        budget.take(one, 30)
    assert sum(bool(one.reason) for one in trickling) == 1
    fast = [Holder(age=0.01) for _ in range(4)]
    for one in fast:
        budget.take(one, 33)
    assert not any(one.reason for one in fast)
    assert all(one.reason for one in trickling)
    assert budget.total <= 100 + 33
    assert SETTING in trickling[0].reason
    assert "has held 30 of them" in trickling[0].reason


def test_who_asks_may_be_the_one() -> None:
    budget = Budget(100)
    others = [Holder(age=0.01), Holder(age=0.01)]
    for one in others:
        budget.take(one, 90)
    greedy = Holder(age=100.0)
    budget.take(greedy, 80)
    assert greedy.reason
    assert budget.total == 180


def test_memory_that_is_only_kept_goes_first() -> None:
    budget = Budget(100)
    idle = Holder(idle=True)
    budget.take(idle, 60)
    busy = [Holder(age=50.0), Holder(age=60.0)]
    for one in busy:
        budget.take(one, 60)
    assert idle.forgot
    assert idle.held == 0
    assert not idle.reason
    assert not any(one.reason for one in busy)
    assert budget.total == 120


def test_what_is_given_back_can_be_used() -> None:
    budget = Budget(100)
    holders = [Holder() for _ in range(50)]
    for one in holders:
        budget.take(one, 90)
        budget.give_back(one)
    assert budget.total == 0
    assert not any(one.reason for one in holders)


def test_part_counts_for_the_whole() -> None:
    whole = Budget(150)
    parts = [Budget(100, whole) for _ in range(4)]
    holders = [Holder(age=1.0 + number) for number in range(4)]
    for part, one in zip(parts, holders, strict=True):
        part.take(one, 90)
    assert [bool(one.reason) for one in holders].count(True) == 2
    assert whole.total <= 150 + 90
    for part, one in zip(parts, holders, strict=True):
        part.give_back(one)
    assert whole.total == 0


def test_setting(monkeypatch: pytest.MonkeyPatch) -> None:
    start_over()
    monkeypatch.setenv(SETTING, "1000")
    first, second = port_budget(), port_budget(100)
    assert (first.limit, second.limit) == (1000, 100)
    holders = [Holder(), Holder()]
    first.take(holders[0], 700)
    second.take(holders[1], 50)
    assert first._whole is second._whole
    assert first._whole is not None
    assert first._whole.limit == PROCESS * 1000
    assert first._whole.total == 750
    start_over()
    assert port_budget()._whole is not first._whole
    start_over()
