"""Tests of a carrier without a transport: recognition, greeting, messages, bad peers.

Rules: two sides are driven by hand (`yarpy.testing.drive`), with whole messages and byte by byte,
so that any failure is in the protocol.
"""

from __future__ import annotations

import random
import struct
import tracemalloc
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any
from unittest import SkipTest

from yarpy import registry
from yarpy.carriers.base import Carrier, Delivery, Limits
from yarpy.errors import UnknownPlugin, YarpError
from yarpy.facts import MAGIC_SIZE
from yarpy.route import parse_carrier
from yarpy.shipped import SHIPPED
from yarpy.testing.conformance_case import ENVELOPE, ConformanceCase
from yarpy.testing.drive import Dialogue, End, Stalled
from yarpy.wire.message import CALL, DATA, UNSENDABLE, Message, Packet
from yarpy.wire.stream import FIRST_GRANT, ByteStream, ObjectStream

PIECES = (0, 1, 7)


class DialogueConformance(ConformanceCase):
    """The carrier against itself, and against peers that break the rules."""

    # -- recognition ------------------------------------------------------------------------------

    def test_facts(self) -> None:
        """The class says what it is."""
        carrier = self.carrier
        assert issubclass(carrier, Carrier), f"{carrier.__name__} is not a Carrier"
        assert carrier.name, f"{carrier.__name__} has no name"
        assert "+" not in carrier.name, "the name contains `+`, which begins a modifier"
        assert ":" not in carrier.name, "the name contains `:`, which ends a carrier"
        assert len(carrier.magic) <= MAGIC_SIZE, f"the magic has more than {MAGIC_SIZE} bytes"
        assert carrier.spelling in ("binary", "text", "object"), carrier.spelling
        assert isinstance(carrier.delivery, Delivery), f"delivery is {carrier.delivery!r}"
        assert isinstance(carrier.limits, Limits), f"limits is {carrier.limits!r}"

    def test_its_own_greeting_is_recognised(self) -> None:
        """Among all installed carriers the first eight bytes choose this one."""
        talk = self._greeted()
        talk.send(self.values[0])
        chosen = type(talk.accepting)
        assert chosen is self.carrier, f"{chosen.__name__} was chosen"

    def test_others_are_left_alone(self) -> None:
        """The shipped carriers, and unknown bytes, are not mistaken for this one."""
        for name in SHIPPED["carriers"]:
            try:
                other = registry.carriers.load(name)
            except UnknownPlugin:  # a library that it needs is not installed
                continue
            if other.name == self.carrier.name or other.reaches.topic:
                continue
            first = _opening(other)
            if not other.recognises(first):
                continue  # it begins like another one, as tls does like tcp
            own = self.carrier.recognises(first)
            assert own < other.recognises(first), (
                f"a connection of {name} would be mistaken for {self.carrier.name}"
            )
        for first in (b"GARBAGE!", bytes(8), b"\r\n" * 4, b"connect ", b"\xff" * 8):
            assert not self.carrier.recognises(first), f"{first!r} is mistaken for a greeting"

    # -- greeting ---------------------------------------------------------------------------------

    def test_greeting_names_the_sender(self) -> None:
        """Whole and byte by byte, with the modifiers of the connection."""
        for piece in PIECES:
            for modifiers in (self.modifiers, self.modifiers + "+key.value"):
                talk = self._greeted(piece, modifiers)
                talk.send(self.values[0])
                assert talk.accepting is not None
                route = talk.accepting.route
                assert route.target == "/receiver", route
                if self.names_sender:
                    assert route.source == "/sender", route
                    assert route.carrier.startswith(self.carrier.name), route
                    told = "key" in modifiers and self.carrier.reaches.tells
                    assert route.carrier.endswith("+key.value") == told, route

    def test_long_names_arrive(self) -> None:
        """Port names have up to 900 bytes."""
        name = "/" + "n" * 899
        talk = Dialogue(self.carrier, self.modifiers, source=name)
        talk.greet()
        talk.send(self.values[0])
        if self.names_sender:
            assert talk.accepting is not None
            assert talk.accepting.route.source == name

    # -- messages ---------------------------------------------------------------------------------

    def test_messages_arrive(self) -> None:
        """Every value, whole and in pieces, with and without an envelope, as data and as call."""
        for piece in PIECES:
            talk = self._greeted(piece)
            for value in self.values:
                for key in (DATA, CALL) if self.carrier.replies else (DATA,):
                    for envelope in ("", ENVELOPE) if self.carries_envelopes else ("",):
                        message = talk.send(value, envelope, key)
                        self._check(message, value)
                        assert message.envelope == envelope, f"envelope {message.envelope!r}"
                        assert message.key in (key, CALL), f"port command {message.key!r}"
                        self._acknowledge(talk)

    def test_messages_of_all_sizes_arrive(self) -> None:
        """Sizes around those at which buffering changes."""
        talk = self._greeted()
        for size in self.sizes:
            value = self.of_size(size)
            self._check(talk.send(value), value)
            self._acknowledge(talk)

    def test_messages_in_a_burst_keep_their_borders(self) -> None:
        """Several messages are written before the first is read."""
        for piece in PIECES:
            talk = self._greeted(piece)
            self._check(talk.send(self.values[0]), self.values[0])
            self._acknowledge(talk)
            end, carrier = talk.sender
            receiver, receiving = talk.receiver
            assert receiving is not None
            for value in self.values:
                _encode(carrier, end.stream, value)
            found: list[Message] = []
            receiver.begin(_several(receiving, receiver, len(self.values), found))
            talk.pump()
            assert len(found) == len(self.values), f"{len(found)} of {len(self.values)} came"
            for message, value in zip(found, self.values, strict=True):
                self._check(message, value)

    def test_sender_may_reuse_what_it_sent(self) -> None:
        """The same value sent twice is the same message twice."""
        talk = self._greeted()
        for _ in range(2):
            self._check(talk.send(self.values[-1]), self.values[-1])
            self._acknowledge(talk)

    # -- what comes back --------------------------------------------------------------------------

    def test_replies_come_back(self) -> None:
        """The answer to a call, whole and in pieces, and the next message after it."""
        if not self.carrier.replies:
            raise SkipTest(f"{self.carrier.name} carries no replies")
        for piece in PIECES:
            talk = self._greeted(piece)
            for value in self.values:
                self._check(talk.send(value, key=CALL), value)
                reply = talk.reply(value)
                assert reply is not None, "the reply was not recognised"
                self._check(reply, value)

    def test_acknowledgements_are_seen(self) -> None:
        """One for each message; it also ends a call without a reply."""
        talk = self._greeted()
        talk.send(self.values[0])
        if not self._acknowledges(talk):
            raise SkipTest(f"{self.carrier.name} does not acknowledge")
        talk.acknowledge()
        for value in self.values:
            talk.send(value)
            talk.acknowledge()
        if self.carrier.replies and self.carrier.spelling != "object":
            talk.send(self.values[0], key=CALL)
            assert talk.acknowledge(replied=True) is None, "the acknowledgement is read as a reply"

    def test_acknowledgements_in_bulk_are_single_ones(self) -> None:
        """Several together, written or read, are the same bytes as one by one."""
        talk = self._greeted()
        message = talk.send(self.values[0])
        receiver, writing = talk.receiver
        sender, reading = talk.sender
        assert writing is not None
        if not self._acknowledges(talk) or message.key != DATA:
            raise SkipTest(f"{self.carrier.name} has no acknowledgements, or only one at a time")
        talk.acknowledge()
        for count in (1, 2, 5):
            for _ in range(count):
                talk.send(self.values[0])
            writing.encode_ack(receiver.stream, count)
            talk.pump()
            taken = reading.parse_acks(sender.stream, count - 1)
            assert 0 <= taken < count, f"parse_acks took {taken} of at most {count - 1}"
            for _ in range(count - taken):
                sender.begin(reading.expect_ack(sender.stream))
                assert sender.done, f"{count} were written, {taken} taken in bulk, then one missing"
            left = sender.stream.waiting
            assert not left, f"{left} bytes are left of {count} acknowledgements"

    def test_quit_ends_in_good_order(self) -> None:
        """A goodbye is understood; a carrier without one writes nothing."""
        for piece in PIECES:
            talk = self._greeted(piece)
            talk.send(self.values[0])
            self._acknowledge(talk)
            message = talk.quit()
            if message is not None:
                assert message.key == "q", f"the goodbye is read as {message.key!r}"

    # -- bad peers --------------------------------------------------------------------------------

    def test_end_at_any_byte_is_noticed(self) -> None:
        """A peer that hangs up anywhere in the dialogue causes one of our errors and no hang."""
        wire = self._recorded()
        for size in range(len(wire) + 1):
            end, found = self._reader()
            with _only_our_errors(f"after {size} bytes of {wire!r}"):
                end.feed(wire[:size])
                end.feed_eof()
                assert end.done, f"nothing happens when the peer hangs up after {size} bytes"
            assert len(found) <= 1

    def test_damaged_bytes_are_our_errors(self) -> None:
        """Bytes changed, put in, taken out: YarpError or nothing."""
        wire = self._recorded()
        chance = random.Random(1)
        for _ in range(400):
            data = bytearray(wire)
            for _ in range(chance.randint(1, 4)):
                at = chance.randrange(len(data) + 1)
                kind = chance.randrange(3)
                if kind == 0:
                    data[at : at + 1] = chance.randbytes(1)
                elif kind == 1:
                    data[at:at] = chance.randbytes(chance.randint(1, 9))
                else:
                    del data[at : at + chance.randint(1, 9)]
            end, found = self._reader()
            with _only_our_errors(f"from {bytes(data)!r}"):
                end.feed(bytes(data))
                end.feed_eof()
            for message in found:
                with _only_our_errors(f"decoding {message!r}"):
                    _ = message.value

    def test_lengths_are_not_believed(self) -> None:
        """No four bytes of a message make its reader allocate a gigabyte before it arrives."""
        wire = self._recorded()
        huge = struct.pack("<i", (1 << 30) - 200)
        for at in range(len(wire) - 3):
            end, _ = self._reader()
            tracemalloc.start()
            try:
                with _only_our_errors(f"with a huge number at byte {at}"):
                    end.feed(wire[:at] + huge + wire[at + 4 :])
                taken = tracemalloc.get_traced_memory()[1]
            finally:
                tracemalloc.stop()
            assert taken < FIRST_GRANT + (1 << 20), f"{taken} bytes for a number at byte {at}"

    # -- inside -----------------------------------------------------------------------------------

    def _recorded(self) -> bytes:
        """The bytes of one message, as sent after the greeting."""
        talk = self._greeted()
        if isinstance(talk.acceptor.stream, ObjectStream):
            raise SkipTest(f"{self.carrier.name} carries objects, not bytes")
        talk.send(self.values[0])
        self._acknowledge(talk)
        end, carrier = talk.sender
        _encode(carrier, end.stream, [1, "two", [3.5]], ENVELOPE if self.carries_envelopes else "")
        return end.take()

    def _reader(self) -> tuple[End, list[Message]]:
        """A receiver that goes on reading after its first message, and what it reads."""
        talk = self._greeted()
        talk.send(self.values[0])
        self._acknowledge(talk)
        end, carrier = talk.receiver
        assert carrier is not None
        found: list[Message] = []
        end.begin(_several(carrier, end, 1000, found))
        return end, found


def _opening(carrier: type[Carrier]) -> bytes:
    """The first eight bytes of a connection over `carrier`; its magic if it never dials, or if its
    first bytes depend on a message that it does not carry."""
    talk = Dialogue(carrier)
    try:
        talk = Dialogue(carrier.of(parse_carrier(carrier.name)))
        talk.greet()
        if not talk.traffic:
            talk.send([1])
    except (YarpError, Stalled, *UNSENDABLE):
        pass
    return _first(talk).ljust(MAGIC_SIZE) if talk.traffic else carrier.magic.ljust(MAGIC_SIZE)


def _first(talk: Dialogue) -> bytes:
    """The first eight bytes that the initiator sent."""
    spoken = (item for who, item in talk.traffic if who == "initiator")
    return b"".join(bytes(item) for item in spoken if not isinstance(item, Message))[:MAGIC_SIZE]


def _encode(carrier: Carrier, stream: ByteStream, value: Any, envelope: str = "") -> None:
    carrier.encode(stream, Packet(value, envelope.encode()))


def _several(carrier: Carrier, end: End, count: int, found: list[Message]) -> Any:
    """Steps that read `count` messages, as a link does."""
    while len(found) < count:
        message = carrier.parse(end.stream) if end.stream.waiting else None
        found.append((yield from carrier.decode(end.stream)) if message is None else message)


@contextmanager
def _only_our_errors(where: str) -> Iterator[None]:
    try:
        yield
    except YarpError:
        pass
    except AssertionError:
        raise
    except Exception as error:
        raise AssertionError(f"{type(error).__name__}: {error} {where}") from error
