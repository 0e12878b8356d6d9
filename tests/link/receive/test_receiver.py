"""Messages read one after the other, acknowledged and answered in order."""

from __future__ import annotations

import socket
import threading
import time

import pytest
from support.build import changes_a_constant
from support.inbound import Owner, linked, message, served
from support.timer import beating
from support.transport import scripted
from support.wait import HANG, wait_until

from yarpy.carriers.own.tcp import FastTcp, Tcp
from yarpy.carriers.own.text import Text, TextAck
from yarpy.data.bottle import Bottle
from yarpy.errors import LinkClosed, Timeout
from yarpy.link.begin.greeting import driver_of
from yarpy.link.receive import receiver
from yarpy.link.receive.inbound import Inbound
from yarpy.link.receive.receiver import MAX_UNSENT_ACKS
from yarpy.route import Route
from yarpy.transports.socket_transport import SocketTransport
from yarpy.wire import framing
from yarpy.wire.effects import Open, Show, Within
from yarpy.wire.message import QUIT as QUIT_COMMAND
from yarpy.wire.message import Message
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

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
    assert link.counter.messages == 2  # a goodbye is none
    assert link.counter.period > 0
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
    """Else clients would wait for ever, those of C++ after taking the acknowledgement for one."""
    owner, transport, _ = served(Tcp, message([1], "d"), QUIT)
    assert transport.said == Bottle().to_bytes() + ACK + ACK
    assert not owner.heard[0].wants_reply
    _, transport, _ = served(FastTcp, message([1], "d"), QUIT)
    assert transport.said == Bottle().to_bytes()
    _, transport, _ = served(TextAck, b"d\r\n1\r\nq\r\n")
    assert transport.said == b"<ACK>\r\n<ACK>\r\n"


def test_drops_of_the_protocol_are_shown() -> None:
    _, _, link = served(Tcp, message([1]), QUIT)
    link.counter.drops = 2
    link.carrier.lost = 3
    assert link.snapshot()["drops"] == 5


def test_link_closed_is_what_a_late_reply_gets() -> None:
    driver, transport = scripted(message([1], "d"))
    owner = Owner()
    kept: list[Message] = []
    owner.receive = lambda link, message: kept.append(message)  # type: ignore[method-assign]
    link = Inbound(owner, driver, FastTcp(Route("/peer", "/here", "fast_tcp")))
    answers = link.receiver.reply
    link.serve()
    assert transport.closed
    with pytest.raises(LinkClosed):
        answers(["late"])


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
            Owner(), driver_of(SocketTransport(near)), Interim(Route("/peer", "/here", "interim"))
        )
        thread = threading.Thread(target=link.serve, daemon=True)
        thread.start()
        far.sendall(b"one\r\n")
        assert far.recv(100) == b"go on\r\n"
        far.sendall(b"two\r\n")
        thread.join(HANG)
        assert not thread.is_alive()


# ------------------------------------------------------------------------------------- effects


class Asking(Text):
    """A carrier that asks for what its lines name."""

    name = "asking"

    def decode(self, stream: ByteStream) -> Steps[Message]:
        while True:
            word = (yield from stream.read_line()).decode()
            if word == "slow":
                yield Within(0.05)
                try:
                    yield from stream.read_line()
                except Timeout:
                    stream.write(b"too late\r\n")
                    raise
                yield Within(None)
            elif word == "page":
                stream.write(f"{yield Show('/x', {'a': '1'})}\r\n".encode())
            elif word == "tcp":
                yield Open("tcp", listen=False)
            else:
                return Message(QUIT_COMMAND)


def test_message_that_takes_too_long_is_told_so() -> None:
    with linked(Asking) as (near, _, owner):
        near.sendall(b"slow\r\n")
        assert near.recv(100) == b"too late\r\n"
        wait_until(lambda: owner.ended)
        assert owner.ended == [("the peer sends a message too slowly", False)]


def test_signals_lengthen_no_time_of_a_message() -> None:
    """A limit of the system's begins anew behind each, and behind each halt of the process."""
    near, far = socket.socketpair()
    owner = Owner()
    link = Inbound(
        owner, driver_of(SocketTransport(far)), Asking(Route("/peer", "/here", "asking"))
    )
    near.sendall(b"slow\r\n")
    with near, beating():
        link.serve()
        assert near.recv(100) == b"too late\r\n"
    assert owner.ended == [("the peer sends a message too slowly", False)]


def test_time_of_a_message_ends_with_it() -> None:
    with linked(Asking) as (near, link, owner):
        near.sendall(b"slow\r\nbut here\r\n")
        wait_until(lambda: link.driver.bytes_in > 10)
        time.sleep(0.15)
        assert owner.ended == []
        near.sendall(b"quit\r\n")
        wait_until(lambda: owner.ended)
        assert owner.ended == [("", True)]


def test_page_of_the_program_is_asked_for() -> None:
    with linked(Asking) as (near, link, _):
        near.sendall(b"page\r\n")
        assert near.recv(100) == b"None\r\n"
        link.receiver.page = lambda path, fields: f"{path} {fields['a']}"
        near.sendall(b"page\r\n")
        assert near.recv(100) == b"/x 1\r\n"


def test_message_cannot_ask_for_another_connection() -> None:
    with linked(Asking) as (near, _, owner):
        near.sendall(b"tcp\r\n")
        wait_until(lambda: owner.ended)
        assert "nothing that a message can ask for" in owner.ended[0][0]


# ------------------------------------------------------------------------------------- answers


@changes_a_constant
def test_who_does_not_read_its_answer_keeps_nobody_waiting(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """The thread that answers may be the one that reads for everybody."""
    monkeypatch.setattr(receiver, "STRANGERS", 0.2)
    with linked(Text) as (near, _, owner):
        owner.answer = ["x" * 10_000_000]
        near.sendall(b"d\r\nhello\r\n")
        wait_until(lambda: owner.ended)
        reason = "it did not take an answer within 0.2 s"
        assert owner.ended == [(f'"/peer" is gone: {reason}', False)]
        assert f"/here: /peer does not read, and is disconnected: {reason}" in caplog.text


def test_who_reads_its_answer_slowly_gets_all_of_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(receiver, "STRANGERS", 0.5)
    with linked(Text) as (near, _, owner):
        owner.answer = ["x" * 4_000_000]
        near.sendall(b"d\r\nhello\r\n")
        got = 0
        while got < 4_000_002:
            time.sleep(0.02)
            got += len(near.recv(1 << 17))
        assert not owner.ended
