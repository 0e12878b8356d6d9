"""Changes: undone, written down, read again."""

from __future__ import annotations

import json

import pytest

from yarpy.kits.autoqos.change import Change

CHANGE = Change("/a", "/b", "threads", ("SCHED_FIFO", 30), ("SCHED_OTHER", 0))


def test_undone() -> None:
    back = CHANGE.undone
    assert (back.value, back.before) == (CHANGE.before, CHANGE.value)
    assert back.what == CHANGE.what
    assert back.undone == CHANGE


def test_there_and_back() -> None:
    assert Change.from_dict(json.loads(json.dumps(CHANGE.as_dict()))) == CHANGE


@pytest.mark.parametrize(
    "told",
    [
        3,
        {},
        {**CHANGE.as_dict(), "key": "power"},
        {**CHANGE.as_dict(), "key": ["x"]},
        {**CHANGE.as_dict(), "port": "a"},
        {**CHANGE.as_dict(), "peer": None},
    ],
)
def test_what_is_none(told: object) -> None:
    with pytest.raises(ValueError):
        Change.from_dict(told)
