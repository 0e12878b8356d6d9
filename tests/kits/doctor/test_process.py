"""Programs of this computer, as the system sees them."""

from __future__ import annotations

import os
import socket
import sys

import pytest
from support.system import NO_OWNERS

from yarpy.kits.doctor import process

linux_only = pytest.mark.skipif(
    sys.platform != "linux", reason="only Linux, by /proc, says that of programs"
)


@pytest.mark.skipif(bool(NO_OWNERS), reason=NO_OWNERS)
def test_who_listens() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        assert process.listener(port) == os.getpid()
        assert port in {one.local for one in process.sockets() if one.listens}
    assert process.listener(port) == 0


@linux_only
def test_what_lies_unread() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
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


@pytest.mark.skipif(sys.platform == "darwin", reason="macOS says it by ps alone")
def test_what_a_process_runs() -> None:
    assert "python" in process.command(os.getpid())
    assert len(process.command(os.getpid())) <= 60
    assert process.command(0) == ""


@linux_only
def test_a_process() -> None:
    pid = os.getpid()
    assert process.state(pid) in ("R", "S")
    assert process.state(0) == ""
    assert process.open_files(pid)
    assert process.open_files(0) is None
    assert (process.limit(pid, "Max open files") or 1) > 0
    assert process.limit(0, "Max open files") is None
    assert process.setting("net/core/no_such") is None
