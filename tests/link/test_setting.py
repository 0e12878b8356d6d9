"""Numbers in the environment."""

from __future__ import annotations

import pytest

from yarpy.link.setting import number


def test_number(monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture) -> None:
    monkeypatch.delenv("YARPY_TEST", raising=False)
    assert number("YARPY_TEST", 7) == 7
    monkeypatch.setenv("YARPY_TEST", "12")
    assert number("YARPY_TEST", 7) == 12
    assert not caplog.records
    for wrong in ("many", "-1", "1e3", "9" * 30):
        monkeypatch.setenv("YARPY_TEST", wrong)
        assert number("YARPY_TEST", 7) == 7
        assert number("YARPY_TEST", 7) == 7
    assert len(caplog.records) == 4
