"""The plug-in contract: what a wire protocol is.

Rules: a carrier is a state machine over a ByteStream - generators, no sockets, threads or clock.
Its facts are class attributes; each method has a default that does what the plain binary carriers
do, so a carrier overrides only what is different about it. What it needs from the outside it yields
as an effect (`wire/effects.py`), and what it reports is a message: it leaves no flags for others to
look at. The link drives it, in this order:

    initiator                       acceptor
    greet                     ->    (magic chosen) welcome
    encode                    ->    parse or decode
    expect_reply, expect_ack  <-    encode_reply, encode_ack

The initiator of a *push* carrier sends the data; of a pull carrier (`push = False`) it receives it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from yarpy.data import codec
from yarpy.route import Route
from yarpy.wire import framing
from yarpy.wire.message import CALL, QUIT, Message, Packet, Spelling
from yarpy.wire.steps import Steps
from yarpy.wire.stream import Buffer, ByteStream

MAGIC_SIZE = 8  # bytes by which protocols are told apart
PAGE = "page"  # what follows the port command `*` when a browser asks
ASKS_FOR_KEY = "perhaps it wants a key (auth.conf) or TLS, which this side does not have"


@dataclass(frozen=True, slots=True)
class Delivery:
    """How messages leave.

    lossy: a slow consumer misses messages; its writer never waits. backlog: messages that may
    wait for such a reader. interval: seconds between its messages, at least. coalesces: small
    messages of a burst may leave in one send.
    """

    lossy: bool = False
    backlog: int = 0
    interval: float = 0.0
    coalesces: bool = True


@dataclass(frozen=True, slots=True)
class Limits:
    """A peer's timeouts, in seconds; None: it may take as long as it likes.

    idle_timeout: for the silence of an accepted peer. ack_timeout: for an acknowledgement; messages
    then go one at a time. (For the time of a message see the effect `Within`.)
    """

    idle_timeout: float | None = None
    ack_timeout: float | None = None


class Carrier:
    """One connection's protocol. Subclass it, set the facts, override what differs.

    `route` says who talks to whom: `route.source` and `route.target` are port names,
    `route.spec` the carrier string with what is added to it. The acceptor fills in the source.
    `lost` counts messages that the protocol itself had to drop; the link adds it to its drops.
    """

    name: ClassVar[str] = ""
    magic: ClassVar[bytes] = b""  # what such a connection begins with (eight bytes, or fewer)
    push: bool = True
    acks: bool = False  # the receiver confirms each message
    replies: ClassVar[bool] = True
    spelling: Spelling = "binary"  # what `encode` uses of a packet
    foreign: ClassVar[bool] = False  # the peer we dial may know nothing of YARP, nor of its keys
    introduces: ClassVar[bool] = True  # the initiator gives its name and modifiers
    connectionless: ClassVar[bool] = False  # the peer must learn of the end some other way
    broadcast: ClassVar[bool] = False  # one send reaches every receiver of the group
    delivery: Delivery = Delivery()
    limits: ClassVar[Limits] = Limits()

    def __init__(self, route: Route) -> None:
        self.route = route
        self.lost = 0

    @classmethod
    def recognises(cls, first: bytes) -> int:
        """How many of the `first` eight bytes say that this is our protocol; 0: it is not."""
        return len(cls.magic) if cls.magic and first.startswith(cls.magic) else 0

    # -- beginning --------------------------------------------------------------------------------

    def greet(self, stream: ByteStream) -> Steps[None]:
        """The initiator's opening: magic, who we are, the peer's answer."""
        stream.write(self.magic + framing.encode_name(self.route.specifier))
        return
        yield

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[Carrier | None]:
        """The acceptor's answer; `first` are the eight bytes, already read.

        If they did not decide it: returns the carrier whose connection it is, to welcome it anew.
        """
        magic = self.recognises(first)
        if 0 < magic < MAGIC_SIZE:
            stream.unread(MAGIC_SIZE - magic)  # they belong to the name
        self.route.introduce((yield from framing.read_name(stream)))
        return None

    # -- messages ---------------------------------------------------------------------------------

    def prepare(self, packet: Packet) -> bool:
        """Make what `encode` will write, in the thread of the writer, into memory of its own.

        False: this message is not for this protocol; it is dropped, and counted.
        """
        packet.snapshot(self.spelling)
        return True

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        """Write one message."""
        stream.write(*framing.encode(packet))

    def parse(self, stream: ByteStream) -> Message | None:
        """A message that is already in the stream's buffer, if it can be had without waiting.

        With this shortcut, `decode` begins when bytes have come that it cannot read; else at once.
        """
        return None

    def decode(self, stream: ByteStream) -> Steps[Message]:
        """Read one message. `Message(QUIT)` is the end, `Message("r")` makes the peer a reader: its
        payload is the carrier that goes on, or empty for this one."""
        return (yield from framing.read_message(stream))

    def encode_quit(self, stream: ByteStream) -> None:
        """Write the message that ends the connection in good order, if there is one."""
        stream.write(framing.QUIT)

    def drain(self, stream: ByteStream) -> Steps[None]:
        """Without acknowledgements: read what the peer says until it hangs up, after our goodbye.

        For peers whose last input may be unread: closing with unread input resets
        the connection and loses our last output.
        """
        return
        yield

    def listen(self, stream: ByteStream) -> Steps[None] | None:
        """Deal with what a reader says while we send to it, until it wants no more; None: nothing
        is expected of it."""
        return None

    # -- what comes back --------------------------------------------------------------------------

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        """Write the reply to a message: the object itself, without framing."""
        stream.write(*codec.encode(value))

    def expect_reply(self, stream: ByteStream) -> Steps[Message | None]:
        """Read a reply; None if the peer's acknowledgement shows that there is none."""
        yield from stream.more(8)
        if stream.buffer.startswith(framing.ACK, stream.head):
            return None
        return Message(CALL, (yield from framing.read_payload(stream)))

    def parse_reply(self, stream: ByteStream) -> Message | None:
        """A reply that is already in the stream's buffer, if it can be had without waiting."""
        return None

    def encode_ack(self, stream: ByteStream, count: int) -> None:
        """Write `count` acknowledgements."""
        stream.write(framing.ACK * count)

    def parse_acks(self, stream: ByteStream, most: int) -> int:
        """Take up to `most` acknowledgements that have already come; returns how many."""
        return 0

    def expect_ack(self, stream: ByteStream) -> Steps[None]:
        """Read one acknowledgement. A number n in it means that n more bytes follow."""
        value = framing.parse_number((yield from stream.read_exact(8)))
        if value > 0:
            yield from stream.skip(min(value, stream.limit))

    def encode_lines(self, stream: ByteStream, lines: list[str]) -> None:
        """Write what a port command answers to a person; binary carriers say nothing."""


class Indexed(Carrier):
    """The carriers that put YARP's index before each message and know each other by a number.

    `code` is that number: eight bytes with 7777 + code are the magic.
    """

    code: ClassVar[int] = -1

    @classmethod
    def recognises(cls, first: bytes) -> int:
        value = framing.parse_number(first) - framing.BASE
        return MAGIC_SIZE if value >= 0 and cls.matches(value) else 0

    @classmethod
    def matches(cls, value: int) -> bool:
        """Only the low four bits tell carriers apart; bit 7 says that acknowledgements are
        wanted."""
        return value % 16 == cls.code % 16

    parse = staticmethod(framing.parse_plain)
    parse_reply = staticmethod(framing.parse_reply)

    def parse_acks(self, stream: ByteStream, most: int) -> int:
        count = min(most, stream.waiting // len(framing.ACK))
        if not count or not stream.buffer.startswith(framing.ACK * count, stream.head):
            return 0  # something else is among them; one by one, then
        stream.head += count * len(framing.ACK)
        return count

    def greet(self, stream: ByteStream) -> Steps[None]:
        name = framing.encode_name(self.route.specifier)
        stream.write(framing.number(framing.BASE + self.code) + name)
        return
        yield


__all__ = ["CALL", "QUIT", "Buffer", "Carrier", "Indexed", "Message", "Packet", "Route", "Steps"]
