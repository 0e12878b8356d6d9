"""Priorities: names and numbers of packets and threads, and what the system says to them."""

from __future__ import annotations

import doctest
import sys
import threading

import pytest
from support.system import NO_SCHEDULING
from support.wait import HANG

from yarpy import qos
from yarpy.errors import LocalProtocolError
from yarpy.platform import scheduling
from yarpy.qos import DSCP, Sched, policy_of, schedule, scheduled, tos_of


def test_examples_in_the_docstrings() -> None:
    found = doctest.testmod(qos)
    assert found.attempted
    assert found.failed == 0


TOS = [
    # the whole table of C++ YARP
    *((f"CS{n}", 32 * n) for n in range(8)),
    *[("AF11", 40), ("AF12", 48), ("AF13", 56), ("AF21", 72), ("AF22", 80), ("AF23", 88)],
    *[("AF31", 104), ("AF32", 112), ("AF33", 120), ("AF41", 136), ("AF42", 144), ("AF43", 152)],
    *[("VA", 176), ("EF", 184)],
    *[("LOW", 40), ("NORM", 0), ("HIGH", 144), ("CRIT", 176)],
    *[("NORMAL", 0), ("high", 144), ("af12", 48)],
    *[(0, 0), (10, 40), (63, 252)],
]


@pytest.mark.parametrize(("value", "tos"), TOS)
def test_packet_priorities(value: str | int, tos: int) -> None:
    assert tos_of(value) == tos


@pytest.mark.parametrize("value", ["BAD", "", "AF44", "CS8", -1, 64])
def test_what_is_no_priority(value: str | int) -> None:
    with pytest.raises(ValueError, match=r"priority|DSCP"):
        tos_of(value)


def test_classes_are_complete() -> None:
    assert len(DSCP) == 8 + 12 + 2


POLICIES = [("SCHED_FIFO", 1), ("fifo", 1), ("RR", 2), ("SCHED_OTHER", 0), ("other", 0), (1, 1)]


@pytest.mark.parametrize(("value", "policy"), POLICIES)
def test_policies(value: str | int, policy: int) -> None:
    assert policy_of(value) == policy


def test_what_is_no_policy() -> None:
    with pytest.raises(ValueError, match="scheduling policy"):
        policy_of("LIFO")


def in_a_thread(work: object) -> object:
    """What `work` returns or raises in a thread whose scheduling nobody needs afterwards."""
    assert callable(work)
    found: list[object] = []

    def run() -> None:
        try:
            found.append(work())
        except Exception as error:
            found.append(error)

    thread = threading.Thread(target=run)
    thread.start()
    thread.join(HANG)
    return found[0]


@pytest.mark.skipif(bool(NO_SCHEDULING), reason=NO_SCHEDULING)
def test_thread_is_scheduled_or_the_reason_is_told() -> None:
    def fifo() -> Sched:
        schedule(0, Sched(1, 5))
        return scheduled(0)

    found = in_a_thread(fifo)
    if isinstance(found, LocalProtocolError):
        assert "the system refuses" in str(found)
    else:
        assert found == (Sched(2, 1) if sys.platform == "win32" else Sched(1, 5))
    assert in_a_thread(lambda: schedule(0, Sched(0, 0))) is None
    assert in_a_thread(lambda: scheduled(0)) == Sched(0, 0)


def test_impossible_priority() -> None:
    found = in_a_thread(lambda: schedule(0, Sched(1, 200)))
    assert isinstance(found, LocalProtocolError)


def test_thread_that_does_not_exist() -> None:
    assert scheduled(2**22 - 1) == Sched()


def test_system_without_scheduling(monkeypatch: pytest.MonkeyPatch) -> None:
    def lacks(*_: object) -> None:
        raise NotImplementedError

    def does_not_say(_: int) -> None:
        raise OSError

    monkeypatch.setattr(scheduling, "schedule", lacks)
    monkeypatch.setattr(scheduling, "scheduled", does_not_say)
    assert scheduled(0) == Sched()
    with pytest.raises(LocalProtocolError, match="does not let"):
        schedule(0, Sched(1, 5))


def test_when_messages_should_come() -> None:
    assert repr(qos.Qos("fifo", 3, rate=5)) == (
        "Qos(policy='SCHED_FIFO', priority=3, packets=None, rate=5)"
    )
    assert qos.Qos(late="drop").timed
    assert not qos.Qos("fifo", 3, "HIGH").timed


WRONG = [{"deadline": -1}, {"deadline": float("nan")}, {"rate": 1e7}, {"rate": "5"}, {"late": "x"}]


@pytest.mark.parametrize("wrong", WRONG)
def test_what_is_no_expectation(wrong: dict[str, object]) -> None:
    with pytest.raises(ValueError, match=r"a number from 0|drop"):
        qos.Qos(**wrong)  # type: ignore[arg-type]
