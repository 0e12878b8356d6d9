"""How long a reader may keep its writer waiting."""

from __future__ import annotations

import time

import pytest

from yarpy.link.write_timeout import WriteTimeout


def test_without_a_limit_the_writer_decides() -> None:
    limit = WriteTimeout()
    assert limit.until(None) is None
    assert limit.until(17.5) == 17.5
    assert not limit.over(took=False)


def test_limit_counts_from_when_the_reader_began_to_take_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    now = 100.0
    monkeypatch.setattr(time, "monotonic", lambda: now)
    limit = WriteTimeout(10.0)
    assert limit.until(None) == 110
    assert limit.until(103.0) == 103
    assert not limit.over(took=False)
    now = 106.0
    assert limit.until(0.0) == 0.0
    assert limit.until(None) == 110, "another writer adds no time"
    assert not limit.over(took=True)
    assert limit.until(None) == 116
    now = 116.0
    assert limit.over(took=False)
