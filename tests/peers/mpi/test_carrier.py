"""mpi: what is said over TCP before both move into MPI."""

from __future__ import annotations

import pytest

from yarpy.errors import LinkClosed, RemoteProtocolError
from yarpy.peers.mpi.carrier import Bcast, Mpi
from yarpy.route import Route
from yarpy.testing import End
from yarpy.testing.conformance_dialogue import DialogueConformance
from yarpy.wire.message import Packet
from yarpy.wire.stream import ByteStream

GREETING = b"MPI_____/out\r\ninitiator\r\nsomewhere\r\n"


class TestMpi(DialogueConformance):
    """Not its live half: MPI joins no two ports of one program."""

    carrier = Mpi


class TestBcast(DialogueConformance):
    carrier = Bcast


def test_bcast_says_goodbye_to_one_reader_only() -> None:
    carrier, stream = Bcast(Route("/out", "/in", "bcast")), ByteStream()
    carrier.encode_quit(stream)
    assert stream.take_output() == []
    end = End()
    end.begin(carrier.greet(end.stream))
    assert end.take() == b"MPIBCAST" + GREETING[8:]


def test_greeting_is_that_of_cpp() -> None:
    """Three lines, and the sender's name without modifiers."""
    end = End()
    end.begin(Mpi(Route("/out", "/in", "mpi+key.value")).greet(end.stream))
    assert end.done
    assert end.take() == GREETING
    assert [(place.kind, place.listen, place.group) for place in end.opened] == [
        ("mpi", False, "/in<-/out")
    ]


@pytest.mark.parametrize("piece", [0, 1])
def test_welcome(piece: int) -> None:
    end, carrier = End(piece), Mpi(Route("", "/in", "mpi"))
    end.begin(carrier.welcome(end.stream, GREETING[:8]))
    end.feed(b"/out\r\nvm____pid____4711\r\ntag#0$description#5\r\n")
    assert end.done
    assert carrier.route.source == "/out"
    assert [(place.kind, place.listen, place.group) for place in end.opened] == [
        ("mpi", True, "/in<-/out")
    ]
    assert end.take() == b""


def test_ports_of_one_program() -> None:
    end = End()
    end.begin(Mpi(Route("", "/in", "mpi")).welcome(end.stream, GREETING[:8]))
    with pytest.raises(RemoteProtocolError, match="take local or tcp"):
        end.feed(b"/out\r\nacceptor\r\nsomewhere\r\n")
    assert end.take() == b"* mpi joins no two ports of one program: take local or tcp\r\n"


def test_a_greeting_that_breaks_off() -> None:
    end = End()
    end.begin(Mpi(Route("", "/in", "mpi")).welcome(end.stream, GREETING[:8]))
    end.feed(b"/out\r\nvm")
    with pytest.raises(LinkClosed):
        end.feed_eof()


def test_a_line_without_end() -> None:
    end = End()
    end.begin(Mpi(Route("", "/in", "mpi")).welcome(end.stream, GREETING[:8]))
    with pytest.raises(RemoteProtocolError):
        for _ in range(100):
            end.feed(b"x" * 1000)


def test_messages_have_no_index() -> None:
    carrier, stream = Mpi(Route("/out", "/in", "mpi")), ByteStream()
    carrier.encode(stream, Packet([5]))
    assert b"".join(stream.take_output()).hex(" ") == (
        "00 00 00 00 7e 44 00 01 01 01 00 00 01 00 00 00 05 00 00 00"
    )
