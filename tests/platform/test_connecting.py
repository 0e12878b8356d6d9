"""Connections that are being made: they succeed, fail, last too long, are given up."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack

import pytest
from support.wait import HANG

from yarpy.platform.connecting import Connecting


@pytest.fixture
def full() -> Iterator[tuple[str, int]]:
    """The address of a listener at which connections neither succeed nor fail."""
    with ExitStack() as open_:
        listener = open_.enter_context(socket.create_server(("127.0.0.1", 0), backlog=0))
        address = listener.getsockname()
        while True:
            sock = open_.enter_context(socket.socket())
            sock.settimeout(0.2)
            try:
                sock.connect(address)
            except TimeoutError:
                break
        yield address


def test_it_connects() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener, socket.socket() as sock:
        Connecting(sock, HANG).run(listener.getsockname())
        with listener.accept()[0] as accepted:
            sock.sendall(b"words")
            assert accepted.recv(5) == b"words"
        assert sock.gettimeout() == HANG


def test_nobody_listens() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        address = listener.getsockname()
    with socket.socket() as sock, pytest.raises(ConnectionRefusedError):
        Connecting(sock, HANG).run(address)


def test_time_is_over(full: tuple[str, int]) -> None:
    with socket.socket() as sock, pytest.raises(TimeoutError):
        Connecting(sock, 0.3).run(full)


def test_whoever_waits_is_woken(full: tuple[str, int]) -> None:
    with socket.socket() as sock:
        attempt = Connecting(sock, HANG)
        later = threading.Timer(0.1, attempt.give_up)
        later.start()
        began = time.monotonic()
        with pytest.raises(OSError) as caught:
            attempt.run(full)
        later.join()
        assert not isinstance(caught.value, TimeoutError) and time.monotonic() - began < HANG / 3
