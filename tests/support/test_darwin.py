"""What the tests lack that run as on macOS."""

from __future__ import annotations

import os
import socket
from types import ModuleType

import pytest
from support.darwin import Seen, lacking


def test_names_that_macos_lacks() -> None:
    assert {"memfd_create", "sched_setscheduler", "eventfd"} <= lacking("os")
    assert {"SO_PEERCRED", "TCP_INFO", "TCP_QUICKACK"} <= lacking("socket")
    assert "epoll" in lacking("select")
    assert not {"AF_UNIX", "sendmsg", "socket"} & lacking("socket")


def test_a_module_is_seen_without_them(monkeypatch: pytest.MonkeyPatch) -> None:
    real = ModuleType("real")
    real.kept, real.gone = 1, 2  # type: ignore[attr-defined]
    seen = Seen(real, frozenset({"gone"}), platform="darwin")
    assert (seen.kept, seen.platform, hasattr(seen, "gone")) == (1, "darwin", False)
    with monkeypatch.context() as patch:
        patch.setattr(seen, "kept", 3)
        patch.setattr(seen, "platform", "win32")
        assert (real.kept, seen.platform) == (3, "win32")  # type: ignore[attr-defined]
    assert (real.kept, seen.platform) == (1, "darwin")  # type: ignore[attr-defined]
    assert dir(seen) == [name for name in dir(real) if name != "gone"]


def test_nothing_is_seen_so_unless_it_is_asked_for() -> None:
    if os.environ.get("YARPY_TESTS_AS"):
        pytest.skip("it is asked for")
    assert not isinstance(socket, Seen)
