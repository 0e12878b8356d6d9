"""Connections that have not spoken yet: who must go when there are too many, or too late."""

from __future__ import annotations

import socket
from collections.abc import Callable, Iterator

import pytest

from yarpy.link.begin import pending
from yarpy.link.begin.pending import Pending

Enter = Callable[[str], socket.socket]


@pytest.fixture
def room() -> Iterator[Pending]:
    found = Pending(share=3)
    yield found
    found.clear()
    assert len(found) == 0


@pytest.fixture
def enter(room: Pending) -> Enter:
    def come(address: str) -> socket.socket:
        sock = socket.socket()
        room.enter(sock, address)
        return sock

    return come


def test_oldest_of_an_address_goes_first(room: Pending, enter: Enter) -> None:
    enter("10.0.0.1")
    crowd = [enter("10.0.0.2") for _ in range(3)]
    assert room.crowded("10.0.0.1") is None
    assert room.crowded("10.0.0.2") is crowd[0]
    assert room.leave(crowd[0]) == "10.0.0.2"
    crowd[0].close()
    assert room.crowded("10.0.0.2") is None


def test_oldest_of_all_goes_when_there_are_too_many(
    room: Pending, enter: Enter, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pending, "MOST", 5)
    waiting = [enter("127.0.0.1") for _ in range(5)]
    assert room.crowded("10.0.0.9") is waiting[0]
    assert room.oldest() is waiting[0]


def test_time_of_each(room: Pending, enter: Enter, monkeypatch: pytest.MonkeyPatch) -> None:
    assert room.left() is None
    monkeypatch.setattr(pending, "TIMEOUT", -1.0)
    late = enter("10.0.0.1")
    monkeypatch.setattr(pending, "TIMEOUT", 60.0)
    enter("10.0.0.1")
    assert room.left() == 0
    assert room.overdue() == [late]
    room.leave(late)
    late.close()
    left = room.left()
    assert left is not None
    assert 50 < left <= 60
