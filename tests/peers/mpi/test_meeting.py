"""The helper from the side of the port: what it is told, what it says, and what ends it.

The helper is pretended here; `tests/interop/test_mpi.py` has the real one.
"""

from __future__ import annotations

import json
import socket
import sys
import threading
from collections.abc import Iterator

import pytest
from support.wait import wait_until

from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.peers.mpi import meeting
from yarpy.peers.mpi.meeting import LEAVE, Meeting

BEGIN = """
import os, socket, sys
own, met = (socket.socket(fileno=int(word)) for word in sys.argv[1:])
file = own.makefile("rb")
told = file.readline()
"""
ECHO = (
    BEGIN
    + """
own.sendall(b"ok\\n" + told)
while piece := own.recv(1000):
    own.sendall(piece)
"""
)
SAYS = BEGIN + 'own.sendall(b"no \\x1b[2J MPI here\\n")'
DIES = BEGIN + "os.abort()"


@pytest.fixture
def lines() -> Iterator[tuple[socket.socket, socket.socket]]:
    """The TCP connection: our end, the peer's."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        far = socket.create_connection(server.getsockname())
        near, _ = server.accept()
    far.settimeout(20)
    yield near, far
    near.close()
    far.close()


@pytest.fixture(autouse=True)
def allowed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_MPI", "yes")
    monkeypatch.setattr(meeting, "PENALTY", 0.0)


def helped(monkeypatch: pytest.MonkeyPatch, code: str) -> None:
    monkeypatch.setattr(meeting, "_command", lambda: [sys.executable, "-c", code])


def take(end: Meeting, size: int) -> bytes:
    found = bytearray(size)
    view = memoryview(found)
    while view:
        count = end.recv_into(view)
        assert count
        view = view[count:]
    return bytes(found)


@pytest.mark.parametrize("kind", ["mpi", "bcast"])
def test_bytes_go_through_the_helper(
    kind: str, lines: tuple[socket.socket, socket.socket], monkeypatch: pytest.MonkeyPatch
) -> None:
    helped(monkeypatch, ECHO)
    end = Meeting(kind, lines[0], "/in<-/out")
    end.place = "tag#0$x$"
    end.ready()
    told = (json.dumps({"kind": kind, "pair": "/in<-/out", "place": "tag#0$x$"}) + "\n").encode()
    assert take(end, len(told)) == told
    end.send([b"hello ", b"there"])
    assert take(end, 11) == b"hello there"
    assert (end.local, end.remote) == (lines[0].getsockname(), lines[0].getpeername())
    assert end.program.endswith(str(meeting.os.getpid()))
    ours = end.sock.dup()
    end.close()
    with ours:
        ours.settimeout(20)
        ours.shutdown(socket.SHUT_WR)
        assert ours.recv(10) == (LEAVE if kind == "bcast" else b"")


@pytest.mark.parametrize(
    ("code", "why"), [(SAYS, r"no \\x1b\[2J MPI here"), (DIES, "its process has ended")]
)
def test_a_meeting_in_vain_is_told_to_the_peer(
    code: str,
    why: str,
    lines: tuple[socket.socket, socket.socket],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    helped(monkeypatch, code)
    end = Meeting("mpi", lines[0], "/in<-/out")
    with pytest.raises(RemoteProtocolError, match=why):
        end.ready()
    end.close()
    assert lines[1].recv(10) == (b"* no \\x1b[" if code == SAYS else b"* MPI cann")
    wait_until(lambda: not [t for t in threading.enumerate() if t.name == "yarpy MPI helper"])


def test_few_meet_at_a_time(
    lines: tuple[socket.socket, socket.socket], monkeypatch: pytest.MonkeyPatch
) -> None:
    slots = threading.BoundedSemaphore(1)
    monkeypatch.setattr(meeting, "_slots", slots)
    helped(monkeypatch, "raise SystemExit('it was started')")
    end = Meeting("mpi", lines[0], "/in<-/out")
    with slots, pytest.raises(RemoteProtocolError, match="come again"):
        end.ready()
    end.close()
    assert lines[1].recv(100).endswith(b"come again\r\n")


def test_off_unless_the_owner_asks_for_it(
    lines: tuple[socket.socket, socket.socket], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("YARPY_MPI", "")
    with pytest.raises(LocalProtocolError, match="YARPY_MPI=yes"):
        Meeting("mpi", lines[0], "/in<-/out")
