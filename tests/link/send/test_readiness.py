"""Readiness: the first reader that takes more ends the wait."""

from __future__ import annotations

import socket
import threading
from contextlib import suppress
from types import SimpleNamespace
from typing import Any

import pytest

from yarpy.link.send import readiness
from yarpy.link.send.readiness import wait_for_any


def link(sock: socket.socket | None, halfway: bool) -> Any:
    transport = SimpleNamespace(sock=sock)
    return SimpleNamespace(
        driver=SimpleNamespace(transport=transport), sender=SimpleNamespace(halfway=halfway)
    )


def filled() -> tuple[socket.socket, socket.socket]:
    """A pair, the first of which cannot send any more."""
    one, other = socket.socketpair()
    one.setblocking(False)
    try:
        while True:
            one.send(bytes(1 << 16))
    except BlockingIOError:
        return one, other


def empty(sock: socket.socket) -> None:
    """Take all that has come."""
    sock.setblocking(False)
    with suppress(BlockingIOError):
        while sock.recv(1 << 20):
            pass


def test_room_for_the_rest_of_a_message() -> None:
    one, other = filled()
    with one, other:
        assert not wait_for_any([link(one, True)], 0.01)
        timer = threading.Timer(0.05, empty, (other,))
        timer.start()
        assert wait_for_any([link(one, True)], 30)
        timer.join()


def test_an_acknowledgement() -> None:
    one, other = socket.socketpair()
    with one, other:
        assert not wait_for_any([link(one, False)], 0.01)
        other.send(b"ack")
        assert wait_for_any([link(None, True), link(one, False)], 30)


def test_the_end_of_a_reader() -> None:
    one, other = filled()
    with one:
        other.close()
        assert wait_for_any([link(one, True)], 30)


def test_what_has_no_socket_is_looked_at_again(monkeypatch: pytest.MonkeyPatch) -> None:
    one, other = socket.socketpair()
    other.close()
    one.close()
    slept: list[float] = []
    monkeypatch.setattr(readiness, "time", SimpleNamespace(sleep=slept.append))
    assert not wait_for_any([link(None, True), link(one, True)], 0.02)
    assert slept == [0.02]
