"""The last messages wait for a reader that is behind."""

from __future__ import annotations

import threading
import time

import pytest
from support.lasted import lasted
from support.outbound import connected, read_messages, total
from support.wait import HANG, wait_until

from yarpy.carriers.own.tcp import FastTcp
from yarpy.errors import LinkClosed
from yarpy.link.ending import moment
from yarpy.wire.message import Packet

LARGE = "x" * 4_000_000


def test_who_is_quick_gets_everything_in_order_in_the_writers_thread() -> None:
    with connected(FastTcp) as (link, far):
        link.keep(3)
        for number in range(50):
            assert link.box.offer(Packet([number])) is True
        assert link.thread is None
        assert len(set(read_messages(far, 50, ack=False))) == 50
        assert link.counter.messages == 50


def test_a_writer_never_waits_and_the_oldest_gives_way() -> None:
    with connected(FastTcp) as (link, far):
        link.keep(3)
        begun = time.monotonic()
        for number in range(20):
            assert link.box.offer(Packet([number, LARGE])) is True
        assert lasted(begun) < 10.0
        queue = link._queue
        assert queue is not None
        assert len(queue._waiting) == 3
        assert [packet.value[0] for packet, _ in queue._waiting] == [17, 18, 19]
        # All but what the system has taken, which may be a message or two more.
        assert link.counter.replaced >= 12

        def read() -> None:
            while far.recv(1 << 20):
                pass

        reading = threading.Thread(target=read)
        reading.start()
        assert link.wait_sent(moment(HANG))
        assert link.counter.messages + link.counter.replaced == total(link) == 20
        link.driver.transport.interrupt()
        reading.join(HANG)


def test_what_waits_at_the_end_is_counted() -> None:
    with connected(FastTcp) as (link, _):
        link.keep(3)
        for number in range(20):
            link.box.offer(Packet([number, LARGE]))
        link.close(until=moment(0.1))
        wait_until(lambda: total(link) == 20)
        assert link.counter.drops >= 3
        with pytest.raises(LinkClosed):
            link.box.offer(Packet([1]))
