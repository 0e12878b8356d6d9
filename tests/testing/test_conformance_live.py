"""The suite between two ports finds what is wrong with a carrier, and leaves nothing behind."""

from __future__ import annotations

from unittest import SkipTest

import pytest
from support.mutant import NoEnvelope, OddReply, Plain

from yarpy import registry
from yarpy.carriers.base import Carrier
from yarpy.errors import YarpError
from yarpy.testing.conformance_live import LiveConformance
from yarpy.wire.message import Packet
from yarpy.wire.stream import ByteStream


class Mute(Plain):
    """Says nothing of what it is given."""

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        pass


class Speechless(Plain):
    """Carries no replies, and says so."""

    replies = False


MUTANTS: list[tuple[type[Carrier], str]] = [
    (NoEnvelope, "test_live_messages"),
    (OddReply, "test_live_calls"),
    (Mute, "test_live_sizes"),
    (Mute, "test_live_goodbye"),
    (Mute, "test_live_sender_vanishes"),
]


def suite(kind: type[Carrier]) -> LiveConformance:
    facts = {"carrier": kind, "timeout": 1.0}
    made: type[LiveConformance] = type("Suite", (LiveConformance,), facts)
    return made()


@pytest.mark.parametrize(("mutant", "test"), MUTANTS)
def test_mutant_is_found(mutant: type[Carrier], test: str) -> None:
    with pytest.raises((AssertionError, YarpError)):
        getattr(suite(mutant), test)()
    assert mutant.name not in registry.carriers.names()


def test_what_a_carrier_cannot_do_is_not_asked_of_it() -> None:
    with pytest.raises(SkipTest, match="carries no calls"):
        suite(Speechless).test_live_calls()


class TestPlain(LiveConformance):
    """A carrier need not be installed."""

    carrier = Plain
