"""How long a reader may keep its writer waiting."""

from __future__ import annotations

import time

import pytest

from yarpy.link.patience import Patience


def test_without_a_limit_the_writer_decides() -> None:
    patience = Patience()
    assert patience.until(None) is None
    assert patience.until(17.5) == 17.5
    assert not patience.over(took=False)


def test_limit_counts_from_when_the_reader_began_to_take_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    now = 100.0
    monkeypatch.setattr(time, "monotonic", lambda: now)
    patience = Patience(10.0)
    assert patience.until(None) == 110
    assert patience.until(103.0) == 103
    assert not patience.over(took=False)
    now = 106.0
    assert patience.until(0.0) == 0.0
    assert patience.until(None) == 110, "another writer adds no time"
    assert not patience.over(took=True)
    assert patience.until(None) == 116
    now = 116.0
    assert patience.over(took=False)
