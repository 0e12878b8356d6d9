"""Sending the newest message only."""

from __future__ import annotations

import math
import time

import pytest
from support.outbound import connected, open_link, read_messages
from support.wait import HANG, wait_until

from yarpy.carriers.own.tcp import Tcp
from yarpy.link.ending import NEVER, moment
from yarpy.link.send import lossy
from yarpy.link.send.sender import BURST
from yarpy.wire import framing
from yarpy.wire.message import Packet


def test_newest_message_wins() -> None:
    with connected(Tcp) as (link, far):
        link.join(NEVER, newest=True)
        assert link.box.offer(Packet([1])) is True
        assert [link.box.offer(Packet([number])) for number in range(9)] == [False] * 9
        assert (link.counter.messages, link.counter.replaced) == (1, 9)
        read_messages(far, 1)
        wait_until(lambda: link.box.offer(Packet([2])))
        link.sender.window.until = math.inf  # a busy machine is slow, not its peer
        assert link.reliable.offer(Packet([3]), moment(HANG)) is True, "one behind the other"
        read_messages(far, 2)


def test_a_reader_that_acknowledges_at_once_is_sent_more_at_a_time() -> None:
    with connected(Tcp) as (link, far):
        link.join(NEVER, newest=True)
        window = link.sender.window
        deepest = 0
        until = time.monotonic() + HANG
        while deepest < 2 and time.monotonic() < until:  # a busy machine may take a while once
            sent = sum(link.box.offer(Packet([1])) is True for _ in range(2))
            deepest = max(deepest, window.open)
            read_messages(far, sent)
        assert deepest >= 2


def test_a_quick_reader_is_not_looked_at_for_every_message() -> None:
    """Which would also send what is gathered, each time."""
    link, transport = open_link(Tcp)
    link.join(NEVER, newest=True)
    link.sender.window._most = 8
    looks = []
    transport.try_recv_into = lambda view: looks.append(1) or -1  # type: ignore[method-assign,func-returns-value]
    assert link.box.offer(Packet([0])) is True
    link.sender.window.until = math.inf
    assert [link.box.offer(Packet([number])) for number in range(1, 8)] == [True] * 7
    assert not looks
    assert link.box.offer(Packet(["too many"])) is False
    assert looks


def test_a_flooding_writer_gives_way_to_a_quick_reader(monkeypatch: pytest.MonkeyPatch) -> None:
    """It may be a thread of the same program."""
    link, transport = open_link(Tcp)
    link.join(NEVER, newest=True)
    sender, naps, real = link.sender, [], time.sleep

    def sleep(seconds: float) -> None:
        if seconds != lossy.GIVEN:  # of other threads
            real(seconds)
            return
        naps.append(seconds)
        if len(naps) == 1:
            transport.incoming.append(framing.ACK)

    monkeypatch.setattr(lossy.time, "sleep", sleep)
    assert link.box.offer(Packet([1])) is True
    assert link.box.offer(Packet([2])) is False, "nobody knows that it is quick"
    assert not naps
    sender.window._most, sender._rush, sender.window.until = 2, BURST, math.inf
    sender.window.open += 1
    assert link.box.offer(Packet([3])) is True, "an acknowledgement has come meanwhile"
    assert len(naps) == 1
    sender._rush, sender.window.until = BURST, math.inf
    for _ in range(100):
        assert link.box.offer(Packet([4])) is False
    assert len(naps) == 1 + lossy.IN_VAIN, "it is not quick any more"
    assert link.counter.replaced == 101
