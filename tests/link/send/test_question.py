"""Questions, and their answers over the same connection."""

from __future__ import annotations

import threading
import time
from contextlib import suppress

import pytest
from support.cut import ALL_SEEN, cut_at
from support.lasted import lasted
from support.outbound import connected, link_on, open_link, read_messages
from support.transport import scripted
from support.wait import HANG, wait_until

from yarpy.carriers.base import Limits
from yarpy.carriers.own.tcp import FastTcp, Tcp
from yarpy.carriers.own.text import TextAck
from yarpy.carriers.own.udp import Udp
from yarpy.data.bottle import Bottle
from yarpy.errors import LinkClosed, LocalProtocolError, PortClosed, RemoteProtocolError, Timeout
from yarpy.link.ending import Ending, moment
from yarpy.link.receive.budget import Budget
from yarpy.link.send.outbound import Outbound
from yarpy.wire import framing
from yarpy.wire.message import CALL, Packet

ACK = framing.ACK


def test_question_and_answer() -> None:
    reply = Bottle(["ok", 1]).to_bytes()
    link, transport = open_link(Tcp, reply + ACK)
    message = link.call(Packet(["ask"], key=CALL), moment(5))
    assert message is not None
    assert message.value == ["ok", 1]
    assert message.source == "/peer"
    assert link.counter.latency > 0
    assert transport.said == b"".join(framing.encode(Packet(["ask"], key=CALL)))  # type: ignore[arg-type]


def test_a_question_that_fails_is_no_message_that_was_carried() -> None:
    with connected(Tcp) as (link, far):
        far.sendall(Bottle(["ok"]).to_bytes() + ACK)
        link.call(Packet(["ask"], key=CALL), moment(5))
        assert link.counter.messages == 1
        with pytest.raises(Timeout):
            link.call(Packet(["ask"], key=CALL), moment(0.05))
        assert link.counter.messages == 1


def test_question_without_an_answer() -> None:
    link, _ = open_link(Tcp, ACK)
    assert link.call(Packet(["ask"], key=CALL), moment(5)) is None
    link, _ = open_link(TextAck, b"<ACK>\r\n")
    assert link.call(Packet(["ask"], key=CALL), moment(5)) is None


def test_acknowledgements_of_earlier_messages_come_first() -> None:
    reply = Bottle(["ok"]).to_bytes()
    link, _ = open_link(Tcp, ACK * 3 + reply + ACK)
    for number in range(3):
        link.send(Packet([number]))
    message = link.call(Packet(["ask"], key=CALL), moment(5))
    assert message is not None
    assert message.value == ["ok"]


def test_question_that_is_not_taken_has_its_limit_too() -> None:
    with connected(FastTcp) as (link, _):
        with pytest.raises(Timeout):
            link.call(Packet("x" * 20_000_000, key=CALL), moment(0.2))
        assert link.broken


def test_answer_that_is_late_never_answers_the_next_question() -> None:
    with connected() as (link, far):
        with pytest.raises(Timeout, match="did not reply within"):
            link.call(Packet(["slow"], key=CALL), moment(0.05))
        assert link.broken
        with pytest.raises(LinkClosed):
            link.call(Packet(["next"], key=CALL), moment(0.05))
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
        link.call(Packet(["ask"], key=CALL), moment(5))
    assert link.broken


def test_call_behind_a_stuck_message_has_its_limit_too() -> None:
    with connected(Tcp) as (link, _):

        def write() -> None:
            with pytest.raises(LinkClosed):
                link.send(Packet([bytes(10_000_000)]))

        writer = threading.Thread(target=write)
        before = link.driver.bytes_out
        writer.start()
        wait_until(lambda: link.driver.bytes_out > before)
        started = time.monotonic()
        with pytest.raises(Timeout):
            link.call(Packet(["ask"], key=CALL), moment(0.1))
        assert not link.wait_acknowledged(moment(0.1))
        assert lasted(started) < 10
        link.driver.transport.interrupt()
        writer.join(HANG)
        assert not writer.is_alive()


def test_call_to_a_peer_that_does_not_acknowledge_has_its_limit() -> None:
    with connected(Tcp) as (link, _):
        link.send(Packet([1]))
        with pytest.raises(Timeout, match="did not reply"):
            link.call(Packet(["ask"], key=CALL), moment(0.1))


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
        thread.join(HANG)


def test_reply_in_pieces_leaves_no_limit_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(FastTcp, "limits", Limits(message_timeout=HANG))
    with connected(FastTcp) as (link, far):
        link.incoming.budget = Budget(1 << 20)
        reply = Bottle(["x" * 300_000]).to_bytes()
        transport = link.driver.transport
        limit, limits = transport.limit_waiting, list[float | None]()

        def noted(seconds: float | None, sends: bool = True) -> None:
            limits.append(seconds)
            limit(seconds, sends)

        monkeypatch.setattr(transport, "limit_waiting", noted)

        def answer() -> None:
            for _ in range(2):
                far.sendall(reply[:1000])
                time.sleep(0.05)
                far.sendall(reply[1000:])

        thread = threading.Thread(target=answer)
        thread.start()
        for _ in range(2):
            answered = link.call(Packet(["ask"], key=CALL))
            assert answered is not None
            assert len(answered.value[0]) == 300_000
            assert HANG in limits and limits.pop() is None
        assert link.incoming.budget.total > 0
        link.incoming.leave()
        assert link.incoming.budget.total == 0
        thread.join(HANG)


def interrupted(view: memoryview) -> int:
    """What Ctrl-C does to who waits."""
    raise KeyboardInterrupt


def test_interrupted_question_does_not_leave_its_answer_to_the_next() -> None:
    with connected() as (link, _):
        link.driver._recv = interrupted
        with pytest.raises(KeyboardInterrupt):
            link.call(Packet([1], key=CALL))
        assert link.broken
        with pytest.raises(LinkClosed):
            link.call(Packet([2], key=CALL))


class Missing:
    """A value whose own method fails."""

    def to_wire(self) -> tuple[bytes]:
        raise KeyError("no such joint")


def test_question_that_cannot_be_sent_is_the_error_of_its_asker() -> None:
    with connected() as (link, far):
        refused = (TypeError, OverflowError, KeyError)
        for value in (object(), 2**70, Missing()):
            with pytest.raises(refused):
                link.call(Packet(value, key=CALL))
            with pytest.raises(refused):
                link.send(Packet(value))
        assert not link.broken
        link.send(Packet([2]))
        assert read_messages(far, 1)


def test_a_port_that_ends_wakes_whoever_waits_for_an_answer() -> None:
    with connected() as (link, far):
        ending = Ending()
        link.join(ending, newest=False)

        def end() -> None:
            far.recv(1000)  # the question has left
            ending.begin("it is over")
            link.interrupt()

        thread = threading.Thread(target=end)
        thread.start()
        with pytest.raises(PortClosed, match="it is over"):
            link.call(Packet(["ask"], key=CALL))
        thread.join(HANG)
        assert link.broken, "a late answer must not be taken for another one"


@pytest.mark.parametrize("gathered", [False, True])
def test_a_signal_handler_that_raises_anywhere_in_a_call_leaves_nobody_waiting(
    gathered: bool,
) -> None:
    """The lock is given back; and a dialogue that was left half way is over."""
    reply = Bottle(["ok", 1, 2, 3]).to_bytes()  # which takes more steps than most
    number, there = 0, True
    while there or number < 2:  # the second time Python 3.13 shows more
        number += 1
        link, transport = open_link(Tcp, ACK * gathered + reply + ACK)
        if gathered:
            link.send(Packet([1]))

        def ask(link: Outbound = link) -> None:
            link.call(Packet(["ask"], key=CALL), moment(5))

        before = len(transport.said)
        there = cut_at(number, ask, "send/outbound.py", "send/question.py", "link/ending.py")
        assert not link.sender.held()
        assert not link.sender.asking
        asked = len(transport.said) > before
        answered = link.counter.messages == 1 + gathered
        assert link.broken or answered or not asked
    assert number > 20 or not ALL_SEEN
