"""The plug-in contract: what a wire protocol is.

Rules: a carrier is a state machine over a ByteStream - generators, no sockets, threads or clock.
Its facts are class attributes; the methods default to what the plain binary carriers do, so a
carrier overrides only what differs. It asks for anything outside by yielding an effect
(`wire/effects.py`), and reports by returning messages; there are no flags for others to poll. The
link drives it, in this order:

    initiator                       acceptor
    greet                     ->    (magic chosen) welcome
    encode                    ->    parse or decode
    expect_reply, expect_ack  <-    encode_reply, encode_ack

The initiator of a *push* carrier sends the data; of a pull carrier (`push = False`) it receives it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Final

from yarpy.data import codec
from yarpy.data.codec import LISTS, any_list
from yarpy.data.walker import Walk
from yarpy.data.writer import list_blocks
from yarpy.errors import AccessRefused, LocalProtocolError
from yarpy.facts import MAGIC_SIZE, PORT, Reach
from yarpy.route import CarrierSpec, Route
from yarpy.wire import framing
from yarpy.wire.effects import BE_CALLED, May
from yarpy.wire.message import CALL, QUIT, Message, Packet, Spelling
from yarpy.wire.steps import Steps
from yarpy.wire.stream import Buffer, ByteStream

#: what may be added to every carrier over TCP
OVER_TCP: Final[tuple[str, ...]] = ("tls", "peer_timeout.SECONDS")
#: ... and what is understood wherever it makes sense, and refused elsewhere with its reason
_ANYWHERE: Final = frozenset(("tls", "log", "peer_timeout"))

_ACK_SIZE: Final = len(framing.ACK)

PAGE = "page"  # what follows the port command `*` when a browser asks
ASKS_FOR_KEY = "perhaps it wants a key (auth.conf) or TLS, which this side does not have"


@dataclass(frozen=True, slots=True)
class Delivery:
    """The facts by which messages of a carrier are sent.

    lossy: a slow consumer misses messages; its writer never waits. backlog: messages that may be
    queued for such a reader, with `at_once` of at most `held` bytes. interval: minimum seconds
    between its messages. coalesces: small messages of a burst may share one send. at_once: of a
    lossy connection, what does not leave in its writer's thread without waiting is dropped, unless
    the backlog has room. connectionless: the peer must be told of the end in some other way.
    broadcast: one send reaches every receiver of the group. attentive: what a reader says to
    `listen` is to be heard at once. side_by_side: a sender may have several connections; without
    it a new one of the same name takes the place of what is left of an earlier one.
    """

    lossy: bool = False
    backlog: int = 0
    held: int = 0
    interval: float = 0.0
    coalesces: bool = True
    at_once: bool = False
    connectionless: bool = False
    broadcast: bool = False
    attentive: bool = False
    side_by_side: bool = False


@dataclass(frozen=True, slots=True)
class Limits:
    """A peer's timeouts, in seconds; None: no limit.

    idle_timeout: for an accepted peer that sends nothing. ack_timeout: for an acknowledgement;
    messages then go one at a time. ahead: messages that may be without one. message_timeout: for
    silence in the middle of a message; within twice that time 60 kB of it must arrive. (For a whole
    message's time see the effect `Within`.) ping: what a peer that we have dialled wants to hear
    every `ping_interval`; 0: never.
    """

    idle_timeout: float | None = None
    ack_timeout: float | None = None
    ahead: int = 256
    message_timeout: float | None = 30.0
    ping: bytes = b""
    ping_interval: float = 0.0


class Carrier:
    """One connection's protocol. Subclass it, set the facts, override what differs.

    `route` says who talks to whom: `route.source` and `route.target` are port names,
    `route.spec` the parsed carrier string. The acceptor fills in the source. `lost` counts messages
    that the protocol itself had to drop; the link adds it to its drops. `unwanted` counts those
    that the reader had not asked for, and that were not sent. `reply_end`, set by whoever asks,
    finds the end of a reply that is no Bottle, within so many bytes.
    """

    name: ClassVar[str] = ""
    magic: ClassVar[bytes] = b""  # the first bytes of such a connection (up to eight)
    push: bool = True
    acks: bool = False  # the receiver confirms each message
    replies: ClassVar[bool] = True
    spelling: Spelling = "binary"  # what `encode` uses of a packet
    reaches: ClassVar[Reach] = PORT  # what is at the other end of one that we dial
    words: ClassVar[tuple[str, ...] | None] = None  # what may be added to its name; None: anything
    over: ClassVar[str] = ""  # the transport of its messages, if they leave where it has greeted
    # Of a WebSocket in whose frames it may come, too; it then writes by `stream.write` alone.
    subprotocol: ClassVar[str] = ""
    delivery: Delivery = Delivery()
    limits: Limits = Limits()  # what a peer says in its greeting may set those of one connection

    def __init__(self, route: Route) -> None:
        self.route = route
        self.lost = 0
        self.unwanted = 0
        self.reply_end: Callable[[int], Walk] | None = None

    @classmethod
    def of(cls, spec: CarrierSpec) -> type[Carrier]:
        """The class for a carrier string, where what it is depends on more than the protocol.
        Raises LocalProtocolError for one that does not say enough."""
        return cls

    @classmethod
    def recognises(cls, first: bytes) -> int:
        """Return how many of the `first` eight bytes identify our protocol; 0 if it is not ours."""
        return len(cls.magic) if cls.magic and first.startswith(cls.magic) else 0

    # -- beginning --------------------------------------------------------------------------------

    def greet(self, stream: ByteStream) -> Steps[None]:
        """The initiator's opening: magic, who we are, the peer's answer."""
        stream.write(self.magic + framing.encode_name(self.route.specifier))
        return
        yield

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[Carrier | None]:
        """The acceptor's answer; `first` are the eight bytes, already read.

        Returns another carrier if the connection turns out to be that one's, which then welcomes.
        """
        magic = self.recognises(first)
        if 0 < magic < MAGIC_SIZE:
            stream.unread(MAGIC_SIZE - magic)  # they belong to the name
        yield from introduce(self, stream, (yield from framing.read_name(stream)))
        return None

    # -- messages ---------------------------------------------------------------------------------

    def prepare(self, packet: Packet) -> bool:
        """Produce in the writer's thread, in separate memory, what `encode` will write.

        False: this protocol cannot carry the message; it is dropped, and counted.
        """
        packet.snapshot(self.spelling)
        return True

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        """Write one message."""
        stream.output += packet.framed or framing.encode(packet)

    def frames(self, packets: Sequence[Packet]) -> list[bytes] | None:
        """Return each of these messages as `encode` would write it; None where more belongs to a
        message than its bytes."""
        if self.acks or type(self).encode is not Carrier.encode:
            return None
        return [b"".join(packet.framed or framing.encode(packet)) for packet in packets]

    def gathers(self, packet: Packet) -> bool:
        """Return whether what `encode` has just written may wait for more messages of a burst: it
        is small, and in memory that the writer cannot change."""
        return packet.small

    def parse(self, stream: ByteStream) -> Message | None:
        """A message that is already complete in the stream's buffer, or None; never waits.

        Carriers with this shortcut start `decode` only once bytes arrive that it cannot read.
        """
        return None

    def decode(self, stream: ByteStream) -> Steps[Message]:
        """Read one message. `Message(QUIT)` is the end, `Message("r")` makes the peer a reader: its
        payload is the carrier that continues, or empty for this one."""
        return (yield from framing.read_message(stream))

    def last_word(self) -> Message | None:
        """Return the message that a peer has left with us for the case that it goes without a
        goodbye; None: there is none. It is asked for once, after the end."""
        return None

    def encode_quit(self, stream: ByteStream) -> None:
        """Write the message that closes the connection cleanly, if there is one."""
        stream.write(framing.QUIT)

    def listen(self, stream: ByteStream) -> Steps[None] | None:
        """Handle what a reader sends while we write to it, until it wants no more; None: it is not
        expected to send anything."""
        return None

    # -- what comes back --------------------------------------------------------------------------

    def encode_reply(self, stream: ByteStream, value: Any) -> None:
        """Write the reply to a message: the object itself, without framing."""
        found = list_blocks(value, any_list) if type(value) in LISTS else codec.encode(value)
        stream.output += found

    def expect_reply(self, stream: ByteStream) -> Steps[Message | None]:
        """Read a reply; None if the peer's acknowledgement shows that there will be none."""
        yield from stream.more(8)
        if stream.buffer.startswith(framing.ACK, stream.head):
            return None
        return Message(CALL, (yield from framing.read_payload(stream, self.reply_end)))

    def parse_reply(self, stream: ByteStream) -> Message | None:
        """A reply that is already complete in the stream's buffer, or None; never waits."""
        return None

    def encode_ack(self, stream: ByteStream, count: int) -> None:
        """Write `count` acknowledgements."""
        stream.output += (framing.ACK * count,)  # as the last step: a signal comes before or after

    def parse_acks(self, stream: ByteStream, most: int) -> int:
        """Take up to `most` acknowledgements that have already arrived; returns how many."""
        return 0

    def expect_ack(self, stream: ByteStream) -> Steps[None]:
        """Read one acknowledgement. A number n in it means that n bytes follow."""
        value = framing.parse_number((yield from stream.read_exact(8)))
        if value > 0:
            yield from stream.skip(min(value, stream.limit))

    def encode_lines(self, stream: ByteStream, lines: list[str]) -> None:
        """Write a port command's answer to a person; binary carriers write nothing."""


def introduce(carrier: Carrier, stream: ByteStream, specifier: str) -> Steps[None]:
    """Take what the initiator says about itself. If it lacks a right, say so and raise
    AccessRefused."""
    route = carrier.route
    route.introduce(specifier)
    for right in to_write(route):
        why = yield May(right)
        if why:
            stream.write(framing.encode_refusal(why))
            raise AccessRefused(why)
    if route.source.startswith("/") and (why := (yield May(BE_CALLED, name=route.source))):
        stream.write(framing.encode_refusal(why))
        raise AccessRefused(why)


def to_write(route: Route) -> list[str]:
    """The rights that an initiator needs: a port wants to write, a tool (whose name has no leading
    slash) may only ask; monitors are attached at our end."""
    wanted = ["write"] if route.source.startswith("/") else []
    return [*wanted, "attach"] if route.spec.recv else wanted


def refuse_unknown(spec: CarrierSpec, words: Sequence[str]) -> None:
    """Raise LocalProtocolError for an addition that is none of these words, such as `retain` or
    `user.NAME`, unless it may be a parameter of a monitor."""
    if spec.send or spec.recv:
        return
    known = _ANYWHERE.union(word.partition(".")[0] for word in words)
    for token in spec.tokens:
        word = token.partition(".")[0]  # not what may be a password
        if word not in known:
            possible = ", +".join((*words, "log.in", "send.MONITOR", "recv.MONITOR"))
            raise LocalProtocolError(f'{spec.base} knows no "+{word[:40]}", but +{possible}')


class Indexed(Carrier):
    """Carriers with YARP's index before each message, identified by a number.

    `code` is that number: the magic is eight bytes with 7777 + code.
    """

    code: ClassVar[int] = -1

    @classmethod
    def recognises(cls, first: bytes) -> int:
        value = framing.parse_number(first) - framing.BASE
        return MAGIC_SIZE if value >= 0 and cls.matches(value) else 0

    @classmethod
    def matches(cls, value: int) -> bool:
        """Only the low four bits identify the carrier; bit 7 asks for acknowledgements."""
        return value % 16 == cls.code % 16

    parse = staticmethod(framing.parse_plain)
    parse_reply = staticmethod(framing.parse_reply)

    def parse_acks(self, stream: ByteStream, most: int) -> int:
        head = stream.head
        count = (stream.tail - head) // _ACK_SIZE
        if count > most:
            count = most
        if not count or not stream.buffer.startswith(
            framing.ACK if count == 1 else framing.ACK * count, head
        ):
            return 0  # not all are plain acknowledgements: read them one by one
        stream.head = head + count * _ACK_SIZE
        return count

    def greet(self, stream: ByteStream) -> Steps[None]:
        name = framing.encode_name(self.route.specifier)
        stream.write(framing.number(framing.BASE + self.code) + name)
        return
        yield


__all__ = ["CALL", "QUIT", "Buffer", "Carrier", "Indexed", "Message", "Packet", "Route", "Steps"]
