"""Programs of this computer, as the system sees them."""

from __future__ import annotations

import os
import socket

import pytest

from yarpy.kits.doctor import process

pytestmark = pytest.mark.skipif(not process.PROC.exists(), reason="this system has no /proc")


def test_who_listens_and_what_lies_unread() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        assert process.listener(port) == os.getpid()
        with socket.create_connection(("127.0.0.1", port)) as peer:
            accepted = server.accept()[0]
            assert process.unread(port) == 0
            peer.sendall(b"x" * 100)
            assert process.unread(port) == 100
            assert accepted.recv(200)
            peer.shutdown(socket.SHUT_WR)
            assert accepted.recv(1) == b""
            assert process.unread(port) == 0
            accepted.close()
    assert process.listener(port) == 0


def test_a_process() -> None:
    pid = os.getpid()
    assert process.state(pid) in ("R", "S")
    assert process.state(0) == process.command(0) == ""
    assert len(process.command(pid)) <= 60
    assert process.open_files(pid)
    assert process.open_files(0) is None
    assert (process.limit(pid, "Max open files") or 1) > 0
    assert process.limit(0, "Max open files") is None
    assert process.setting("net/core/no_such") is None
