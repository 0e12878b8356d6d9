"""A busy machine is slow, not its peer: a sender that is kept for some milliseconds would wait
for an acknowledgement, for ever where a test's peer says nothing more."""

from __future__ import annotations

import pytest

from yarpy.link.send import window


@pytest.fixture(autouse=True)
def unhurried(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(window, "WINDOW_SECONDS", 60.0)
