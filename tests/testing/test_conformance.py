"""The conformance suite finds what is wrong with a carrier: each mutant fails the test it should.

Every shipped carrier passes it in tests/carriers; here its teeth are tested.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from yarpy.carriers.base import Carrier
from yarpy.carriers.tcp import FastTcp, Tcp
from yarpy.errors import YarpError
from yarpy.testing import CarrierConformance
from yarpy.wire import framing
from yarpy.wire.effects import Steps
from yarpy.wire.message import Message, Packet
from yarpy.wire.stream import ByteStream


class Plain(Carrier):
    """A carrier that is right: what the mutants have in common."""

    name = "plain"
    magic = b"PLAIN___"


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

    def introduce(self, text: str) -> None:
        self.route.source = "somebody"


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


class NoEnvelope(Plain):
    def encode(self, stream: ByteStream, packet: Packet) -> None:
        super().encode(stream, Packet(packet.value, key=packet.key))


class SilentAck(Tcp):
    """Says that it acknowledges, and does not."""

    name = "plain"
    code = 4 + 128

    @classmethod
    def matches(cls, value: int) -> bool:
        return value == cls.code

    def encode_ack(self, stream: ByteStream) -> None:
        pass


class OddReply(FastTcp):
    """Replies with something else."""

    name = "plain"
    code = 4

    @classmethod
    def matches(cls, value: int) -> bool:
        return value == cls.code

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        super().encode_reply(stream, ["wrong"])


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
    (NoEnvelope, "test_live_messages"),
    (SilentAck, "test_acknowledgements_are_seen"),
    (OddReply, "test_replies_come_back"),
    (OddReply, "test_live_calls"),
]


def suite(kind: type[Carrier]) -> CarrierConformance:
    made: type[CarrierConformance] = type("Suite", (CarrierConformance,), {"carrier": kind})
    return made()


@pytest.mark.parametrize(("mutant", "test"), MUTANTS, ids=[f"{m.__name__}" for m, _ in MUTANTS])
def test_mutant_is_found(mutant: type[Carrier], test: str) -> None:
    with pytest.raises((AssertionError, YarpError)):
        getattr(suite(mutant), test)()


class TestPlain(CarrierConformance):
    """A carrier of nothing but facts is complete, and need not be installed."""

    carrier = Plain


def test_suite_works_without_pytest(tmp_path: Path) -> None:
    """Its methods are plain; `import yarpy.testing` loads no pytest."""
    code = """
import sys
sys.modules["pytest"] = None
from unittest import SkipTest
from yarpy.carriers.tcp import Tcp
from yarpy.testing import CarrierConformance
class Suite(CarrierConformance):
    carrier = Tcp
count = 0
for name in dir(Suite):
    if name.startswith("test_"):
        try:
            getattr(Suite(), name)()
            count += 1
        except SkipTest:
            pass
print(count)
"""
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=60, cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) >= 17


def test_suite_is_found_by_pytest_through_a_subclass() -> None:
    """Names of tests are what a reader of a report sees."""
    tests = [name for name in dir(CarrierConformance) if name.startswith("test_")]
    assert all(getattr(CarrierConformance, name).__doc__ for name in tests)
    assert not CarrierConformance.__name__.startswith("Test")
    values: Any = CarrierConformance.values
    assert len(values) > 8
