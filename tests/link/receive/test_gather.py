"""One thread reads many silent connections; what it cannot do at once is done by their own."""

from __future__ import annotations

import logging
import socket
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

import pytest
from support.inbound import Owner, linked, message
from support.wait import wait_until

from yarpy.carriers.own.text import TextAck
from yarpy.link.receive.gather import ABLE, MANY, Gather, GatheredTurn
from yarpy.link.receive.inbound import Inbound
from yarpy.wire import framing
from yarpy.wire.stream import LARGE

pytestmark = pytest.mark.skipif(not ABLE, reason="a thread that waits does not see more sockets")

ACK = framing.ACK
SHARED = "yarpy gather"


@contextmanager
def watched(gather: Gather, others: int = 0) -> Iterator[tuple[socket.socket, Inbound, Owner]]:
    """A connection that has brought a message and is watched now."""
    with linked(attend=gather.attend) as (near, link, owner):
        near.sendall(message([0]))
        assert near.recv(8) == ACK
        wait_until(lambda: gather.watched == others + 1)
        yield near, link, owner


def taken(near: socket.socket, count: int) -> None:
    """Wait until so many messages are acknowledged."""
    got = b""
    while len(got) < count * len(ACK):
        got += near.recv(1 << 16)
    assert got == ACK * count


def test_two_connections_are_read_by_one_thread() -> None:
    gather = Gather()
    with watched(gather) as (near, link, owner), watched(gather, 1) as (other, _, theirs):
        for number in range(1, 4):
            near.sendall(message([number], envelope=f"{number} 1.5"))
            taken(near, 1)
            other.sendall(message([-number]) * 2)
            taken(other, 2)
        assert [one.value for one in owner.heard] == [[0], [1], [2], [3]]
        assert owner.heard[3].envelope == "3 1.5"
        assert owner.heard[3].source == "/peer"
        assert owner.threads[0] != SHARED and {*owner.threads[1:]} == {SHARED}
        assert {*theirs.threads[1:]} == {SHARED}
        assert len(theirs.heard) == 7
        assert link.counter.messages == 4
        assert link.counter.drops == 0


def test_many_messages_at_once_are_all_heard_in_order() -> None:
    gather = Gather()
    with watched(gather) as (near, _, owner):
        near.sendall(b"".join(message([number]) for number in range(1, 3 * MANY)))
        taken(near, 3 * MANY - 1)
        assert [one.value for one in owner.heard] == [[number] for number in range(3 * MANY)]
        assert owner.threads[1] == SHARED != owner.threads[-1]


@pytest.mark.parametrize("size", [10, LARGE, 4 * LARGE])
def test_what_comes_in_parts_is_read_by_its_own_thread_and_then_watched_again(
    size: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    gather = Gather()
    with watched(gather) as (near, _, owner):
        data = message(["x" * size])
        near.sendall(data[:11])
        wait_until(lambda: gather.watched == 0)
        near.sendall(data[11:])
        taken(near, 1)
        monkeypatch.setattr("yarpy.link.receive.gather.PAUSE", 0.0)
        wait_until(lambda: _sends(near, [1]) and gather.watched == 1)
        near.sendall(message([2]))
        taken(near, 1)
        assert owner.heard[1].value == ["x" * size]
        assert owner.threads[1] != SHARED
        assert owner.heard[-1].value == [2]
        assert owner.threads[-1] == SHARED


def _sends(near: socket.socket, value: object) -> bool:
    near.sendall(message(value))
    taken(near, 1)
    return True


def test_commands_are_obeyed_by_the_connection_itself() -> None:
    gather = Gather()
    with watched(gather) as (near, _, owner):
        near.sendall(message(["ver"], key="a") + message([1]))
        wait_until(lambda: len(owner.heard) == 2)
        assert owner.threads[1] != SHARED


def test_a_question_is_answered() -> None:
    gather = Gather()
    with watched(gather) as (near, _, owner):
        owner.answer = ["yes"]
        near.sendall(message(["well?"], key="d"))
        assert b"yes" in near.recv(200)


def test_end_by_the_peer_is_that_of_any_connection(caplog: pytest.LogCaptureFixture) -> None:
    gather = Gather()
    with watched(gather) as (near, _, owner):
        near.sendall(message([1]))
        near.shutdown(socket.SHUT_WR)
        wait_until(lambda: owner.ended)
        assert [one.value for one in owner.heard] == [[0], [1]]
        assert owner.ended == [("the peer closed the connection", False)]
        assert gather.watched == 0
    assert caplog.records == []


def test_end_by_us_while_it_is_silent(caplog: pytest.LogCaptureFixture) -> None:
    gather = Gather()
    with watched(gather) as (_, link, owner), watched(gather, 1) as (other, _, theirs):
        link.close()
        wait_until(lambda: owner.ended)
        assert owner.ended == [("", False)]
        other.sendall(message([1]))
        taken(other, 1)
        assert theirs.threads[1] == SHARED
    assert caplog.records == []


def test_broken_rules_are_one_line_in_the_log(caplog: pytest.LogCaptureFixture) -> None:
    gather = Gather()
    with watched(gather) as (near, _, owner):
        near.sendall(framing.INDEX + b"\x01\x01" + b"\xff" * 8 + b"\xff\xff\xff\x7f" + bytes(4))
        wait_until(lambda: owner.ended)
    (record,) = caplog.records
    assert record.levelno == logging.WARNING


def test_who_does_not_read_its_acknowledgements_keeps_nobody_waiting() -> None:
    gather = Gather()
    with watched(gather) as (near, link, owner), watched(gather, 1) as (other, _, theirs):
        link.turn.sock.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1)  # type: ignore[attr-defined]
        sent = 0
        while gather.watched == 2:
            sent += 1
            near.sendall(message([sent]))
            wait_until(lambda sent=sent: len(owner.heard) == sent + 1)  # type: ignore[misc]
        other.sendall(message([1]))
        taken(other, 1)
        assert theirs.threads[1] == SHARED
        taken(near, sent)


def test_an_exception_that_ends_programs_ends_the_connection() -> None:
    gather = Gather()
    with watched(gather) as (near, _, owner), watched(gather, 1) as (other, _, theirs):
        owner.answer = SystemExit()
        near.sendall(message([1]))
        wait_until(lambda: owner.ended)
        other.sendall(message([1]))
        taken(other, 1)
        assert theirs.threads[1] == SHARED


def test_a_priority_is_kept_by_the_thread_that_has_it() -> None:
    gather = Gather()
    with watched(gather) as (near, link, owner):
        link.turn.end()  # as `qos.py` does
        wait_until(lambda: gather.watched == 0)
        assert all(_sends(near, [number]) for number in range(5))
        assert SHARED not in owner.threads
        assert gather.watched == 0


def test_what_cannot_be_read_in_one_go_is_let_be() -> None:
    found = []

    def attend(link: Inbound) -> None:
        Gather().attend(link)
        found.append(isinstance(link.turn, GatheredTurn))

    def guarded(link: Inbound) -> None:
        link.guarded = True
        attend(link)

    with ExitStack() as stack:
        stack.enter_context(linked(attend=attend))
        stack.enter_context(linked(attend=guarded))
        stack.enter_context(linked(TextAck, attend))
    assert found == [True, False, TextAck.limits.idle_timeout is None]


def test_its_thread_ends_with_the_last_connection() -> None:
    gather = Gather()
    before = {*threading.enumerate()}
    for _ in range(2):
        with watched(gather) as (near, _, owner):
            near.sendall(message([1]))
            taken(near, 1)
            assert owner.threads[1] == SHARED
        wait_until(lambda: {*threading.enumerate()} <= before)
