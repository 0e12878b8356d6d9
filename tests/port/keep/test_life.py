"""The state of a port."""

from __future__ import annotations

from yarpy.port.keep.life import Life


def test_over_for_now_or_for_good() -> None:
    life = Life()
    assert not life.over
    life.interrupted = True
    assert life.over
    life.interrupted = False
    assert not life.over
    life.closing = True
    assert life.over


def test_that_of_a_parent_is_over_in_its_child() -> None:
    life = Life()
    calls = life.calls
    life.inherit()
    assert life.over and life.inherited
    assert life.calls is not calls, "those are of threads that are not here"
