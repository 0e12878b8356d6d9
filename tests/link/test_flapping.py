"""Trouble is logged when it begins and when it ends."""

from __future__ import annotations

import pytest

from yarpy.link.flapping import Flapping


def test_two_lines_however_often_it_happens(caplog: pytest.LogCaptureFixture) -> None:
    trouble = Flapping("/here", "all is well again")
    trouble.over()
    for number in range(100):
        trouble.happened("no room for %d", number)
    assert [record.getMessage() for record in caplog.records] == ["/here: no room for 0"]
    trouble.over()
    trouble.over()
    assert caplog.records[-1].getMessage() == "/here: all is well again (100 times in between)"
    trouble.happened("no room for %d", 7)
    assert len(caplog.records) == 3
