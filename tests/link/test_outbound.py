"""Outbound links: questions, sending in the background, ends and goodbyes."""

from __future__ import annotations

import threading
import time
from contextlib import suppress
from typing import Any

import pytest
from support.outbound import connected, link_on, open_link, read_messages, total
from support.transport import scripted
from support.wait import wait_until

from yarpy.carriers.base import Carrier, Delivery, Limits
from yarpy.carriers.tcp import FastTcp, Tcp
from yarpy.carriers.text import Text, TextAck
from yarpy.carriers.udp import Udp
from yarpy.data.bottle import Bottle
from yarpy.errors import LinkClosed, LocalProtocolError, RemoteProtocolError, Timeout
from yarpy.link import outbound as module
from yarpy.link.budget import Budget
from yarpy.wire import framing
from yarpy.wire.message import CALL, Packet

ACK = framing.ACK


# --------------------------------------------------------------------------------- acknowledgements


def test_waiting_for_acknowledgements() -> None:
    with connected() as (link, far):
        link.send(Packet([1]))
        with pytest.raises(Timeout):
            link.wait_acknowledged(0.05)
        assert not link.broken
        read_messages(far, 1)
        link.wait_acknowledged(5)
        assert link.sender.window.open == 0
        far.close()
        with pytest.raises(LinkClosed):
            link.send(Packet([2]))
            link.send(Packet([3]))
            link.wait_acknowledged(5)
        assert link.broken


# ---------------------------------------------------------------------------------- calling


def test_question_and_answer() -> None:
    reply = Bottle(["ok", 1]).to_bytes()
    link, transport = open_link(Tcp, reply + ACK)
    message = link.call(Packet(["ask"], key=CALL), 5)
    assert message is not None
    assert message.value == ["ok", 1]
    assert message.source == "/peer"
    assert link.counter.latency > 0
    assert transport.said == b"".join(framing.encode(Packet(["ask"], key=CALL)))  # type: ignore[arg-type]


def test_question_without_an_answer() -> None:
    link, _ = open_link(Tcp, ACK)
    assert link.call(Packet(["ask"], key=CALL), 5) is None
    link, _ = open_link(TextAck, b"<ACK>\r\n")
    assert link.call(Packet(["ask"], key=CALL), 5) is None


def test_acknowledgements_of_earlier_messages_come_first() -> None:
    reply = Bottle(["ok"]).to_bytes()
    link, _ = open_link(Tcp, ACK * 3 + reply + ACK)
    for number in range(3):
        link.send(Packet([number]))
    message = link.call(Packet(["ask"], key=CALL), 5)
    assert message is not None
    assert message.value == ["ok"]


def test_question_that_is_not_taken_has_its_limit_too() -> None:
    with connected(FastTcp) as (link, _):
        with pytest.raises(Timeout):
            link.call(Packet("x" * 20_000_000, key=CALL), 0.2)
        assert link.broken


def test_answer_that_is_late_never_answers_the_next_question() -> None:
    with connected() as (link, far):
        with pytest.raises(Timeout, match="did not reply within"):
            link.call(Packet(["slow"], key=CALL), 0.05)
        assert link.broken
        with pytest.raises(LinkClosed):
            link.call(Packet(["next"], key=CALL), 0.05)
        assert far.recv(1000)
        while far.recv(1000):
            pass  # our side has hung up


def test_one_way_carrier_answers_nothing() -> None:
    link, _ = open_link(Udp)
    with pytest.raises(LocalProtocolError, match="connect to"):
        link.call(Packet([1], key=CALL))


def test_server_that_hangs_up() -> None:
    link = link_on(scripted(Bottle(["half"]).to_bytes()[:5]), Tcp)
    with pytest.raises(LinkClosed):
        link.call(Packet(["ask"], key=CALL), 5)
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
        for number in range(5):
            link.send(Packet([number]))
        read_messages(far, 5)
        assert link.sender.window.open
        far.close()
        wait_until(link.ended)
        assert link.broken
        assert link.counter.messages == 5


# -------------------------------------------------------------------------------- in the background


def test_background_link_drops_what_comes_too_early() -> None:
    with connected() as (link, far):
        taken = sum(link.try_send(Packet([number])) for number in range(50))
        wait_until(lambda: link.counter.messages == taken)
        assert 1 <= taken < 50
        assert link.counter.drops == 50 - taken
        read_messages(far, taken)
        wait_until(lambda: link.sender.caught_up())
        assert link.try_send(Packet([1]))
        assert link.wait_sent(5)
        assert total(link) == 51


class Untouched:
    """A value that must not be encoded."""

    def to_wire(self) -> tuple[bytes]:
        raise AssertionError("it is dropped, so it need not be encoded")


@pytest.mark.parametrize("carrier", [Tcp, FastTcp, Text])
def test_message_that_is_dropped_costs_no_encoding(carrier: type[Carrier]) -> None:
    with connected(carrier) as (link, _):
        link.start_background()
        with link.sender.lock:  # nothing leaves meanwhile
            assert link.try_send(Packet([0]))
            assert not link.try_send(Packet(Untouched()))
        assert link.counter.drops == 1


def test_background_link_can_send_every_message() -> None:
    with connected() as (link, far):
        link.start_background()
        reader = threading.Thread(target=read_messages, args=(far, 100))
        reader.start()
        for number in range(100):
            link.send(Packet([number]))
        assert link.wait_sent(5)
        reader.join(5)
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
        link.thread.join(5)
        assert not link.thread.is_alive()
        assert total(link) == attempts


def test_drain_has_a_limit() -> None:
    with connected() as (link, _):
        link.start_background()
        link.send(Packet([bytes(10_000_000)]))
        started = time.monotonic()
        assert not link.wait_sent(0.05)
        assert time.monotonic() - started < 2
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
    monkeypatch.setattr(module, "CLOSE_PATIENCE", 0.05)
    with connected() as (link, far):
        link.send(Packet([1]))
        started = time.monotonic()
        link.close()
        assert time.monotonic() - started < 2
        assert link.counter.messages == 0
        assert link.counter.unconfirmed == 1  # never acknowledged
        assert link.counter.drops == 0
        assert far.recv(1000)


@pytest.mark.parametrize("background", [False, True])
def test_link_to_a_peer_that_takes_nothing_can_be_closed(
    background: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whoever is stuck in sending is freed, and gets an error."""
    monkeypatch.setattr(module, "CLOSE_PATIENCE", 0.1)
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
        assert time.monotonic() - started < 3
        writer.join(5)
        assert len(ended) == 1
        assert link.counter.messages == 0


def test_call_behind_a_stuck_message_has_its_limit_too() -> None:
    with connected(Tcp) as (link, _):

        def write() -> None:
            with pytest.raises(LinkClosed):
                link.send(Packet([bytes(10_000_000)]))

        writer = threading.Thread(target=write)
        writer.start()
        time.sleep(0.05)
        started = time.monotonic()
        with pytest.raises(Timeout):
            link.call(Packet(["ask"], key=CALL), 0.1)
        with pytest.raises(Timeout):
            link.wait_acknowledged(0.1)
        assert time.monotonic() - started < 3
        link.driver.transport.interrupt()
        writer.join(5)
        assert not writer.is_alive()


def test_call_to_a_peer_that_does_not_acknowledge_has_its_limit() -> None:
    with connected(Tcp) as (link, _):
        link.send(Packet([1]))
        with pytest.raises(Timeout, match="did not reply"):
            link.call(Packet(["ask"], key=CALL), 0.1)


@pytest.mark.parametrize("trickles", [False, True])
def test_reply_that_has_begun_must_come_along(
    trickles: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without a time limit a reply may take as long as it likes to begin, not to end."""
    monkeypatch.setattr(FastTcp, "limits", Limits(message_timeout=0.2))
    with connected(FastTcp) as (link, far):

        def answer() -> None:
            time.sleep(0.5)
            far.sendall(Bottle(["x" * 1000]).to_bytes()[:100])
            with suppress(OSError):
                while trickles:
                    time.sleep(0.02)
                    far.sendall(b"x")

        thread = threading.Thread(target=answer)
        thread.start()
        with pytest.raises(RemoteProtocolError, match="a message"):
            link.call(Packet(["ask"], key=CALL))
        assert link.broken
        thread.join(5)


def test_reply_in_pieces_leaves_no_limit_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(FastTcp, "limits", Limits(message_timeout=0.2))
    with connected(FastTcp) as (link, far):
        link.intake.budget = Budget(1 << 20)
        reply = Bottle(["x" * 300_000]).to_bytes()

        def answer() -> None:
            for _ in range(2):
                far.sendall(reply[:1000])
                time.sleep(0.05)
                far.sendall(reply[1000:])
                time.sleep(0.5)

        thread = threading.Thread(target=answer)
        thread.start()
        for _ in range(2):
            answered = link.call(Packet(["ask"], key=CALL))
            assert answered is not None
            assert len(answered.value[0]) == 300_000
        assert link.intake.budget.total > 0
        link.intake.leave()
        assert link.intake.budget.total == 0
        thread.join(5)


def test_goodbye_waits_for_what_is_on_its_way() -> None:
    with connected() as (link, far):
        link.start_background()
        for number in range(5):
            link.send(Packet([number]))
        thread = threading.Thread(target=link.close)
        thread.start()
        found = read_messages(far, 5)
        assert len(found) == 5
        assert far.recv(1000) == framing.QUIT
        far.sendall(ACK)
        thread.join(5)
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
        assert time.monotonic() - started < 2.0
        assert link.counter.drops > 10
        link.driver.transport.interrupt()
        wait_until(lambda: link.broken)
        with pytest.raises(LinkClosed):
            link.send(Packet([1]))


def test_reader_of_a_lossy_carrier_gets_a_short_burst_whole() -> None:
    with connected(Shown) as (link, far):
        link.start_background()
        with link.sender.lock:  # nothing leaves meanwhile
            link.send(Packet([0]))
            wait_until(lambda: link._queue is not None and link._queue._busy)
            for number in range(1, 7):
                link.send(Packet([number]))
        found = read_messages(far, 5, ack=False)
        assert found == [b"".join(framing.encode(Packet([n]))) for n in range(5)]  # type: ignore[arg-type]
        assert link.counter.drops == 2


def interrupted(view: memoryview) -> int:
    """What Ctrl-C does to who waits."""
    raise KeyboardInterrupt


def test_interrupted_question_does_not_leave_its_answer_to_the_next() -> None:
    with connected() as (link, _):
        transport: Any = link.driver.transport
        transport.recv_into = transport.try_recv_into = interrupted
        with pytest.raises(KeyboardInterrupt):
            link.call(Packet([1], key=CALL))
        assert link.broken
        with pytest.raises(LinkClosed):
            link.call(Packet([2], key=CALL))


def test_question_that_cannot_be_sent_is_the_error_of_its_asker() -> None:
    with connected() as (link, far):
        for value in (object(), 2**70):
            with pytest.raises((TypeError, OverflowError)):
                link.call(Packet(value, key=CALL))
            with pytest.raises((TypeError, OverflowError)):
                link.send(Packet(value))
        assert not link.broken
        link.send(Packet([2]))
        assert read_messages(far, 1)
