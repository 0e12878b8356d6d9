"""Connections that wait for the next command: which are lent, and which are closed."""

from __future__ import annotations

import gc
import os
import socket
from collections.abc import Iterator
from typing import Literal

import pytest

from yarpy.names import idle_lines
from yarpy.names.idle_lines import SPARE, IdleLines
from yarpy.names.line import Line, LineSocket


class Made:
    """Lines over pairs of sockets."""

    def __init__(self) -> None:
        self.peers: list[socket.socket] = []

    def line(self, kind: Literal["lines", "acked"] = "lines") -> Line:
        ours, theirs = socket.socketpair()
        self.peers.append(theirs)
        return Line(LineSocket(fileno=ours.detach()), kind)


@pytest.fixture
def made() -> Iterator[Made]:
    made = Made()
    yield made
    for peer in made.peers:
        peer.close()


def closed(line: Line) -> bool:
    return line.connection.fileno() < 0


def test_a_connection_is_lent_to_one_command_at_a_time(made: Made) -> None:
    idle, line = IdleLines(), made.line()
    assert idle.borrow("lines") is None
    idle.give_back(line)
    assert idle.borrow("acked") is None
    assert idle.borrow("lines") is line and idle.borrow("lines") is None
    line.close()


def test_the_one_used_last_is_lent_first(made: Made) -> None:
    idle, lines = IdleLines(), [made.line(), made.line()]
    for line in lines:
        idle.give_back(line)
    assert idle.borrow("lines") is lines[1] and idle.borrow("lines") is lines[0]
    for line in lines:
        line.close()


def test_so_many_of_each_kind_are_kept(made: Made) -> None:
    idle, lines = IdleLines(), [made.line() for _ in range(SPARE + 1)]
    acked = made.line("acked")
    for line in (*lines, acked):
        idle.give_back(line)
    assert idle.kinds == ["lines"] * SPARE + ["acked"]
    assert [closed(line) for line in lines] == [False] * SPARE + [True]
    idle.close()
    assert all(map(closed, (*lines, acked))) and idle.kinds == []


def test_a_reply_that_was_not_read_to_its_end_closes_it(made: Made) -> None:
    idle, line = IdleLines(), made.line()
    made.peers[-1].sendall(b"one\ntwo\n")
    assert line.line() == "one"
    idle.give_back(line)
    assert closed(line) and idle.kinds == []


def test_what_is_old_or_of_a_parent_is_closed(made: Made, monkeypatch: pytest.MonkeyPatch) -> None:
    idle, line = IdleLines(), made.line()
    idle.give_back(line)
    with monkeypatch.context() as patch:
        patch.setattr(os, "getpid", lambda: 1)
        assert idle.borrow("lines") is None and closed(line)
    line = made.line()
    idle.give_back(line)
    monkeypatch.setattr(idle_lines, "IDLE", -1.0)
    assert idle.borrow("lines") is None and closed(line)


def test_nobody_has_to_close_what_waits(made: Made) -> None:
    idle = IdleLines()
    idle.give_back(made.line())
    del idle
    assert made.peers[0].recv(1) == b""


def test_nor_where_garbage_is_collected(made: Made, recwarn: pytest.WarningsRecorder) -> None:
    """The socket, which warns of not being closed, may be looked at before what keeps it."""
    line = made.line()
    idle = IdleLines()  # looked at in the order in which they were made
    idle.give_back(line)
    vars(idle)["itself"] = idle
    del line, idle
    gc.collect()
    assert made.peers[0].recv(1) == b"" and not recwarn.list
