"""Sending in the thread that wrote a message."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

import pytest
from support.build import changes_a_constant
from support.cut import ALL_SEEN, cut_at
from support.outbound import at_work, connected, open_link, read_messages, total
from support.wait import HANG

from yarpy.carriers.own.tcp import FastTcp, Tcp
from yarpy.link.ending import NEVER, NOW, moment
from yarpy.link.send import direct
from yarpy.link.send.outbound import Outbound
from yarpy.link.send.outbox import Rest
from yarpy.wire.message import Packet

LARGE = ["x" * 20_000_000]


def test_what_takes_waiting_comes_back_and_is_offered_again() -> None:
    with connected(Tcp) as (link, far), at_work(link):
        rest = link.box.offer(Packet([1]), NOW)
        assert isinstance(rest, Rest)
        assert rest.offer(NOW) is not True
        assert total(link) == 0
        assert rest.offer(time.monotonic() + 0.01) is False
        assert link.counter.drops == 1
    with connected(Tcp) as (link, far):
        rest = link.box.offer(Packet(LARGE), NOW)
        assert isinstance(rest, Rest)
        assert rest.offer(NOW) is rest, "a part has left, and the rest has to"
        assert rest.offer(moment(0.01)) is True, "it follows by itself"
        assert link.counter.messages == 1
        far.close()


@changes_a_constant
def test_at_once_is_behind_the_flusher_which_takes_no_longer_than_a_moment(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(direct, "MOMENT", HANG)  # moments are long on a busy computer
    with connected(FastTcp) as (link, far):
        with at_work(link):
            link.sender.draining = True
            later = threading.Thread(target=link.box.offer, args=(Packet([1]), NOW))
            later.start()
            time.sleep(0.02)
        later.join(HANG)
        link.sender.draining = False
        assert total(link) == 1 and link.counter.drops == 0
        assert len(read_messages(far, 1, ack=False)) == 1


def test_a_rest_that_nobody_comes_back_for() -> None:
    with connected(Tcp) as (link, _), at_work(link):
        rest = link.box.offer(Packet([1]), NOW)
        assert isinstance(rest, Rest)
        rest.leave()
        assert link.counter.drops == 1


def test_a_message_that_interrupts_another_one_of_its_thread_is_dropped(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """As in a signal handler: it would wait for itself."""
    link, transport = open_link(FastTcp)
    with link.sender.lock:
        assert link.box.offer(Packet([1])) is False
        assert link.box.offer(Packet([1]), moment(5)) is False
    assert link.counter.drops == 2
    assert transport.said == b""
    assert "interrupted another write" in caplog.text
    assert link.box.offer(Packet([1])) is True


ACTS: dict[str, Callable[[Outbound], object]] = {
    "write": lambda link: link.box.offer(Packet([1]), moment(5)),
    "try": lambda link: link.box.offer(Packet([1]), NOW),
    "newest": lambda link: link.box.offer(Packet([1])),
    "whole": lambda link: link.sender.send_whole(b"abc"),
    "finish": lambda link: link.sender.finish(moment(5)),
    "flush": lambda link: link.wait_sent(moment(5)),
    "look": lambda link: link.sender.look(),
    "acknowledged": lambda link: link.wait_acknowledged(moment(0.01)),
    "interject": lambda link: link.sender.interject(b""),
}


@pytest.mark.parametrize("name", ACTS)
def test_a_signal_handler_that_raises_anywhere_gives_the_lock_back(name: str) -> None:
    """Else every other thread would wait for this one, which has gone on, for ever."""
    number, there = 0, True
    while there or number < 2:  # the second time Python 3.13 shows more
        number += 1
        link, _ = open_link(FastTcp if name == "whole" else Tcp)
        if name == "newest":
            link.join(NEVER, newest=True)
        files = ("send/direct.py", "send/lossy.py", "send/sender.py", "send/outbound.py")
        there = cut_at(number, lambda link=link: ACTS[name](link), *files, "link/ending.py")
        assert not link.sender.held(), number
        if link._queue is not None:
            link._queue.stop()
    assert number > 3 or not ALL_SEEN
