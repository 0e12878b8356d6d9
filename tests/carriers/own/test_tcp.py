"""tcp and fast_tcp: golden greetings and acknowledgements, and the conformance suite."""

from __future__ import annotations

import pytest
from support.capture import load_capture
from support.steps import chop

from yarpy.carriers.own.tcp import FastTcp, Tcp
from yarpy.data.value import Vocab
from yarpy.errors import RemoteProtocolError
from yarpy.route import Route
from yarpy.testing import CarrierConformance, Dialogue, End, said
from yarpy.wire import framing


class TestTcp(CarrierConformance):
    carrier = Tcp


class TestFastTcp(CarrierConformance):
    carrier = FastTcp


GREETINGS = [
    # carrier, its string, source, what the initiator says (captured)
    (Tcp, "tcp", "/cap/out", load_capture("conn_tcp_disconnect").steps[0].data),
    (FastTcp, "fast_tcp", "/cap/out", load_capture("conn_fast_tcp_stream").steps[0].data),
    (Tcp, "tcp", "/cap/rc", load_capture("conn_tcp_rpc").steps[0].data),
    (
        Tcp,
        "tcp+recv.foo+file.a.b.lua+x.1",
        "/w",
        bytes.fromhex(
            "5941e41e00005250 23000000 2f7720287265637620666f6f29202866696c652061206220"
            "6c7561292028782031 2900"
        ),
    ),
]


@pytest.mark.parametrize(("kind", "carrier", "source", "data"), GREETINGS)
def test_golden_greeting_is_written(
    kind: type[FastTcp], carrier: str, source: str, data: bytes
) -> None:
    end = End()
    end.begin(kind(Route(source, "/target", carrier)).greet(end.stream))
    assert end.take() == data
    end.feed(framing.number(21602))  # any number will do
    assert end.done


@pytest.mark.parametrize("piece", [0, 1])
@pytest.mark.parametrize(("kind", "carrier", "source", "data"), GREETINGS)
def test_golden_greeting_is_welcomed(
    kind: type[FastTcp], carrier: str, source: str, data: bytes, piece: int
) -> None:
    assert kind.recognises(data[:8]) == 8
    end = End()
    spoken = kind(Route("", "/target", kind.name, 21602))
    end.begin(spoken.welcome(end.stream, data[:8]))
    for part in chop(data[8:], piece):
        end.feed(part)
    assert end.done
    assert end.take() == framing.number(21602)
    assert spoken.route.source == source
    # of a modifier the first two words survive, as in C++
    assert spoken.route.carrier == carrier.replace("+file.a.b.lua", "+file.a")


CODES = [
    # the carrier's number, what it is taken for
    (3, FastTcp),
    (3 + 16, FastTcp),
    (3 + 128, Tcp),
    (19 + 128, Tcp),
    (2, None),
    (5, None),
    (-1, None),
]


@pytest.mark.parametrize(("code", "kind"), CODES)
def test_carrier_code_is_taken_modulo_16_with_bit_7(code: int, kind: type[FastTcp] | None) -> None:
    first = framing.number(framing.BASE + code)
    for candidate in (Tcp, FastTcp):
        assert bool(candidate.recognises(first)) == (candidate is kind)


def test_call_is_answered_by_the_bare_object_then_acknowledged() -> None:
    talk = Dialogue(Tcp)
    talk.greet()
    talk.traffic.clear()
    talk.send([42], key="d")
    reply = talk.reply([Vocab("ok"), [1, 2], 3.5])
    assert reply is not None
    assert reply.value == [Vocab("ok"), [1, 2], 3.5]
    # the list, with a vocab in front of a list and a number
    assert said(talk.traffic, "acceptor") == bytes.fromhex(
        "0001000003000000 09000000 6f6b0000 0101000002000000 01000000 02000000"
        "0a000000 0000000000000c40 5941000000005250"
    )


@pytest.mark.parametrize("kind", [Tcp, FastTcp])
def test_answer_that_is_no_number_is_refused(kind: type[FastTcp]) -> None:
    """A port with a key speaks first, and says something else."""
    end = End()
    end.begin(kind(Route("/a", "/b", kind.name)).greet(end.stream))
    with pytest.raises(RemoteProtocolError, match=r"auth\.conf"):
        end.feed(bytes(range(40)))


@pytest.mark.parametrize("extra", [0, 1, 8, 1000])
def test_acknowledgement_may_carry_bytes_to_ignore(extra: int) -> None:
    end = End(piece=3)
    carrier = Tcp(Route("/a", "/b"))
    end.begin(carrier.expect_ack(end.stream))
    end.feed(framing.number(extra) + bytes(extra))
    assert end.done
    assert end.stream.waiting == 0


def test_unanswered_call_is_told_by_the_acknowledgement() -> None:
    talk = Dialogue(Tcp, piece=1)
    talk.greet()
    talk.send([42], key="d")
    assert talk.acknowledge(replied=True) is None
    talk.send([43], key="d")
    assert talk.reply([44]) is not None


def test_fast_tcp_says_nothing_back() -> None:
    talk = Dialogue(FastTcp)
    talk.greet()
    talk.traffic.clear()
    for number in range(5):
        talk.send([number])
    assert said(talk.traffic, "acceptor") == b""
    assert not FastTcp.acks
