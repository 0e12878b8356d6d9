"""Inbound links: reading, answering, acknowledging, ending; the turn that readers may take.

With a scripted transport where order matters, over a socket pair where threads do.
"""

from __future__ import annotations

import logging
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from support.capture import load_capture
from support.transport import ScriptTransport, scripted
from support.wait import wait_until

from yarpy.carriers.base import Carrier
from yarpy.carriers.tcp import FastTcp, Tcp
from yarpy.carriers.text import TextAck
from yarpy.contact import Route
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError, LinkClosed
from yarpy.link.driver import Driver
from yarpy.link.handshake import recognise
from yarpy.link.inbound import MAX_UNSENT_ACKS, Inbound
from yarpy.transports.base import SocketTransport
from yarpy.wire import framing
from yarpy.wire.effects import Steps
from yarpy.wire.message import Message, Packet
from yarpy.wire.stream import ByteStream


class Owner:
    """A port that does what a test says."""

    name = "/here"

    def __init__(self) -> None:
        self.heard: list[Message] = []
        self.ended: list[tuple[str, bool]] = []
        self.reversed: list[Inbound] = []
        self.answer: object = None
        self.leave: Inbound | None = None

    def receive(self, link: Inbound, message: Message) -> None:
        self.heard.append(message)
        if isinstance(self.answer, BaseException):
            raise self.answer
        if self.answer is not None and message.wants_reply:
            message.reply(self.answer)

    def administer(self, link: Inbound, message: Message) -> Bottle:
        if self.leave is not None:
            self.leave.close()
        return Bottle([Vocab("ver"), 1, 2, 3])

    def command(self, link: Inbound, message: Message) -> list[str]:
        if self.leave is not None:
            self.leave.close()
        return [f"you said {message.key}{message.text}"]

    def reverse(self, link: Inbound) -> None:
        self.reversed.append(link)

    def closed(self, link: Inbound, reason: str, quit_: bool) -> None:
        self.ended.append((reason, quit_))


def served(
    kind: type[Carrier], *incoming: bytes, answer: object = None
) -> tuple[Owner, ScriptTransport, Inbound]:
    """Serve a connection whose whole input is known."""
    driver, transport = scripted(*incoming)
    owner = Owner()
    owner.answer = answer
    link = Inbound(owner, driver, kind(Route("/peer", "/here", kind.name)))
    link.serve()
    return owner, transport, link


def message(value: object, key: str = "D", envelope: str = "") -> bytes:
    return b"".join(framing.encode(Packet(value, envelope.encode(), key)))  # type: ignore[arg-type]


ACK = framing.ACK
QUIT = framing.QUIT


def test_messages_are_handed_on_and_acknowledged() -> None:
    owner, transport, link = served(Tcp, message([1]), message([2], envelope="7 1.5"), QUIT)
    assert [(m.value, m.envelope, m.source) for m in owner.heard] == [
        ([1], "", "/peer"),
        ([2], "7 1.5", "/peer"),
    ]
    assert transport.said == ACK * 3
    assert owner.ended == [("", True)]
    assert transport.closed
    assert link.counter.messages == 3
    assert link.counter.bytes > 0


def test_acknowledgements_of_a_burst_leave_together() -> None:
    burst = b"".join(message([n]) for n in range(20))
    _, transport, _ = served(Tcp, burst, QUIT)
    assert transport.said == ACK * 21
    assert transport.sends <= 3


def test_acknowledgements_are_not_held_back_for_ever() -> None:
    count = 3 * MAX_UNSENT_ACKS
    burst = b"".join(message([n]) for n in range(count))
    _, transport, _ = served(Tcp, burst + QUIT)
    assert transport.said == ACK * (count + 1)
    assert transport.sends >= 3


def test_call_is_answered_before_its_acknowledgement() -> None:
    _, transport, _ = served(Tcp, message([1], "d"), QUIT, answer=["ok"])
    assert transport.said == Bottle(["ok"]).to_bytes() + ACK + ACK


def test_acknowledgements_keep_their_order_with_replies() -> None:
    reply = Bottle(["ok"]).to_bytes()
    data = message([1]) + message([2], "d") + message([3]) + QUIT
    _, transport, _ = served(Tcp, data, answer=["ok"])
    assert transport.said == ACK + reply + ACK + ACK + ACK


def test_unanswered_call_gets_an_empty_answer() -> None:
    """C++ clients would take the acknowledgement for an answer, and wait for ever."""
    owner, transport, _ = served(Tcp, message([1], "d"), QUIT)
    assert transport.said == Bottle().to_bytes() + ACK + ACK
    assert not owner.heard[0].wants_reply
    _, transport, _ = served(FastTcp, message([1], "d"), QUIT)
    assert transport.said == b""
    _, transport, _ = served(TextAck, b"d\r\n1\r\nq\r\n")
    assert transport.said == b"<ACK>\r\n<ACK>\r\n"


def test_port_commands_and_administration() -> None:
    owner, transport, _ = served(TextAck, b"/dest\r\na\r\n[ver]\r\n*\r\nq\r\n")
    assert transport.said.decode() == (
        "you said /dest\r\n<ACK>\r\n[ver] 1 2 3\r\n<ACK>\r\nyou said *\r\n<ACK>\r\n<ACK>\r\n"
    )
    assert owner.heard == []


def test_command_that_ends_its_own_connection_is_answered_first() -> None:
    for data, said in (
        (b"~peer\r\nd\r\n1\r\n", b"you said ~peer\r\n<ACK>\r\n"),
        (b"a\r\n[del] peer\r\nd\r\n1\r\n", b"[ver] 1 2 3\r\n<ACK>\r\n"),
    ):
        driver, transport = scripted(data)
        owner = Owner()
        link = owner.leave = Inbound(owner, driver, TextAck(Route("peer", "/here", "text_ack")))
        link.serve()
        assert transport.said == said
        assert owner.heard == []
        assert owner.ended == [("", True)]
        assert transport.closed


def test_reversed_link_is_handed_over_open() -> None:
    data = b"".join(framing.encode_text_command("r"))  # type: ignore[arg-type]
    owner, transport, link = served(Tcp, data)
    assert owner.reversed == [link]
    assert owner.ended == []
    assert transport.said == ACK
    assert not transport.closed


# ---------------------------------------------------------------------------------- ends


def test_hanging_up_between_messages_is_no_warning(caplog: pytest.LogCaptureFixture) -> None:
    owner, transport, _ = served(Tcp, message([1]))
    assert owner.ended == [("the peer closed the connection", False)]
    assert transport.closed
    assert caplog.records == []


def test_hanging_up_inside_a_message_says_so() -> None:
    capture = load_capture("half_message")
    owner, _, _ = served(Tcp, capture.steps[2].data)
    assert owner.heard == []
    assert "in the middle of a message" in owner.ended[0][0]


BAD = [
    framing.INDEX + b"\x02\x01" + b"\xff" * 8 + b"\xff" * 12,
    framing.INDEX + b"\x01\x01" + b"\xff" * 8 + b"\xff\xff\xff\x7f" + bytes(4),
]


@pytest.mark.parametrize("data", BAD)
def test_broken_rules_are_one_line_in_the_log(
    data: bytes, caplog: pytest.LogCaptureFixture
) -> None:
    owner, transport, _ = served(Tcp, message([1]), data)
    assert len(owner.heard) == 1
    assert len(owner.ended) == 1
    assert transport.closed
    (record,) = caplog.records
    assert record.levelno == logging.WARNING
    for word in ("/here", "/peer", "tcp"):
        assert word in record.getMessage()


def test_defect_of_ours_is_logged_with_its_traceback(caplog: pytest.LogCaptureFixture) -> None:
    owner, transport, _ = served(Tcp, message([1]), answer=ZeroDivisionError("oh"))
    assert "ZeroDivisionError" in owner.ended[0][0]
    assert transport.closed
    assert caplog.records[0].exc_info is not None


def test_reader_who_means_to_end_its_thread_ends_the_link(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """Else its peer would wait for ever for a link that nobody serves."""
    owner, transport, _ = served(Tcp, message([1]), answer=SystemExit(3))
    assert owner.ended == [("SystemExit: 3", False)]
    assert transport.closed
    assert "fails on a defect" in caplog.text


def test_error_of_ours_ends_the_link_quietly(caplog: pytest.LogCaptureFixture) -> None:
    owner, _, _ = served(Tcp, message([1]), answer=DecodeError("no Bottle"))
    assert owner.ended == [("no Bottle", False)]
    (record,) = caplog.records
    assert record.exc_info is None


def test_peer_that_does_not_take_its_acknowledgements() -> None:
    driver, transport = scripted(message([1]), message([2]))
    transport.fails_after = 0
    owner = Owner()
    Inbound(owner, driver, Tcp(Route("/peer", "/here"))).serve()
    assert len(owner.heard) == 1
    assert len(owner.ended) == 1
    assert transport.closed


# ---------------------------------------------------------------------------------- over sockets


@contextmanager
def linked(kind: type[Carrier] = Tcp) -> Iterator[tuple[socket.socket, Inbound, Owner]]:
    near, far = socket.socketpair()
    near.settimeout(5)
    owner = Owner()
    link = Inbound(owner, Driver(SocketTransport(far)), kind(Route("/peer", "/here", kind.name)))
    link.thread = threading.Thread(target=link.serve, daemon=True)
    link.thread.start()
    try:
        yield near, link, owner
    finally:
        near.close()
        link.thread.join(5)
        assert not link.thread.is_alive()


def test_close_from_another_thread_wakes_the_reader() -> None:
    with linked() as (near, link, owner):
        near.sendall(message([1]))
        wait_until(lambda: owner.heard)
        link.close()
        assert link.closing
        wait_until(lambda: owner.ended)
        assert near.recv(8) == ACK
        assert near.recv(1) == b""


def take(link: Inbound) -> None:
    """Make the link's thread leave the turn to us."""
    link.wanted = True


def test_reader_may_take_the_turn() -> None:
    """A waiting reader reads the socket itself; the thread takes over when it stays away."""
    with linked() as (near, link, owner):
        take(link)
        near.sendall(message([1]))
        wait_until(lambda: link.borrow())
        near.sendall(message([2]))
        found = link.fetch(None)
        assert found is not None
        assert found.value == [2]
        assert len(owner.heard) == 1
        link.give_back()
        near.sendall(message([3]))
        wait_until(lambda: len(owner.heard) == 2)
        assert owner.heard[1].value == [3]
        assert not link.borrow()


def test_turn_given_back_leaves_no_time_limit_behind() -> None:
    """The thread waits as long as it takes: a silent peer is no failure."""
    with linked() as (near, link, owner):
        take(link)
        near.sendall(message([1]))
        wait_until(lambda: link.borrow())
        assert link.fetch(time.monotonic() + 0.01) is None
        link.give_back()
        time.sleep(0.2)
        assert owner.ended == []
        near.sendall(message([2]))
        wait_until(lambda: len(owner.heard) == 2)


def test_borrower_obeys_commands_and_answers() -> None:
    with linked() as (near, link, _):
        take(link)
        near.sendall(message([1]))
        wait_until(lambda: link.borrow())
        near.sendall(message([Vocab("ver")], "a") + message([2], "d"))
        found = link.fetch(None)
        assert found is not None
        assert found.wants_reply
        found.reply(["answer"])
        link.give_back()
        wanted = (
            ACK
            + Bottle([Vocab("ver"), 1, 2, 3]).to_bytes()
            + ACK
            + Bottle(["answer"]).to_bytes()
            + ACK
        )
        got = b""
        while len(got) < len(wanted):
            got += near.recv(1000)
        assert got == wanted


def test_borrower_that_wants_the_newest_gets_the_last_of_those_that_are_there() -> None:
    """What it passes over is acknowledged, and counted; a command among it is obeyed."""
    with linked() as (near, link, _):
        take(link)
        near.sendall(message([1]))
        wait_until(lambda: link.borrow())
        near.sendall(
            message([2]) + message([3]) + message([Vocab("ver")], "a") + message([4]) + b"YA\n"
        )
        wait_until(lambda: link.driver.stream.waiting or link.driver.try_fill())
        found = link.fetch(None, newest=True)
        assert found is not None
        assert found.value == [4]
        assert link.snapshot()["drops"] == 2
        assert link.snapshot()["messages"] == 5
        link.give_back()
        near.sendall(message([5])[3:])
        wanted = ACK * 3 + Bottle([Vocab("ver"), 1, 2, 3]).to_bytes() + ACK * 3
        got = b""
        while len(got) < len(wanted):
            got += near.recv(1000)
        assert got == wanted


def test_question_is_never_passed_over_for_something_newer() -> None:
    with linked() as (near, link, _):
        take(link)
        near.sendall(message([1]))
        wait_until(lambda: link.borrow())
        near.sendall(message([2]) + message([3], "d") + message([4]))
        wait_until(lambda: link.driver.stream.waiting or link.driver.try_fill())
        found = link.fetch(None, newest=True)
        assert found is not None
        assert (found.value, found.wants_reply) == ([3], True)
        found.reply(["answer"])
        found = link.fetch(None, newest=True)
        assert found is not None
        assert found.value == [4]
        link.give_back()


def test_end_met_by_a_borrower_is_told_by_the_thread() -> None:
    with linked() as (near, link, owner):
        take(link)
        near.sendall(message([1]))
        wait_until(lambda: link.borrow())
        near.shutdown(socket.SHUT_WR)
        assert link.fetch(None) is None
        link.give_back()
        wait_until(lambda: owner.ended)
        assert owner.ended == [("the peer closed the connection", False)]


def test_quit_met_by_a_borrower() -> None:
    with linked() as (near, link, owner):
        take(link)
        near.sendall(message([1]))
        wait_until(lambda: link.borrow())
        near.sendall(QUIT)
        assert link.fetch(None) is None
        link.give_back()
        wait_until(lambda: owner.ended)
        assert owner.ended == [("", True)]


def test_drops_of_the_protocol_are_shown() -> None:
    _, _, link = served(Tcp, message([1]), QUIT)
    link.counter.drops = 2
    link.carrier.lost = 3
    assert link.snapshot()["drops"] == 5


def test_golden_greeting_then_link() -> None:
    """From the first byte of a capture to its last, by the real link."""
    capture = load_capture("conn_tcp_rpc")
    said = capture.said("a")
    driver, transport = scripted(said)
    first = bytes(driver.run(driver.stream.read_exact(8)))
    kind = recognise(first)
    assert kind is Tcp
    carrier = kind(Route("", "/cap/srv", "tcp", capture.ports["acceptor_port"]))
    driver.run(carrier.welcome(driver.stream, first))
    owner = Owner()

    def receive(link: Inbound, message: Message) -> None:
        message.reply([Vocab("ok"), "echo", message.as_(Bottle)])

    owner.receive = receive  # type: ignore[method-assign]
    Inbound(owner, driver, carrier).serve()
    assert transport.said == capture.said("b")


def test_link_closed_is_what_a_late_reply_gets() -> None:
    driver, transport = scripted(message([1], "d"))
    owner = Owner()
    kept: list[Message] = []
    owner.receive = lambda link, message: kept.append(message)  # type: ignore[method-assign]
    link = Inbound(owner, driver, FastTcp(Route("/peer", "/here", "fast_tcp")))
    answers = link._reply
    link.serve()
    assert transport.closed
    with pytest.raises(LinkClosed):
        answers(["late"])


# ---------------------------------------------------------------------------------- short talks


class Brief(TextAck):
    """A carrier that is done after one message, and has little patience."""

    name = "brief"
    patience = 0.05

    def encode_ack(self, stream: ByteStream) -> None:
        if not self.finished:
            stream.write(b"bye\r\n")
        self.finished = True


def test_finished_carrier_ends_without_waiting_for_the_peer() -> None:
    driver, transport = scripted(b"d\r\n1\r\n", open_ended=True)
    owner = Owner()
    Inbound(owner, driver, Brief(Route("/peer", "/here", "brief"))).serve()
    assert transport.said == b"bye\r\n"
    assert owner.ended == [("", True)]


def test_silence_beyond_the_carriers_patience_ends_quietly(
    caplog: pytest.LogCaptureFixture,
) -> None:
    near, far = socket.socketpair()
    with far:
        owner = Owner()
        link = Inbound(
            owner, Driver(SocketTransport(near)), Brief(Route("/peer", "/here", "brief"))
        )
        started = time.monotonic()
        link.serve()
        assert 0.02 < time.monotonic() - started < 2.0
    assert owner.ended == [("the peer is silent", False)]
    assert not caplog.records


class Interim(TextAck):
    """A carrier that says something in the middle of a message."""

    name = "interim"

    def decode(self, stream: ByteStream) -> Steps[Message]:
        yield from stream.read_line()
        stream.write(b"go on\r\n")
        yield from stream.read_line()
        return Message("q")


def test_what_is_written_while_reading_leaves_before_waiting() -> None:
    near, far = socket.socketpair()
    with far:
        far.settimeout(5)
        link = Inbound(
            Owner(), Driver(SocketTransport(near)), Interim(Route("/peer", "/here", "interim"))
        )
        thread = threading.Thread(target=link.serve, daemon=True)
        thread.start()
        far.sendall(b"one\r\n")
        assert far.recv(100) == b"go on\r\n"
        far.sendall(b"two\r\n")
        thread.join(5)
        assert not thread.is_alive()
