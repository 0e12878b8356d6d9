"""Waits by select: with sockets that never wait, on every system."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import pytest
from support.wait import HANG

from yarpy.transports import polling
from yarpy.transports.polling import Polling

Pair = tuple[socket.socket, socket.socket]
LARGE = bytes(range(256)) * 20_000  # more than a system takes at once


@pytest.fixture
def pair() -> Iterator[Pair]:
    one, other = socket.socketpair()
    one.setblocking(False)
    other.settimeout(HANG)
    with one, other:
        yield one, other


def test_what_has_come_is_returned(pair: Pair) -> None:
    one, other = pair
    other.sendall(b"abc")
    view = memoryview(bytearray(9))
    assert Polling(one).receive(one.recv_into, view) == 3
    assert view[:3] == b"abc"


def test_what_comes_later_is_waited_for(pair: Pair, monkeypatch: pytest.MonkeyPatch) -> None:
    one, other = pair
    waited = threading.Event()

    def call() -> bytes:
        try:
            return one.recv(9)
        except BlockingIOError:
            waited.set()
            raise

    def send() -> None:
        waited.wait(HANG)
        other.sendall(b"abc")

    monkeypatch.setattr(polling, "SLICE", 0.001)
    thread = threading.Thread(target=send)
    thread.start()
    assert Polling(one).receive(call) == b"abc"
    thread.join()


def test_a_time_that_is_over_loses_nothing(pair: Pair) -> None:
    one, other = pair
    waits = Polling(one)
    waits.receiving = 0.01
    with pytest.raises(BlockingIOError):
        waits.receive(one.recv, 9)
    other.sendall(b"abc")
    assert waits.receive(one.recv, 9) == b"abc"


def test_end_and_close_are_seen(pair: Pair) -> None:
    one, other = pair
    other.close()
    assert Polling(one).receive(one.recv, 9) == b""
    one.close()
    with pytest.raises(OSError):
        Polling(one).receive(one.recv, 9)


def test_our_own_shutdown_ends_a_wait(pair: Pair, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where select does not see it."""
    blind = SimpleNamespace(select=lambda *_: ([], [], []))
    monkeypatch.setattr(polling, "select", blind)
    monkeypatch.setattr(polling, "SLICE", 0.0)
    waits = Polling(pair[0])
    assert not waits.wait(reads=True, seconds=0.01)
    threading.Timer(0.01, waits.interrupt).start()
    assert waits.wait(reads=False, seconds=HANG)
    waits.interrupt()  # returns when the timer's has
    assert waits.recv_into(memoryview(bytearray(9))) == 0


def test_nobody_closes_what_another_thread_shuts_down() -> None:
    calls: list[str] = []

    def shutdown(_how: int) -> None:
        closes.start()
        closes.join(0.05)  # it waits, for ever so long
        calls.append("shut down")

    sock: Any = SimpleNamespace(shutdown=shutdown, close=lambda: calls.append("closed"))
    waits = Polling(sock)
    closes = threading.Thread(target=waits.close)
    waits.interrupt()
    closes.join(HANG)
    assert calls == ["shut down", "closed"]


def test_everything_is_sent_as_the_peer_takes_it(pair: Pair) -> None:
    one, other = pair
    came = bytearray()

    def read() -> None:
        while len(came) < 2 * len(LARGE) + 3:
            came.extend(other.recv(1 << 16))

    thread = threading.Thread(target=read)
    thread.start()
    Polling(one).send_all([LARGE, b"", b"abc", LARGE])
    thread.join()
    assert came == LARGE + b"abc" + LARGE


def test_a_peer_that_takes_nothing_has_its_time(pair: Pair) -> None:
    waits = Polling(pair[0])
    waits.sending = 0.01
    with pytest.raises(BlockingIOError):
        waits.send_all([LARGE])
