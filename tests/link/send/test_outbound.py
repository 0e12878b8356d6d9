"""Outbound links: questions, sending in the background, ends and goodbyes."""

from __future__ import annotations

import threading
import time

import pytest
from support.lasted import lasted
from support.outbound import at_work, connected, open_link, read_messages, total
from support.wait import HANG, wait_until

from yarpy.carriers.base import Carrier, Delivery
from yarpy.carriers.own.tcp import FastTcp, Tcp
from yarpy.carriers.own.text import Text
from yarpy.errors import LinkClosed
from yarpy.link.ending import NEVER, moment
from yarpy.link.send import outbound as module
from yarpy.wire import framing
from yarpy.wire.message import Packet

ACK = framing.ACK


# --------------------------------------------------------------------------------- acknowledgements


def test_waiting_for_acknowledgements() -> None:
    with connected() as (link, far):
        link.send(Packet([1]))
        assert not link.wait_acknowledged(moment(0.05))
        assert not link.broken
        read_messages(far, 1)
        assert link.wait_acknowledged(moment(5))
        assert link.sender.window.open == 0
        far.close()
        with pytest.raises(LinkClosed):
            link.send(Packet([2]))
            link.send(Packet([3]))
            assert link.wait_acknowledged(moment(5))
        assert link.broken


# -------------------------------------------------------------------------------- failures, counted


def test_end_of_the_peer_is_noticed_without_sending() -> None:
    with connected() as (link, far):
        assert not link.ended()
        link.send(Packet([1]))
        read_messages(far, 1)
        far.close()
        wait_until(link.ended)
        assert link.counter.messages == 1  # it was acknowledged, though nobody had looked
        assert link.counter.drops == 0


def test_end_behind_unread_acknowledgements_is_noticed() -> None:
    with connected() as (link, far):
        for number in range(5):  # nobody waits for an acknowledgement that has come
            link.send(Packet([number]))
            read_messages(far, 1)
        assert link.sender.window.open
        far.close()
        wait_until(link.ended)
        assert link.broken
        assert link.counter.messages == 5


# -------------------------------------------------------------------------------- in the background


def test_background_link_drops_what_comes_too_early() -> None:
    with connected() as (link, far):
        link.join(NEVER, newest=True)
        link.start_background()
        taken = sum(link.send(Packet([number])) for number in range(50))
        wait_until(lambda: link.counter.messages == taken)
        assert 1 <= taken < 50
        assert link.counter.replaced == 50 - taken
        read_messages(far, taken)
        wait_until(lambda: link.send(Packet([1])))
        assert link.wait_sent(moment(5))
        assert link.counter.messages == taken + 1


class Untouched:
    """A value that must not be encoded."""

    def to_wire(self) -> tuple[bytes]:
        raise AssertionError("it is dropped, so it need not be encoded")


@pytest.mark.parametrize("carrier", [Tcp, FastTcp, Text])
def test_message_that_is_dropped_costs_no_encoding(carrier: type[Carrier]) -> None:
    with connected(carrier) as (link, _):
        link.join(NEVER, newest=True)
        link.start_background()
        with at_work(link):
            assert link.send(Packet([0]))
            assert not link.send(Packet(Untouched()))
        assert link.counter.replaced == 1


def test_background_link_can_send_every_message() -> None:
    with connected() as (link, far):
        link.start_background()
        reader = threading.Thread(target=read_messages, args=(far, 100))
        reader.start()
        for number in range(100):
            link.send(Packet([number]))
        assert link.wait_sent(moment(5))
        reader.join(HANG)
        assert not reader.is_alive()
        assert link.counter.messages == 100
        assert link.counter.drops == 0


def test_background_link_whose_peer_goes() -> None:
    with connected() as (link, far):
        link.start_background()
        far.close()
        attempts = 0
        with pytest.raises(LinkClosed):
            for number in range(100_000):
                attempts += 1
                link.send(Packet([number]))
        assert link.thread is not None
        link.thread.join(HANG)
        assert not link.thread.is_alive()
        assert total(link) == attempts


def test_drain_has_a_limit() -> None:
    with connected() as (link, _):
        link.start_background()
        link.send(Packet([bytes(10_000_000)]))
        started = time.monotonic()
        assert not link.wait_sent(moment(0.05))
        assert lasted(started) < 10
        link.driver.transport.interrupt()


# ---------------------------------------------------------------------------------- goodbye


def test_goodbye_is_acknowledged() -> None:
    link, transport = open_link(Tcp, ACK)
    link.close()
    assert transport.said == framing.QUIT
    assert transport.closed
    link.close()
    assert transport.said == framing.QUIT


def test_goodbye_to_a_peer_that_does_not_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "CLOSE_TIMEOUT", 0.05)
    with connected() as (link, far):
        link.send(Packet([1]))
        started = time.monotonic()
        link.close()
        assert lasted(started) < 10
        assert link.counter.messages == 0
        assert link.counter.unconfirmed == 1  # never acknowledged
        assert link.counter.drops == 0
        assert far.recv(1000)


@pytest.mark.parametrize("background", [False, True])
def test_link_to_a_peer_that_takes_nothing_can_be_closed(
    background: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whoever is stuck in sending is freed, and gets an error."""
    monkeypatch.setattr(module, "CLOSE_TIMEOUT", 0.1)
    with connected(FastTcp) as (link, _):
        if background:
            link.start_background()
        ended: list[Exception] = []

        def write() -> None:
            try:
                for _ in range(3):
                    link.send(Packet([bytes(10_000_000)]))
            except LinkClosed as error:
                ended.append(error)

        writer = threading.Thread(target=write)
        writer.start()
        time.sleep(0.1)
        started = time.monotonic()
        link.close()
        assert lasted(started) < 10
        writer.join(HANG)
        assert len(ended) == 1
        assert link.counter.messages == 0


def test_goodbye_waits_for_what_is_on_its_way() -> None:
    with connected() as (link, far):
        link.start_background()

        def say() -> None:  # it waits while the window is full: until somebody reads
            for number in range(5):
                link.send(Packet([number]))
            link.close()

        thread = threading.Thread(target=say)
        thread.start()
        found = read_messages(far, 5)
        assert len(found) == 5
        assert far.recv(1000) == framing.QUIT
        far.sendall(ACK)
        thread.join(HANG)
        assert link.counter.messages == 5
        assert link.counter.drops == 0


# ---------------------------------------------------------------------------------- onlookers


class Shown(FastTcp):
    """A carrier for people who look on: they miss messages rather than hold a writer up."""

    name = "shown"
    delivery = Delivery(lossy=True, backlog=4)


def test_stalled_reader_of_a_lossy_carrier_costs_its_writer_nothing() -> None:
    with connected(Shown) as (link, _):
        started = time.monotonic()
        for _ in range(30):
            link.send(Packet([bytes(1 << 20)]))
        link.wait_acknowledged()
        assert lasted(started) < 10
        assert link.counter.replaced > 10
        link.driver.transport.interrupt()
        wait_until(lambda: link.broken)
        with pytest.raises(LinkClosed):
            link.send(Packet([1]))


def test_reader_of_a_lossy_carrier_gets_a_short_burst_whole() -> None:
    with connected(Shown) as (link, far):
        with at_work(link):
            link.send(Packet([0]))
            wait_until(lambda: link._queue is not None and link._queue._busy)
            for number in range(1, 7):
                link.send(Packet([number]))
        found = read_messages(far, 5, ack=False)
        assert found == [b"".join(framing.encode(Packet([n]))) for n in range(5)]  # type: ignore[arg-type]
        assert link.counter.replaced == 2
