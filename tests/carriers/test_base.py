"""The contract of carriers: defaults, recognition among others."""

from __future__ import annotations

import pytest

from yarpy import registry
from yarpy.carriers.base import Carrier, Indexed, refuse_unknown
from yarpy.carriers.own.tcp import Tcp
from yarpy.errors import LocalProtocolError
from yarpy.link.begin.handshake import recognise
from yarpy.route import Route, parse_carrier
from yarpy.testing import CarrierConformance
from yarpy.wire import framing
from yarpy.wire.stream import ByteStream


@pytest.mark.parametrize(
    "text", ["facts", "facts+a+b.3", "facts+tls+log.in", "facts+c.1+send.throttle+period_ms.10"]
)
def test_known_additions(text: str) -> None:
    refuse_unknown(parse_carrier(text), ("a", "b.VALUE"))


@pytest.mark.parametrize("text", ["facts+c", "facts+a+c.secret", "facts+", "facts+send"])
def test_unknown_additions_are_named_without_their_values(text: str) -> None:
    with pytest.raises(LocalProtocolError, match=r'facts knows no "\+(c|send|)", but \+a, \+b.V'):
        refuse_unknown(parse_carrier(text), ("a", "b.VALUE"))


class Facts(Carrier):
    """Nothing but a name and a magic."""

    name = "facts"
    magic = b"FACTS"


class Coded(Indexed):
    name = "coded"
    code = 7


class TestDefaults(CarrierConformance):
    carrier = Facts


class TestIndexed(CarrierConformance):
    carrier = Coded


def test_the_contract_is_small() -> None:
    """C++ has 45 virtual functions. What belongs together is one value: Delivery, Limits, Reach."""
    assert len([name for name in vars(Carrier) if not name.startswith("_")]) <= 32


def test_magic_may_be_shorter_than_eight_bytes() -> None:
    assert Facts.recognises(b"FACTS123") == 5
    assert Facts.recognises(b"FACT5123") == 0
    assert Carrier.recognises(bytes(8)) == 0  # no magic, no connections


class LongerFacts(Facts):
    magic = b"FACTS12"


def test_longest_magic_wins() -> None:
    for order in ([Facts, LongerFacts], [LongerFacts, Facts]):
        assert recognise(b"FACTS123", order) is LongerFacts
        assert recognise(b"FACTS999", order) is Facts
        assert recognise(b"NOTHING!", order) is None


SHIPPED = [
    (b"CONNECT ", "text"),
    (b"CONNACK ", "text_ack"),
    (b"LOCALITY", "local"),
    (b"NAME_SER", "name_ser"),
    (b"UNIX_STR", "unix_stream"),
    (b"UNIX_ACK", "unix_stream"),
    *(
        (framing.number(framing.BASE + code), name)
        for code, name in [
            (0, "udp"),
            (128, "udp"),
            (16, "udp"),
            (1, "mcast"),
            (129, "mcast"),
            (3, "fast_tcp"),
            (19, "fast_tcp"),
            (131, "tcp"),
            (147, "tcp"),
        ]
    ),
]


@pytest.mark.parametrize(("first", "name"), SHIPPED)
def test_first_bytes_of_cpp_choose_the_shipped_carrier(first: bytes, name: str) -> None:
    kind = recognise(first)
    assert kind is registry.carriers.load(name)


@pytest.mark.parametrize(
    "first",
    [
        b"GARBAGE!",
        b"connect ",
        b"\r\n\r\n\r\n\r\n",
        bytes(8),
        framing.number(framing.BASE + 5),
        framing.number(framing.BASE - 1),
        framing.number(10),
        framing.ACK,
    ],
)
def test_bytes_that_nobody_knows(first: bytes) -> None:
    assert recognise(first) is None


def test_route_of_the_acceptor_is_filled_in() -> None:
    carrier = Tcp(Route("", "/target", "tcp", 21602))
    carrier.route.introduce("/w (recv foo) (x)")
    assert carrier.route == Route("/w", "/target", "tcp+recv.foo+x", 21602)
    assert carrier.route.specifier == "/w (recv foo) (x)"


def test_people_are_told_nothing_on_binary_carriers() -> None:
    stream = ByteStream()
    Tcp(Route("/a", "/b")).encode_lines(stream, ["This is a port"])
    assert not stream.pending
