"""CarrierConformance: what every carrier must do, as tests to inherit.

    class TestMine(CarrierConformance):
        carrier = MyCarrier

Rules: methods called `test_*` with plain asserts, as pytest runs them, but without need of it.
First without a transport (yarpy.testing.drive), then between two real ports of this process. What a
carrier cannot do by its facts (`replies`, `acks`, `spelling`) is not asked of it.
"""

from __future__ import annotations

import random
import struct
import time
import tracemalloc
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, ClassVar
from unittest import SkipTest

from yarpy import network, registry
from yarpy.carriers.base import MAGIC_SIZE, Carrier
from yarpy.data import codec
from yarpy.data.value import Vocab
from yarpy.errors import YarpError
from yarpy.names.local import LocalNames
from yarpy.port.port import Port
from yarpy.port.rpc import RpcClient, RpcServer
from yarpy.testing.drive import Dialogue, End, Stalled
from yarpy.wire.message import CALL, DATA, Message, Packet
from yarpy.wire.stream import FIRST_GRANT, ByteStream, ObjectStream

ENVELOPE = "7 1.25"
PIECES = (0, 1, 7)
SIZES = (0, 1, 100, 4095, 4096, 4097, 16384, 65535, 65536, 65537, 300_000)


class CarrierConformance:
    """Subclass it and set `carrier`.

    modifiers: what follows the carrier's name in connections, such as `+ack`.
    names_sender: the acceptor learns who dialled. carries_envelopes: envelopes arrive.
    values: messages to send; put in what your spelling can carry if it is not everything.
    patience: seconds that a live connection may take.
    """

    carrier: ClassVar[type[Carrier]]
    modifiers: ClassVar[str] = ""
    names_sender: ClassVar[bool] = True
    carries_envelopes: ClassVar[bool] = True
    values: ClassVar[Sequence[Any]] = (
        [],
        [1],
        [-1, 2**31 - 1, -(2**31), 2**40, 1.5, -0.0, 1e300],
        ["text", "", "two words", "\u00fc\u00f1\u00ee\u4f60", 'quo"te', "back\\slash"],
        [b"\0\1\xff", b""],
        [Vocab("set"), True, False],
        [[], [1, ["deep", [2.5]]], ["x", "y"]],
        {"key": 1, "group": {"inner": [1, 2]}},
        "a string",
        7,
        2.5,
    )
    sizes: ClassVar[Sequence[int]] = SIZES
    patience: ClassVar[float] = 5.0

    # -- to override where a spelling loses something ---------------------------------------------

    def expected(self, value: Any) -> Any:
        """What the receiver of `value` gets."""
        if self.carrier.spelling == "text":
            return codec.decode_text(codec.encode_text(value))
        if self.carrier.spelling == "object":
            return value
        return codec.decode(_joined(value))

    def of_size(self, size: int) -> Any:
        """A message of about `size` bytes."""
        if self.carrier.spelling == "text":
            return ["x" * size]
        return [bytes(size)]

    # -- recognition ------------------------------------------------------------------------------

    def test_facts(self) -> None:
        """The class says what it is."""
        carrier = self.carrier
        assert issubclass(carrier, Carrier), f"{carrier.__name__} is not a Carrier"
        assert carrier.name, f"{carrier.__name__} has no name"
        assert "+" not in carrier.name, "`+` begins a modifier"
        assert ":" not in carrier.name, "`:` ends a carrier"
        assert len(carrier.magic) <= MAGIC_SIZE, f"the magic has more than {MAGIC_SIZE} bytes"
        assert carrier.spelling in ("binary", "text", "object"), carrier.spelling

    def test_its_own_greeting_is_recognised(self) -> None:
        """Among all installed carriers the first eight bytes choose this one."""
        talk = self._greeted()
        talk.send(self.values[0])
        chosen = type(talk.accepting)
        assert chosen is self.carrier, f"{chosen.__name__} was chosen"

    def test_others_are_left_alone(self) -> None:
        """The shipped carriers, and bytes that nobody knows, are not taken for this one."""
        for name in registry.SHIPPED["carriers"]:
            other = registry.carriers.load(name)
            if other is self.carrier:
                continue
            first = _opening(other)
            own = self.carrier.recognises(first)
            assert own < max(other.recognises(first), 1), (
                f"a connection of {name} would be taken for {self.carrier.name}"
            )
        for first in (b"GARBAGE!", bytes(8), b"\r\n" * 4, b"connect ", b"\xff" * 8):
            assert not self.carrier.recognises(first), f"{first!r} is taken for a greeting"

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
                    assert route.carrier.endswith("+key.value") == ("key" in modifiers), route

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
        """Around the sizes where buffers change."""
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
                assert reply is not None, "the reply was taken for none"
                self._check(reply, value)

    def test_acknowledgements_are_seen(self) -> None:
        """One for each message; a call that nobody answers ends with it too."""
        talk = self._greeted()
        talk.send(self.values[0])
        _, carrier = talk.receiver
        assert carrier is not None
        if not carrier.acks:
            raise SkipTest(f"{self.carrier.name} does not acknowledge")
        talk.acknowledge()
        for value in self.values:
            talk.send(value)
            talk.acknowledge()
        if self.carrier.replies and self.carrier.spelling != "object":
            talk.send(self.values[0], key=CALL)
            assert talk.acknowledge(replied=True) is None, "the acknowledgement is read as a reply"

    def test_acknowledgements_in_bulk_are_single_ones(self) -> None:
        """Several written or taken at once are what one by one would be."""
        talk = self._greeted()
        message = talk.send(self.values[0])
        receiver, writing = talk.receiver
        sender, reading = talk.sender
        assert writing is not None
        if not writing.acks or message.key != DATA:
            raise SkipTest(f"{self.carrier.name} acknowledges nothing, or calls one by one")
        talk.acknowledge()
        for count in (1, 2, 5):
            for _ in range(count):
                talk.send(self.values[0])
            writing.encode_acks(receiver.stream, count)
            talk.pump()
            taken = reading.parse_acks(sender.stream, count - 1)
            assert 0 <= taken < count, f"{taken} acknowledgements were taken at once"
            for _ in range(count - taken):
                sender.begin(reading.expect_ack(sender.stream))
                assert sender.done, f"{count} were written, {taken} taken at once, then one missing"
            left = sender.stream.waiting
            assert not left, f"{left} bytes are left of {count} acknowledgements"

    def test_quit_ends_in_good_order(self) -> None:
        """A carrier with a goodbye is understood; one without writes nothing."""
        for piece in PIECES:
            talk = self._greeted(piece)
            talk.send(self.values[0])
            self._acknowledge(talk)
            message = talk.quit()
            if message is not None:
                assert message.key == "q", f"the goodbye is read as {message.key!r}"

    # -- bad peers --------------------------------------------------------------------------------

    def test_end_at_any_byte_is_noticed(self) -> None:
        """Whatever was sent so far: a peer that hangs up is an error of ours, not a silence."""
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
        """No four bytes of a message make its reader take a gigabyte before it has come."""
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

    # -- between two ports ------------------------------------------------------------------------

    def test_live_messages(self) -> None:
        """Real ports, connected by the carrier's name; every message is counted on both sides."""
        with self._offered(), _ports() as (names, sender, receiver):
            self._connect(names, sender, receiver)
            for number, value in enumerate(self.values):
                envelope = f"{number} 0.5" if self.carries_envelopes else None
                assert sender.write(value, envelope) == 1
                message = self._read(receiver)
                self._check(message, value)
                assert message.envelope == (envelope or "")
            count = len(self.values)
            assert sender.outputs[0].stats["messages"] == count
            assert receiver.inputs[0].stats["messages"] == count
            assert sender.outputs[0].stats["drops"] == receiver.inputs[0].stats["drops"] == 0

    def test_live_sizes(self) -> None:
        """Real ports, messages of every size."""
        with self._offered(), _ports() as (names, sender, receiver):
            self._connect(names, sender, receiver)
            for size in self.sizes:
                value = self.of_size(size)
                sender.write(value)
                self._check(self._read(receiver), value)

    def test_live_calls(self) -> None:
        """A server and a client that call each other over this carrier."""
        if not self.carrier.replies or not self.carrier.push:
            raise SkipTest(f"{self.carrier.name} carries no calls")
        with self._offered():
            names = LocalNames()
            echo: Callable[[Message], Any] = lambda message: message.value  # noqa: E731
            with (
                RpcServer("/receiver", echo, names=names),
                RpcClient(name="/sender", names=names) as client,
            ):
                client.connect("/receiver", self.carrier.name + self.modifiers)
                for value in self.values:
                    reply = client.ask(value, timeout=self.patience)
                    assert reply is not None, "no reply came"
                    self._check(reply, value)

    def test_live_goodbye(self) -> None:
        """Disconnecting reaches the other side, and connecting again works."""
        with self._offered(), _ports() as (names, sender, receiver):
            for _ in range(2):
                self._connect(names, sender, receiver)
                sender.write(self.values[0])
                self._read(receiver)
                assert network.disconnect("/sender", "/receiver", names=names)
                if self.carrier.push:
                    assert not sender.outputs, "the sender keeps its output"
                else:  # who was dialled notices
                    _await(lambda: not sender.outputs, self.patience, "the sender keeps its output")
                _await(lambda: not receiver.inputs, self.patience, "the receiver keeps its input")

    def test_live_sender_vanishes(self) -> None:
        """A sender that closes leaves nothing behind at its receiver."""
        with self._offered(), _ports() as (names, sender, receiver):
            self._connect(names, sender, receiver)
            sender.write(self.values[0])
            self._read(receiver)
            sender.close()
            _await(lambda: not receiver.inputs, self.patience, "the receiver keeps its input")

    # -- inside -----------------------------------------------------------------------------------

    def _greeted(self, piece: int = 0, modifiers: str | None = None) -> Dialogue:
        talk = Dialogue(
            self.carrier, self.modifiers if modifiers is None else modifiers, piece=piece
        )
        talk.greet()
        return talk

    def _check(self, message: Message, value: Any) -> None:
        wanted, got = self.expected(value), message.value
        same = got is wanted or _joined(got) == _joined(wanted)
        assert same, f"{value!r} arrived as {got!r}, not as {wanted!r}"

    def _acknowledge(self, talk: Dialogue) -> None:
        _, carrier = talk.receiver
        if carrier is not None and carrier.acks:
            talk.acknowledge()

    def _recorded(self) -> bytes:
        """What a sender says after the greeting: one message."""
        talk = self._greeted()
        if isinstance(talk.acceptor.stream, ObjectStream):
            raise SkipTest(f"{self.carrier.name} carries objects, not bytes")
        talk.send(self.values[0])
        self._acknowledge(talk)
        end, carrier = talk.sender
        _encode(carrier, end.stream, [1, "two", [3.5]], ENVELOPE if self.carries_envelopes else "")
        return end.take()

    def _reader(self) -> tuple[End, list[Message]]:
        """A receiver after its first message that reads on, and what it reads."""
        talk = self._greeted()
        talk.send(self.values[0])
        self._acknowledge(talk)
        end, carrier = talk.receiver
        assert carrier is not None
        found: list[Message] = []
        end.begin(_several(carrier, end, 1000, found))
        return end, found

    @contextmanager
    def _offered(self) -> Iterator[None]:
        """The carrier can be found by its name, installed or not."""
        name = self.carrier.name
        if name in registry.carriers.names():
            yield
            return
        registry.carriers.add(name, self.carrier)
        try:
            yield
        finally:
            registry.carriers.remove(name)

    def _connect(self, names: LocalNames, sender: Port, receiver: Port) -> None:
        name = self.carrier.name + self.modifiers
        network.connect("/sender", "/receiver", name, names=names)
        assert sender.wait_for_outputs(timeout=self.patience), "the sender has no output"
        if self._greets():
            _await(lambda: receiver.inputs, self.patience, "the receiver has no input")
        assert sender.outputs[0].carrier == name
        if self.names_sender:
            assert receiver.inputs[0].carrier.startswith(self.carrier.name)

    def _read(self, receiver: Port) -> Message:
        message = receiver.read(timeout=self.patience)
        if message.wants_reply:  # where every message is a call, its connection waits for this
            message.reply([])
        return message

    def _greets(self) -> bool:
        """Whether the acceptor knows of the connection before the first message."""
        return bool(self._greeted().traffic)


@contextmanager
def _ports() -> Iterator[tuple[LocalNames, Port, Port]]:
    names = LocalNames()
    with Port("/sender", names=names) as sender, Port("/receiver", names=names) as receiver:
        yield names, sender, receiver


def _await(condition: Callable[[], object], patience: float, problem: str) -> None:
    deadline = time.monotonic() + patience
    while not condition():
        assert time.monotonic() < deadline, problem
        time.sleep(0.005)


def _joined(value: Any) -> bytes:
    return b"".join(bytes(block) for block in codec.encode(value))


def _opening(carrier: type[Carrier]) -> bytes:
    """The first eight bytes of a connection over `carrier`; its magic if it never dials, or what
    it says first depends on a message that it does not carry."""
    talk = Dialogue(carrier)
    try:
        talk.greet()
        if not talk.traffic:
            talk.send([1])
    except (YarpError, Stalled):
        pass
    return _first(talk).ljust(MAGIC_SIZE) if talk.traffic else carrier.magic.ljust(MAGIC_SIZE)


def _first(talk: Dialogue) -> bytes:
    """The first eight bytes that the initiator said."""
    spoken = (item for who, item in talk.traffic if who == "initiator")
    return b"".join(bytes(item) for item in spoken if not isinstance(item, Message))[:MAGIC_SIZE]


def _encode(carrier: Carrier, stream: ByteStream, value: Any, envelope: str = "") -> None:
    carrier.encode(stream, Packet(value, envelope.encode()))


def _several(carrier: Carrier, end: End, count: int, found: list[Message]) -> Any:
    """Steps that read `count` messages, as a link does it."""
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
