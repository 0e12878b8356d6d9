"""A listener of a test: it serves, holds what it took, and leaves neither thread nor socket."""

from __future__ import annotations

import gc
import socket

import pytest
from support import held
from support.listener import listening


def test_each_connection_is_served_and_kept() -> None:
    with listening(lambda sock: sock.sendall(b"hello")) as (port, taken):
        for count in (1, 2):
            with socket.create_connection(("127.0.0.1", port)) as sock:
                assert sock.recv(5) == b"hello"
            assert len(taken) == count
    assert [sock.fileno() for sock in taken] == [-1, -1]


def test_nobody_is_taken_after_the_end() -> None:
    before = held.threads()
    with listening() as (port, taken):
        pass
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection(("127.0.0.1", port))
    gc.collect()  # a socket that nobody has closed would be told
    assert taken == []
    assert held.threads() <= before


def test_whoever_is_being_served_is_woken() -> None:
    with listening(lambda sock: sock.recv(1)) as (port, taken):
        held = socket.create_connection(("127.0.0.1", port))
    held.close()
    assert len(taken) <= 1
