"""What scripts may do besides: events of their own, a constraint, a timer that ends."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator

import pytest
from support.wait import wait_until

from yarpy.errors import LocalProtocolError
from yarpy.monitors.event import Events
from yarpy.monitors.script.control import Control

NAME = "/a -> /control"  # no other test has it


@pytest.fixture
def events() -> Events:
    return Events()


@pytest.fixture
def rung() -> list[float]:
    return []


@pytest.fixture
def control(events: Events, rung: list[float]) -> Iterator[Control]:
    found = Control("", lambda: rung.append(time.monotonic()), NAME, events)
    yield found
    found.close()
    wait_until(lambda: not timers(), what="the timer has ended")  # the next test looks for its own


def timers() -> list[threading.Thread]:
    return [one for one in threading.enumerate() if one.name == f"yarpy trig {NAME}"]


def test_constraint_depends_on_the_events_of_all(control: Control, events: Events) -> None:
    assert control.allows()
    other = Control(events=events)
    control.set_constraint("not e_ball")
    assert control.get_constraint() == "not e_ball"
    other.set_event("e_ball")
    assert not control.allows()
    control.unset_event("e_ball")  # it is the other's
    assert not control.allows()
    other.unset_event("e_ball")
    assert control.allows()
    control.set_constraint("")
    assert control.allows()


def test_wrong_constraint_leaves_the_one_before(control: Control) -> None:
    control.set_constraint("false")
    with pytest.raises(LocalProtocolError, match="cannot be read"):
        control.set_constraint("not")
    assert control.get_constraint() == "false"
    with pytest.raises(LocalProtocolError, match="cannot be read"):
        Control("a b")


def test_events_go_with_their_monitor(control: Control, events: Events) -> None:
    control.set_event("e")
    control.set_event("f", 100.0)
    control.close()
    assert not events.has("e")
    control.set_event("e")  # a script's last callback
    assert not events.has("e")


def test_names_of_cpp_are_the_same_functions(control: Control, events: Events) -> None:
    control.setEvent("e", 100)
    control.setConstraint("e")
    assert (control.allows(), control.getConstraint()) == (True, "e")
    control.unsetEvent("e")
    assert not control.allows()


def test_timer_triggers_until_it_is_told_otherwise(control: Control, rung: list[float]) -> None:
    control.set_trig_interval(0.01)
    wait_until(lambda: len(rung) >= 5)
    assert len(timers()) == 1
    control.setTrigInterval(1000)
    wait_until(lambda: control._interval == 1000)
    count = len(rung)
    control.set_trig_interval(0.02)  # a change counts at once
    wait_until(lambda: len(rung) >= count + 3)
    control.unsetTrigInterval()
    wait_until(lambda: not timers(), what="the timer has ended")
    count = len(rung)
    control.set_trig_interval(0.01)
    wait_until(lambda: len(rung) > count)
    control.close()
    wait_until(lambda: not timers())
    control.set_trig_interval(0.01)
    assert not timers()


def test_interval_is_kept_on_average(control: Control, rung: list[float]) -> None:
    """Seconds are seconds: C++ would take these for a thousand times as many."""
    start = time.monotonic()
    control.set_trig_interval(0.02)
    wait_until(lambda: len(rung) >= 25)
    assert rung[24] - start >= 24 * 0.02


@pytest.mark.parametrize("seconds", [-1, 0.0001, 1e9, float("nan"), float("inf")])
def test_impossible_intervals(control: Control, seconds: float) -> None:
    with pytest.raises(LocalProtocolError, match="interval of trig"):
        control.set_trig_interval(seconds)
    assert not timers()
