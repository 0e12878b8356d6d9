"""The helper: what it hands on, and how it ends. MPI is pretended."""

from __future__ import annotations

import json
import socket
import threading
from collections.abc import Sequence

import pytest
from support.wait import HANG

from yarpy.errors import LocalProtocolError
from yarpy.peers.mpi import helper
from yarpy.wire.stream import Buffer


class End:
    """An end in MPI that gives back what it gets."""

    def __init__(self) -> None:
        self.place = ""
        self.closed = threading.Event()
        self._near, self._far = socket.socketpair()

    def ready(self) -> None:
        if self.place == "nowhere":
            raise LocalProtocolError("MPI says\nno")

    def send(self, buffers: Sequence[Buffer]) -> None:
        for buffer in buffers:
            self._near.sendall(buffer)

    def recv_into(self, view: memoryview) -> int:
        return self._far.recv_into(view)

    def close(self) -> None:
        self._near.close()
        self.closed.set()


def begun(monkeypatch: pytest.MonkeyPatch, place: str) -> tuple[socket.socket, End, list[object]]:
    """The program's end of the socket, the end in MPI, and what was asked for."""
    end = End()
    asked: list[object] = []

    def open_end(kind: str, listen: bool, sock: socket.socket, pair: str) -> End:
        asked.extend((kind, listen, pair))
        return end

    monkeypatch.setattr(helper, "open_end", open_end)
    ours, own = socket.socketpair()
    ours.settimeout(20)
    line, other = socket.socketpair()
    other.close()
    told = {"kind": "mpi", "pair": "/in<-/out", "place": place}
    ours.sendall(json.dumps(told).encode() + b"\n")
    thread = threading.Thread(target=helper.main, args=(own.detach(), line.detach()), daemon=True)
    thread.start()
    return ours, end, asked


def test_bytes_both_ways_and_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    ours, end, asked = begun(monkeypatch, "tag#0$")
    with ours, ours.makefile("rb") as file:
        assert file.readline() == b"ok\n"
        assert asked == ["mpi", True, "/in<-/out"]
        assert end.place == "tag#0$"
        ours.sendall(b"hello")
        assert file.read(5) == b"hello"
        ours.shutdown(socket.SHUT_WR)
        assert end.closed.wait(HANG)
        assert file.read() == b""
    end._far.close()


def test_why_it_cannot_meet(monkeypatch: pytest.MonkeyPatch) -> None:
    ours, end, _ = begun(monkeypatch, "nowhere")
    with ours, ours.makefile("rb") as file:
        assert file.read() == b"MPI says no\n"
    end._near.close()
    end._far.close()
