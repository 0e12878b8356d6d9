"""Inbound links: reading, answering, acknowledging, ending; readers with a direct-read lease.

With a scripted transport where order matters, over a socket pair where threads do.
"""

from __future__ import annotations

import logging
import socket
import threading
import time

import pytest
from support.capture import load_capture
from support.inbound import Owner, linked, message, served
from support.lasted import lasted
from support.transport import scripted
from support.wait import HANG, wait_until

from yarpy.carriers.base import Limits
from yarpy.carriers.own.tcp import Tcp
from yarpy.carriers.own.text import TextAck
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError
from yarpy.link.begin.greeting import driver_of
from yarpy.link.begin.handshake import recognise
from yarpy.link.receive import turn
from yarpy.link.receive.inbound import Inbound
from yarpy.route import Route
from yarpy.transports.socket_transport import MSG_DONTWAIT, SocketTransport
from yarpy.wire import framing
from yarpy.wire.message import QUIT as QUIT_COMMAND
from yarpy.wire.message import Message
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

ACK = framing.ACK
QUIT = framing.QUIT


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


def test_close_from_another_thread_wakes_the_reader() -> None:
    with linked() as (near, link, owner):
        near.sendall(message([1]))
        wait_until(lambda: owner.heard)
        link.close()
        assert link.closing
        wait_until(lambda: owner.ended)
        assert near.recv(8) == ACK
        assert near.recv(1) == b""


@pytest.fixture(autouse=True)
def _patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """Links wait longer for a reader with the lease than a busy machine makes it wait; `read` says
    when it has gone."""
    monkeypatch.setattr(turn, "AWAY", HANG)


def soon() -> float:
    return time.monotonic() + HANG


def read(
    link: Inbound, until: float | None, newest: bool = False, stays: bool = False
) -> Message | None:
    """Read as the thread that has the lease does, and stay away then, or not yet."""
    lease = link.turn.lease
    assert lease is not None
    assert lease.open or lease.wait(HANG)
    lease.busy = True
    try:
        message = None if lease.over else link.read(lease, until, newest=newest)
        lease.seen = time.perf_counter()
        link.receiver.release()
        return message
    finally:
        lease.busy = False
        if not stays:
            turn.AWAY = 0.01
            link.turn._changed.wake()


def test_reader_may_take_the_turn() -> None:
    """A waiting reader reads the socket itself; the thread takes over when it stays away."""
    with linked() as (near, link, owner):
        link.turn.ask(threading.get_ident())
        near.sendall(message([1]))
        wait_until(lambda: link.turn.leased)
        near.sendall(message([2]))
        found = read(link, None)
        assert found is not None
        assert found.value == [2]
        assert len(owner.heard) == 1
        near.sendall(message([3]))
        wait_until(lambda: len(owner.heard) == 2)
        assert owner.heard[1].value == [3]
        assert not link.turn.leased


def test_turn_given_back_leaves_no_time_limit_behind() -> None:
    """The thread waits as long as it takes: a silent peer is no failure."""
    with linked() as (near, link, owner):
        link.turn.ask(threading.get_ident())
        near.sendall(message([1]))
        wait_until(lambda: link.turn.leased)
        assert read(link, time.monotonic() + 0.01) is None
        time.sleep(0.2)
        assert owner.ended == []
        near.sendall(message([2]))
        wait_until(lambda: len(owner.heard) == 2)


def test_borrower_obeys_commands_and_answers() -> None:
    with linked() as (near, link, _):
        link.turn.ask(threading.get_ident())
        near.sendall(message([1]))
        wait_until(lambda: link.turn.leased)
        near.sendall(message([Vocab("ver")], "a") + message([2], "d"))
        found = read(link, None)
        assert found is not None
        assert found.wants_reply
        found.reply(["answer"])
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


def test_nobody_else_writes_while_a_question_is_open() -> None:
    """The connection's thread does not send what the reader is about to send, nor twice."""
    with linked() as (near, link, _):
        link.turn.ask(threading.get_ident())
        near.sendall(message([1]))
        wait_until(lambda: link.turn.leased)
        near.sendall(message([2], "d"))
        found = read(link, None)
        assert found is not None
        assert near.recv(len(ACK)) == ACK
        assert found.answer is not None
        found.answer.right.clear()  # another thread answers
        link.receiver.driver.stream.write(b"half of an answer")
        link.turn.end()  # as when another sender comes
        near.settimeout(0.3)
        with pytest.raises(TimeoutError):
            near.recv(1)
        link.close()
        assert near.recv(1) == b""


@pytest.mark.skipif(not MSG_DONTWAIT, reason="nothing interrupts a wait of Windows")
@pytest.mark.parametrize("main", [True, False])
def test_a_timed_read_ends_also_where_a_timer_interrupts_it(
    main: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Signals come to the main thread, and a limit of the system begins anew behind each."""
    monkeypatch.setattr(turn, "AWAY", HANG)
    with linked() as (near, link, _):
        transport, limits = link.receiver.driver.transport, list[float]()
        wait_readable = transport.wait_readable

        def noted(seconds: float) -> bool:
            limits.append(seconds)
            return wait_readable(seconds)

        def wait() -> None:
            link.turn.ask(threading.get_ident())
            near.sendall(message([1]))
            wait_until(lambda: link.turn.leased)
            monkeypatch.setattr(transport, "wait_readable", noted)
            assert read(link, time.monotonic() + 60) is None
            assert link.turn.lease is None or link.turn.lease.over, "nothing came for a while"

        thread = threading.Thread(target=wait)
        if main:
            wait()
        else:
            thread.start()
            thread.join(HANG)
        assert bool(limits) is main and all(limit <= turn.SILENCE for limit in limits)


def test_borrower_that_wants_the_newest_gets_the_last_of_those_that_are_there() -> None:
    """What it passes over is acknowledged, and counted; a command among it is obeyed."""
    with linked() as (near, link, _):
        link.turn.ask(threading.get_ident())
        near.sendall(message([1]))
        wait_until(lambda: link.turn.leased)
        near.sendall(
            message([2]) + message([3]) + message([Vocab("ver")], "a") + message([4]) + b"YA\n"
        )
        wait_until(lambda: link.driver.stream.waiting or link.driver.try_fill())
        found = read(link, None, newest=True)
        assert found is not None
        assert found.value == [4]
        assert link.snapshot()["drops"] == 2
        assert link.snapshot()["messages"] == 4  # a command is none
        near.sendall(message([5])[3:])
        wanted = ACK * 3 + Bottle([Vocab("ver"), 1, 2, 3]).to_bytes() + ACK * 3
        got = b""
        while len(got) < len(wanted):
            got += near.recv(1000)
        assert got == wanted


@pytest.mark.parametrize("newest", [False, True])
def test_message_of_a_sender_who_has_gone_is_not_lost(newest: bool) -> None:
    """Its acknowledgement finds nobody, which is no reason to forget it."""
    with linked() as (near, link, owner):
        link.turn.ask(threading.get_ident())
        near.sendall(message([1]))
        wait_until(lambda: link.turn.leased)
        large = [b"x" * 20_000]  # is acknowledged at once; of small ones, every so many together
        values: list[object] = [[number] for number in range(100)] if newest else [large]
        near.sendall(b"".join(map(message, values)))
        wait_until(lambda: link.driver.stream.waiting or link.driver.try_fill())
        near.close()
        found = read(link, None, newest=newest)
        assert found is not None
        wait_until(lambda: owner.ended)
        heard = [item.value for item in owner.heard]
        drops = link.snapshot()["drops"]
        assert [[1], found.value, *heard[1:]] == [[1], *values[drops:]]


def test_question_is_never_passed_over_for_something_newer() -> None:
    with linked() as (near, link, _):
        link.turn.ask(threading.get_ident())
        near.sendall(message([1]))
        wait_until(lambda: link.turn.leased)
        near.sendall(message([2]) + message([3], "d") + message([4]))
        wait_until(lambda: link.driver.stream.waiting or link.driver.try_fill())
        found = read(link, None, newest=True, stays=True)
        assert found is not None
        assert (found.value, found.wants_reply) == ([3], True)
        found.reply(["answer"])
        found = read(link, None, newest=True)
        assert found is not None
        assert found.value == [4]


def test_end_met_by_a_borrower_is_told_by_the_thread() -> None:
    with linked() as (near, link, owner):
        link.turn.ask(threading.get_ident())
        near.sendall(message([1]))
        wait_until(lambda: link.turn.leased)
        near.shutdown(socket.SHUT_WR)
        assert read(link, None) is None
        wait_until(lambda: owner.ended)
        assert owner.ended == [("the peer closed the connection", False)]


def test_quit_met_by_a_borrower() -> None:
    with linked() as (near, link, owner):
        link.turn.ask(threading.get_ident())
        near.sendall(message([1]))
        wait_until(lambda: link.turn.leased)
        near.sendall(QUIT)
        assert read(link, None) is None
        wait_until(lambda: owner.ended)
        assert owner.ended == [("", True)]


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


# ---------------------------------------------------------------------------------- short talks


class Brief(TextAck):
    """A carrier that is done after one message, and has little patience."""

    name = "brief"
    limits = Limits(idle_timeout=0.05)
    finished = False

    def decode(self, stream: ByteStream) -> Steps[Message]:
        if self.finished:
            return Message(QUIT_COMMAND)
        return (yield from super().decode(stream))

    def encode_ack(self, stream: ByteStream, count: int) -> None:
        if not self.finished:
            stream.write(b"bye\r\n")
        self.finished = True


def test_finished_carrier_ends_without_waiting_for_the_peer() -> None:
    driver, transport = scripted(b"d\r\n1\r\n", open_ended=True)
    owner = Owner()
    Inbound(owner, driver, Brief(Route("/peer", "/here", "brief"))).serve()
    assert transport.said == b"bye\r\n"
    assert owner.ended == [("", True)]


def test_silence_beyond_the_carriers_limit_ends_quietly(
    caplog: pytest.LogCaptureFixture,
) -> None:
    near, far = socket.socketpair()
    with far:
        owner = Owner()
        link = Inbound(
            owner, driver_of(SocketTransport(near)), Brief(Route("/peer", "/here", "brief"))
        )
        started = time.monotonic()
        link.serve()
        assert time.monotonic() - started > 0.02 and lasted(started) < 10
    assert owner.ended == [("the peer is silent", False)]
    assert not caplog.records
