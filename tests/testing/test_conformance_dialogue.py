"""The suite without a transport finds what is wrong with a carrier: each mutant fails a test."""

from __future__ import annotations

import pytest
from support.mutant import NoEnvelope, OddReply, Plain

from yarpy import registry
from yarpy.carriers.base import Carrier
from yarpy.carriers.own.tcp import Tcp
from yarpy.errors import UnknownPlugin, YarpError
from yarpy.facts import CarrierRow
from yarpy.registry import CarrierRegistry
from yarpy.shipped import CARRIERS, SHIPPED
from yarpy.testing.conformance_dialogue import DialogueConformance
from yarpy.wire import framing
from yarpy.wire.message import Message
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream


class WithoutName(Plain):
    name = ""


class LongMagic(Plain):
    magic = b"PLAIN____AND_MORE"


class Greedy(Plain):
    """Claims whatever begins with the letter of others."""

    magic = b"C"

    @classmethod
    def recognises(cls, first: bytes) -> int:
        return 8 if first[:1] in (b"C", b"Y") else 0


class Shy(Plain):
    """Does not know its own greeting."""

    @classmethod
    def recognises(cls, first: bytes) -> int:
        return 0


class Nameless(Plain):
    """Forgets who dialled."""

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[Carrier | None]:
        yield from super().welcome(stream, first)
        self.route.source = "somebody"
        return None


class Impatient(Plain):
    """Takes what has come for a whole message."""

    def decode(self, stream: ByteStream) -> Steps[Message]:
        yield from stream.more(1)
        data = bytes(stream.buffer[stream.head : stream.tail])
        stream.head = stream.tail
        size = int.from_bytes(data[26:30], "little")
        return Message("D", data[-size:] if size else b"")


class Crashing(Plain):
    """Lets the errors of Python out."""

    def decode(self, stream: ByteStream) -> Steps[Message]:
        head = yield from stream.read_exact(18)
        assert head[8] < 3, "so many blocks"
        if head[:8] != framing.INDEX:
            raise KeyError(head[:8])
        sizes = yield from stream.read_exact(4 * (head[8] + head[9]))
        command = yield from stream.read_exact(8)
        total = int.from_bytes(sizes[4:8], "little")
        message = Message(chr(command[5]))
        message.payload = yield from stream.read_exact(total)
        return message


class Trusting(Plain):
    """Takes memory for whatever is announced."""

    def decode(self, stream: ByteStream) -> Steps[Message]:
        yield from stream.more(34)
        size = int.from_bytes(stream.buffer[stream.head + 22 : stream.head + 26], "little")
        reserved = bytearray(min(size, 1 << 28))
        message = yield from super().decode(stream)
        del reserved
        return message


class Deaf(Plain):
    """Never notices that the peer hung up."""

    def decode(self, stream: ByteStream) -> Steps[Message]:
        while stream.waiting < 8:
            yield None
        return (yield from super().decode(stream))


class SilentAck(Tcp):
    """Says that it acknowledges, and does not."""

    name = "plain"
    code = 4 + 128

    @classmethod
    def matches(cls, value: int) -> bool:
        return value == cls.code

    def encode_ack(self, stream: ByteStream, count: int) -> None:
        pass


MUTANTS: list[tuple[type[Carrier], str]] = [
    (WithoutName, "test_facts"),
    (LongMagic, "test_facts"),
    (Greedy, "test_others_are_left_alone"),
    (Shy, "test_its_own_greeting_is_recognised"),
    (Nameless, "test_greeting_names_the_sender"),
    (Impatient, "test_messages_arrive"),
    (Crashing, "test_damaged_bytes_are_our_errors"),
    (Trusting, "test_lengths_are_not_believed"),
    (Deaf, "test_end_at_any_byte_is_noticed"),
    (NoEnvelope, "test_messages_arrive"),
    (SilentAck, "test_acknowledgements_are_seen"),
    (OddReply, "test_replies_come_back"),
]


def suite(kind: type[Carrier]) -> DialogueConformance:
    made: type[DialogueConformance] = type("Suite", (DialogueConformance,), {"carrier": kind})
    return made()


@pytest.mark.parametrize(("mutant", "test"), MUTANTS, ids=[f"{m.__name__}" for m, _ in MUTANTS])
def test_mutant_is_found(mutant: type[Carrier], test: str) -> None:
    with pytest.raises((AssertionError, YarpError)):
        getattr(suite(mutant), test)()


def test_carriers_whose_library_is_missing_are_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    rows = {**CARRIERS, "gone": CarrierRow("gone", "yarpy.gone.carrier:Gone")}
    monkeypatch.setattr(registry, "carriers", CarrierRegistry(rows))
    monkeypatch.setitem(SHIPPED, "carriers", rows)
    with pytest.raises(UnknownPlugin):
        registry.carriers.load("gone")
    suite(Plain).test_others_are_left_alone()
    with pytest.raises(AssertionError, match="mistaken"):
        suite(Greedy).test_others_are_left_alone()


class TestPlain(DialogueConformance):
    """A carrier of nothing but facts is complete."""

    carrier = Plain
