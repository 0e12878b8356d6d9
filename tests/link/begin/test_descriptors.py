"""File descriptors: how many are free, and the reserve."""

from __future__ import annotations

import socket
from contextlib import ExitStack

import pytest
from support.open_files import limited, resource

from yarpy.link.begin import descriptors
from yarpy.link.begin.descriptors import Descriptors, allowed, reserve, used


@limited
def test_what_is_used_is_counted() -> None:
    most = allowed()
    assert most is not None
    before = used(most)
    with ExitStack() as stack:
        for _ in range(10):
            stack.enter_context(socket.socket())
        assert used(most) == before + 10


def test_reserve() -> None:
    assert reserve(1024) == 51
    assert reserve(64) == 16


def test_reserve_is_not_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whoever else takes some meanwhile: as many are counted again."""
    taken, looked = [900], [0]

    def look(most: int) -> int:
        looked[0] += 1
        return taken[0]

    monkeypatch.setattr(descriptors, "allowed", lambda: 1000)
    monkeypatch.setattr(descriptors, "used", look)
    monkeypatch.setattr(descriptors, "RECOUNT", -1.0)
    found = Descriptors()
    while found.take():
        taken[0] += 1
    assert taken[0] == 1000 - reserve(1000)
    assert looked[0] < 20
    assert not found.plenty
    taken[0] = 500
    assert found.take()
    assert found.plenty


@limited
def test_limit_is_read_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (500, hard))
    try:
        assert allowed() == 500
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
