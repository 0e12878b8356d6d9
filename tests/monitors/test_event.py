"""Events: whose they are, how long they last, and that they go."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.errors import LocalProtocolError
from yarpy.limit import SCRIPT_EVENTS
from yarpy.monitors.event import EVENTS, Events


class Clock:
    now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def events(clock: Clock) -> Events:
    return Events(clock)


def test_event_lasts_until_it_is_taken_away(events: Events, clock: Clock) -> None:
    events.set("a", "e_go")
    clock.now += 1e6
    assert events.has("e_go")
    events.unset("b", "e_go")  # not b's
    assert events.has("e_go")
    events.unset("a", "e_go")
    assert not events.has("e_go")
    events.unset("a", "e_go")


def test_event_with_a_lifetime_expires_and_can_be_renewed(events: Events, clock: Clock) -> None:
    events.set("a", "e_ball", 0.5)
    clock.now += 0.4
    assert events.has("e_ball")
    events.set("a", "e_ball", 0.5)
    clock.now += 0.4
    assert events.has("e_ball")
    clock.now += 0.1001
    assert not events.has("e_ball")
    events.set("a", "e_ball", -1)
    clock.now += 1e6
    assert events.has("e_ball")
    events.set("a", "e_ball", 0)
    assert not events.has("e_ball")


def test_event_is_there_while_any_owner_has_it(events: Events, clock: Clock) -> None:
    events.set("a", "e", 0.5)
    events.set("b", "e", 2.0)
    clock.now += 1
    assert events.has("e")
    events.clear("b")
    assert not events.has("e")


def test_nothing_is_left_of_an_owner(events: Events) -> None:
    for number in range(10):
        events.set("a", f"e{number}")
    events.set("b", "e1")
    events.clear("a")
    assert [events.has("e0"), events.has("e1")] == [False, True]
    events.clear("b")
    events.clear("c")
    assert (events._ends, events._names) == ({}, {})


@pytest.mark.parametrize("name", ["", "not", "true", "two words", "(e)", "a\tb"])
def test_names_that_no_constraint_could_ask_for(events: Events, name: str) -> None:
    with pytest.raises(LocalProtocolError, match="cannot name an event"):
        events.set("a", name)


def test_owner_has_only_so_many(events: Events, clock: Clock) -> None:
    for number in range(SCRIPT_EVENTS):
        events.set("a", f"e{number}", 1.0)
    with pytest.raises(LocalProtocolError, match="cannot set more than"):
        events.set("a", "another")
    events.set("b", "another")
    events.set("a", "e1", 5.0)
    clock.now += 2  # the others have expired and make room
    events.set("a", "another")
    assert [events.has(name) for name in ("e0", "e1", "another")] == [False, True, True]


WHAT = st.sampled_from([None, 0.5, 1.5, "unset", "clear", "wait"])


@given(st.lists(st.tuples(st.sampled_from("ab"), st.sampled_from("xyz"), WHAT)))
def test_as_a_simple_model(steps: list[tuple[str, str, object]]) -> None:
    clock = Clock()
    events, model = Events(clock), {}
    for owner, name, what in steps:
        if what == "wait":
            clock.now += 1
        elif what == "clear":
            events.clear(owner)
            model = {key: end for key, end in model.items() if key[0] != owner}
        elif what == "unset":
            events.unset(owner, name)
            model.pop((owner, name), None)
        else:
            assert what is None or isinstance(what, float)
            events.set(owner, name, what)
            model[owner, name] = float("inf") if what is None else clock.now + what
        for asked in "xyz":
            expected = any(end > clock.now for (_, n), end in model.items() if n == asked)
            assert events.has(asked) == expected


def test_process_has_one_container() -> None:
    EVENTS.set("test", "e_test_event")
    assert EVENTS.has("e_test_event")
    EVENTS.clear("test")
    assert not EVENTS.has("e_test_event")
