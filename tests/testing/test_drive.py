"""Dialogue and End: what a carrier says is recorded, what stalls is an error."""

from __future__ import annotations

import pytest

from yarpy.carriers.own.mcast import Mcast
from yarpy.carriers.own.tcp import FastTcp, Tcp
from yarpy.carriers.own.text import TextAck
from yarpy.carriers.own.udp import Udp
from yarpy.carriers.own.unix_stream import UnixStream
from yarpy.errors import LinkClosed
from yarpy.testing import Dialogue, End, Stalled, drive, said
from yarpy.testing.drive import GROUP, TCP_PORT, UDP_PORT
from yarpy.wire.effects import Open
from yarpy.wire.framing import number
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream, DatagramStream


@pytest.mark.parametrize("piece", [0, 1, 3])
def test_dialogue_from_greeting_to_goodbye(piece: int) -> None:
    talk = Dialogue(TextAck, piece=piece)
    talk.greet()
    assert talk.send([1, "two"], "5 2.5").value == [1, "two"]
    assert talk.acknowledge() is None
    assert talk.send(["ask"], key="d").wants_reply is False
    reply = talk.reply(["answer"])
    assert reply is not None
    assert reply.value == ["answer"]
    goodbye = talk.quit()
    assert goodbye is not None
    assert goodbye.key == "q"
    assert said(talk.traffic, "initiator") == (
        b"CONNACK /sender\r\nD 5 2.5\r\n1 two\r\nd\r\nask\r\nq\r\n"
    )
    assert said(talk.traffic, "acceptor") == b"Welcome /sender\r\n<ACK>\r\nanswer\r\n<ACK>\r\n"


def test_acceptor_is_chosen_by_what_is_said() -> None:
    talk = Dialogue(Tcp, "+a.b", source="/me", target="/you")
    assert talk.accepting is None
    talk.greet()
    assert isinstance(talk.accepting, Tcp)
    assert talk.accepting.route.source == "/me"
    assert talk.accepting.route.carrier == "tcp+a.b"
    assert talk.accepting.route.target == "/you"
    assert said(talk.traffic, "acceptor") == number(TCP_PORT)


@pytest.mark.parametrize(
    ("carrier", "kind"), [(Udp, "udp"), (Mcast, "mcast"), (UnixStream, "unix")]
)
def test_carriers_that_move_elsewhere_are_granted_a_place(carrier: type[Udp], kind: str) -> None:
    talk = Dialogue(carrier)
    talk.greet()
    for end, listens in ((talk.initiator, False), (talk.acceptor, True)):
        (opened,) = end.opened
        assert isinstance(opened, Open)
        assert (opened.kind, opened.listen) == (kind, listens)
    if kind == "udp":
        assert talk.initiator.opened[0].port == UDP_PORT
    if kind == "mcast":
        assert (talk.acceptor.opened[0].group, talk.acceptor.opened[0].port) == GROUP
    assert isinstance(talk.acceptor.stream, DatagramStream) == (kind != "unix")
    assert talk.send([1]).value == [1]


class Expecting(FastTcp):
    """Waits for an answer that nobody gives."""

    name = "expecting"

    def greet(self, stream: ByteStream) -> Steps[None]:
        yield from super().greet(stream)
        yield from stream.read_exact(1)


def test_two_sides_that_wait_are_an_error() -> None:
    with pytest.raises(Stalled, match="greeting"):
        Dialogue(Expecting).greet()
    talk = Dialogue(FastTcp)
    with pytest.raises(Stalled, match="greeted"):
        talk.reply([1])


def test_end_runs_steps_as_far_as_bytes_go() -> None:
    end = End(piece=2)
    end.begin(end.stream.read_exact(5))
    end.feed(b"abc")
    assert not end.done
    end.feed(b"defgh")
    assert end.done
    assert end.result == b"abcde"
    assert end.stream.waiting == 3
    end.begin(end.stream.read_exact(8))
    with pytest.raises(LinkClosed):
        end.feed_eof()


def test_end_gives_what_was_written() -> None:
    end = End()
    end.stream.write(b"one", b"two")
    assert end.take() == b"onetwo"
    assert end.take() == b""


def test_drive_carries_bytes_both_ways() -> None:
    def echo(end: End, rounds: int) -> Steps[int]:
        for _ in range(rounds):
            end.stream.write((yield from end.stream.read_exact(1)))
        return rounds

    left, right = End(), End()
    left.begin(echo(left, 5))
    right.begin(echo(right, 5))
    left.stream.write(b"x")
    traffic: list[tuple[str, bytes]] = []
    drive(left, right, traffic)
    assert left.result == right.result == 5
    assert len(traffic) == 11
