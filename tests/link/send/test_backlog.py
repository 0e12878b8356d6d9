"""The first messages wait for a reader that is behind, up to a number and a size."""

from __future__ import annotations

import threading
import time

import pytest
from support.build import changes_a_constant
from support.lasted import lasted
from support.outbound import connected, read_messages, total
from support.wait import HANG, wait_until

from yarpy.carriers.base import Delivery
from yarpy.carriers.own.tcp import FastTcp
from yarpy.errors import LinkClosed
from yarpy.link.ending import moment
from yarpy.link.send import backlog
from yarpy.link.send.backlog import Backlog
from yarpy.link.send.slow_reader import STRANGERS
from yarpy.wire.message import Packet

LARGE = "x" * 4_000_000


class Held(FastTcp):
    name = "held"
    delivery = Delivery(lossy=True, at_once=True, backlog=3, held=1 << 26)


class HeldBytes(FastTcp):
    name = "held_bytes"
    delivery = Delivery(lossy=True, at_once=True, backlog=1000, held=9_000_000)


def test_who_is_quick_gets_everything_in_the_writers_thread() -> None:
    with connected(Held) as (link, far):
        assert isinstance(link.box, Backlog)
        for number in range(50):
            assert link.box.offer(Packet([number])) is True
        assert link.thread is None
        assert len(set(read_messages(far, 50, ack=False))) == 50


@changes_a_constant
def test_it_leaves_at_once_though_another_thread_is_at_the_connection_for_a_moment(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """As the flusher of a burst."""
    monkeypatch.setattr(backlog, "MOMENT", HANG)  # moments are long on a busy computer
    with connected(Held) as (link, far):
        taken = threading.Event()

        def work() -> None:
            with link.sender.lock:
                taken.set()
                time.sleep(0.002)

        for number in range(5):
            taken.clear()
            thread = threading.Thread(target=work)
            thread.start()
            assert taken.wait(HANG)
            assert link.box.offer(Packet([number])) is True
            thread.join()
        assert link.thread is None
        assert len(set(read_messages(far, 5, ack=False))) == 5


@pytest.mark.parametrize(("kind", "most"), [(Held, 3), (HeldBytes, 2)])
def test_a_writer_never_waits_and_the_newest_is_dropped(kind: type[FastTcp], most: int) -> None:
    with connected(kind) as (link, far):
        begun = time.monotonic()
        sent = [link.box.offer(Packet([number, LARGE])) for number in range(20)]
        assert lasted(begun) < STRANGERS
        kept = [number for number, left in enumerate(sent) if left]
        # One is being sent, and the system takes one or two: the first find room, in their order.
        assert kept[:most] == list(range(most))
        assert len(kept) <= most + 3
        assert link.counter.drops == 20 - len(kept)
        got = bytearray()

        def read() -> None:
            while part := far.recv(1 << 20):
                got.extend(part)

        reading = threading.Thread(target=read)
        reading.start()
        assert link.wait_sent(moment(HANG))
        assert link.box.offer(Packet([77])) is True  # there is room again, and no size is left over
        assert link.counter.messages + link.counter.drops == total(link) == 21
        wait_until(lambda: len(got) > len(kept) * len(LARGE))
        link.driver.transport.interrupt()
        reading.join(HANG)


def test_what_waits_at_the_end_is_counted() -> None:
    with connected(Held) as (link, _):
        for number in range(10):
            link.box.offer(Packet([number, LARGE]))
        link.close(until=moment(0.1))
        assert total(link) == 10
        with pytest.raises(LinkClosed):
            link.box.offer(Packet([1]))
        assert total(link) == 11
