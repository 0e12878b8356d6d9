"""How long a reader may keep its writer waiting."""

from __future__ import annotations

import time

import pytest

from yarpy.link.send.slow_reader import SlowReader
from yarpy.route import Route

ROUTE = Route("/here", "/peer", "tcp")


def test_without_a_limit_the_writer_decides() -> None:
    limit = SlowReader(ROUTE)
    assert limit.limit_of(None) is None
    assert limit.limit_of(17.5) == 17.5
    assert not limit.over(took=False)


def test_limit_counts_from_when_the_reader_began_to_take_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    now = 100.0
    monkeypatch.setattr(time, "monotonic", lambda: now)
    limit = SlowReader(ROUTE, 10.0)
    assert limit.limit_of(None) == 110
    assert limit.limit_of(103.0) == 103
    assert not limit.over(took=False)
    now = 106.0
    assert limit.limit_of(0.0) == 0.0
    assert limit.limit_of(None) == 110, "another writer adds no time"
    assert not limit.over(took=True)
    assert limit.limit_of(None) == 116
    now = 116.0
    assert limit.over(took=False)


def test_the_log_tells_once_of_a_writer_that_waits_for_long(
    caplog: pytest.LogCaptureFixture,
) -> None:
    slow = SlowReader(ROUTE)
    soon = slow.warning(None)
    assert soon is not None and soon <= time.monotonic() + 1.0
    assert slow.warning(time.monotonic() + 0.5) is None, "the writer has given up by then"
    slow.warn()
    slow.warn()
    assert caplog.text.count("/peer has taken nothing for 1 s") == 1
    assert slow.warning(None) is None
    slow.took()
    assert slow.warning(None) is not None


def test_another_writer_may_find_that_the_reader_took_everything() -> None:
    """It is no writer that has waited since the computer was started."""
    limit = SlowReader(ROUTE, 10.0)
    for took in (True, False):
        limit.limit_of(None)
        assert not limit.over(took=True)
        assert not limit.over(took)
