"""Drive carriers without a transport: one side by hand, or two against each other.

    talk = Dialogue(MyCarrier, piece=1)          # every byte arrives alone
    talk.greet()
    assert talk.send([1, "two"]).value == [1, "two"]
    assert talk.traffic == [("initiator", b"..."), ("acceptor", b"...")]

Rules: pure - no sockets, threads or clock. What a carrier asks of its driver (`Open`, `Switch`,
`Group`) is granted with simulated places. If both sides wait, that is an error, Stalled.
"""

from __future__ import annotations

from collections.abc import Iterable
from types import SimpleNamespace
from typing import Any

from yarpy import registry
from yarpy.carriers.base import Carrier
from yarpy.errors import RemoteProtocolError
from yarpy.facts import MAGIC_SIZE
from yarpy.link.begin.handshake import recognise
from yarpy.route import Route
from yarpy.wire.effects import Claim, Flush, Group, May, Open, Show, Switch, Within
from yarpy.wire.message import DATA, Message, Packet
from yarpy.wire.steps import Effect, Steps
from yarpy.wire.stream import DEFAULT_LIMIT, Buffer, ByteStream, DatagramStream, ObjectStream

TCP_PORT = 21602  # the port number that the accepting side always gives
UDP_PORT = 48669  # and of other places that the accepting side opens
GROUP = ("224.1.1.3", 21604)


class Stalled(AssertionError):
    """Both sides wait for bytes, or one waits for something the other never sends."""


class Handle:
    """A simulated place opened for a carrier: it has only a number and names."""

    def __init__(self, effect: Open) -> None:
        self.effect = effect
        numbered = effect.listen and effect.kind in ("udp", "shmem")
        self.port = UDP_PORT if numbered else effect.port
        self.program = "acceptor" if effect.listen else "initiator"
        self.place = "" if effect.listen else "somewhere"

    def close(self) -> None:
        """Nothing to release."""


class SimulatedMemory:
    """A simulated piece of shared memory: a payload is the number of its bytes in a list."""

    port = 1

    def __init__(self, payloads: list[bytes]) -> None:
        self.key = self
        self._payloads = payloads

    def place(self, blocks: Iterable[Buffer], size: int) -> SimpleNamespace:
        """Keep a payload."""
        self._payloads.append(b"".join(blocks))
        return SimpleNamespace(slot=len(self._payloads) - 1, generation=1, offset=0, size=size)

    def lend(self, payload: object) -> int:
        """The peer may have it: from the only memory there is."""
        return 0

    def take(self, where: int, slot: int, generation: int, offset: int, size: int) -> memoryview:
        """A payload that was kept. Raises RemoteProtocolError for any other."""
        if where or slot >= len(self._payloads) or offset + size > len(self._payloads[slot]):
            raise RemoteProtocolError("a payload that lies nowhere")
        return memoryview(self._payloads[slot])[offset : offset + size]

    def close(self) -> None:
        """Nothing to release."""


class End:
    """One side of a connection: a stream, and the steps running on it.

    `outbox` holds output that was not taken yet; `opened` the places it asked for. With `piece`,
    bytes arrive in portions of that size, and the steps run after each.
    """

    def __init__(self, piece: int = 0, limit: int = DEFAULT_LIMIT) -> None:
        self.piece = piece
        self.stream = ByteStream(limit)
        self.outbox: list[Any] = []
        self.opened: list[Open] = []
        self.payloads: list[bytes] = []  # what lies in memory that it shares
        self.done = True
        self.result: Any = None
        self._steps: Steps[Any] | None = None

    def begin(self, steps: Steps[Any]) -> None:
        """Run `steps` as far as the available bytes allow."""
        self._steps, self.done, self.result = steps, False, None
        self._advance()

    def feed(self, item: Any) -> None:
        """Bytes from the peer; one datagram on a datagram stream, an object on an object stream."""
        stream = self.stream
        if isinstance(stream, ObjectStream):
            stream.feed_object(item)
            self._advance()
        elif isinstance(stream, DatagramStream):
            stream.feed(item)
            self._advance()
        else:
            self._feed_bytes(stream, memoryview(item).cast("B"))

    def _feed_bytes(self, stream: ByteStream, rest: memoryview) -> None:
        while rest:
            if stream is not self.stream:
                raise Stalled(f"{len(rest)} bytes came after the connection had moved elsewhere")
            room = len(stream.get_buffer())
            if not room:
                raise Stalled("nobody reads, and the buffer is full")
            part = rest[: min(room, self.piece or room)]
            stream.feed(part)
            rest = rest[len(part) :]
            self._advance()

    def feed_eof(self) -> None:
        """The peer hangs up."""
        self.stream.feed_eof()
        self._advance()

    def collect(self) -> None:
        """Move output into the outbox."""
        self.outbox += self.stream.take_output()

    def take(self) -> bytes:
        """Everything written since the last call, joined."""
        self.collect()
        items, self.outbox = self.outbox, []
        return b"".join(bytes(item) for item in items)

    def _advance(self) -> None:
        if self._steps is None:
            return
        answer: Any = None
        try:
            while True:
                effect = self._steps.send(answer)
                self.collect()
                if effect is None:
                    return
                answer = self._grant(effect)
        except StopIteration as stop:
            self._steps, self.done, self.result = None, True, stop.value
            self.collect()
        except BaseException:
            self._steps = None
            raise

    def _grant(self, effect: Effect) -> Any:
        if isinstance(effect, Group):
            return GROUP
        if isinstance(effect, Open):
            self.opened.append(effect)
            return SimulatedMemory(self.payloads) if effect.kind == "memory" else Handle(effect)
        if isinstance(effect, Show | Within | May | Claim | Flush):
            return None  # no pages, all the time in the world, and no rules
        assert isinstance(effect, Switch)
        self.stream = effect.stream
        return None


class Dialogue:
    """A connection between two carriers of one kind, from the greeting to the goodbye.

    modifiers: appended to the carrier's name (`+ack`). piece: bytes that arrive together, 0: all.
    The acceptor is chosen by the first bytes among all installed carriers and `carrier`, as in a
    port. `traffic` is what each side sent, in order.
    """

    def __init__(
        self,
        carrier: type[Carrier],
        modifiers: str = "",
        *,
        source: str = "/sender",
        target: str = "/receiver",
        piece: int = 0,
        limit: int = DEFAULT_LIMIT,
    ) -> None:
        self.kind = carrier
        self.target = target
        self.initiator: End = End(piece, limit)
        self.acceptor: End = End(piece, limit)
        self.acceptor.payloads = self.initiator.payloads
        self.initiating = carrier(Route(source, target, carrier.name + modifiers, TCP_PORT))
        self.accepting: Carrier | None = None
        self.traffic: list[tuple[str, Any]] = []
        self._welcome: Steps[None] | None = None
        self._heard: Steps[None] | None = None

    @property
    def sender(self) -> tuple[End, Carrier]:
        """The side that sends data, and its carrier: the one that dialled, unless the carrier
        is a pull carrier."""
        if self.kind.push:
            return self.initiator, self.initiating
        return self.acceptor, self._accepted()

    @property
    def receiver(self) -> tuple[End, Carrier | None]:
        """The other side."""
        if self.kind.push:
            return self.acceptor, self.accepting
        return self.initiator, self.initiating

    def greet(self) -> None:
        """The greeting, both ways. If the initiator sends none it ends with the first message."""
        self._welcome = self._choose()
        self.acceptor.begin(self._welcome)
        self.initiator.begin(self.initiating.greet(self.initiator.stream))
        self.pump()
        if not self.initiator.done:
            raise Stalled("the greeting is not answered")

    def send(self, value: object, envelope: str = "", key: str = DATA) -> Message:
        """Encode `value` on one side; returns the message that the other side decodes."""
        end, carrier = self.sender
        self._hear(end, carrier)
        carrier.encode(end.stream, Packet(value, envelope.encode(), key))
        return self._received()

    def _hear(self, end: End, carrier: Carrier) -> None:
        """Let a sender that was dialled hear what its reader has said."""
        if self._heard is None and not self.kind.push:
            self._heard = carrier.listen(end.stream)
        if self._heard is not None:
            next(self._heard)

    def quit(self) -> Message | None:
        """Say goodbye as the carrier does; None if it has no goodbye."""
        end, carrier = self.sender
        carrier.encode_quit(end.stream)
        end.collect()
        return self._received() if end.outbox else None

    def reply(self, value: object) -> Message | None:
        """Answer the last message, and acknowledge it if the carrier does; returns what the asker
        reads."""
        end, carrier = self._answering()
        carrier.encode_reply(end.stream, value)
        if carrier.acks:
            carrier.encode_ack(end.stream, 1)
        return self._answered()

    def acknowledge(self, replied: bool = False) -> Message | None:
        """Acknowledge the last message. `replied`: its sender waits for a reply in vain."""
        end, carrier = self._answering()
        carrier.encode_ack(end.stream, 1)
        if replied:
            return self._answered()
        asker, asking = self.sender
        asker.begin(asking.expect_ack(asker.stream))
        self.pump()
        if not asker.done:
            raise Stalled("the acknowledgement is not recognised")
        return None

    def pump(self) -> None:
        """Carry bytes both ways until none are left."""
        drive(self.initiator, self.acceptor, self.traffic)

    def _choose(self) -> Steps[None]:
        end = self.acceptor
        first = bytes((yield from end.stream.read_exact(MAGIC_SIZE)))
        kind = recognise(first, [self.kind, *registry.carriers])
        if kind is None:
            raise AssertionError(f"no carrier recognises the bytes {first!r}")
        self.accepting = kind(Route("", self.target, kind.name, TCP_PORT))
        while (other := (yield from self.accepting.welcome(end.stream, first))) is not None:
            self.accepting = other

    def _accepted(self) -> Carrier:
        if self.accepting is None:
            raise Stalled("nobody has greeted yet")
        return self.accepting

    def _answering(self) -> tuple[End, Carrier]:
        end, carrier = self.receiver
        return end, carrier or self._accepted()

    def _received(self) -> Message:
        end, _ = self.receiver
        # A greeting without bytes continues until the first message.
        rest = None if end.done or not self.kind.push else self._welcome
        end.begin(self._read(rest))
        self.pump()
        if not end.done:
            raise Stalled("the receiver cannot find the end of the message")
        message: Message = end.result
        return message

    def _read(self, rest: Steps[None] | None) -> Steps[Message]:
        if rest is not None:
            yield from rest
        end, carrier = self.receiver
        if carrier is None:
            carrier = self._accepted()
        if not end.stream.waiting:
            yield None
        if end.stream.waiting:
            message = carrier.parse(end.stream)
            if message is not None:
                return message
        return (yield from carrier.decode(end.stream))

    def _answered(self) -> Message | None:
        end, carrier = self.sender
        end.begin(_reply_and_ack(carrier, end.stream))
        self.pump()
        if not end.done:
            raise Stalled("the asker cannot find the end of the reply")
        message: Message | None = end.result
        return message


def _reply_and_ack(carrier: Carrier, stream: ByteStream) -> Steps[Message | None]:
    if not stream.waiting:
        yield None
    reply = carrier.parse_reply(stream) if stream.waiting else None
    if reply is None:
        reply = yield from carrier.expect_reply(stream)
    if carrier.acks:
        yield from carrier.expect_ack(stream)
    return reply


def drive(initiator: End, acceptor: End, traffic: list[tuple[str, Any]] | None = None) -> None:
    """Carry each side's output to the other, until nothing is left."""
    moved = True
    while moved:
        moved = False
        for name, end, other in (
            ("initiator", initiator, acceptor),
            ("acceptor", acceptor, initiator),
        ):
            end.collect()
            items, end.outbox = end.outbox, []
            for item in items:
                moved = True
                if traffic is not None:
                    traffic.append((name, item))
                other.feed(item)


def said(traffic: Iterable[tuple[str, Buffer]], name: str) -> bytes:
    """Everything that the `initiator` or the `acceptor` wrote, joined."""
    return b"".join(bytes(item) for who, item in traffic if who == name)
