"""zmq: every port is a ZeroMQ socket, for those who connect to its number and to connect to others.

    zmq+pub.TOPIC    zmq+sub.TOPIC      to a SUB that is bound there, from a PUB
    zmq+push         zmq+pull           to a PULL, from a PUSH
    zmq+req          zmq+rep            questions to a REP, from a REQ
    ... +user.NAME+password.WORD        to a socket that asks for them (PLAIN)
    ... +curve.KEY+password.KEY         to a socket with a key (CURVE)

Rules: a carrier string says what the side that dials is. Of a socket that dials us we are whatever
fits, all at once. What PUB and SUB exchange has the topic as its first frame; the topic of a port
is its name. A REQ's question goes to the port's reader, whose reply returns. `payload.py` says what
the last frame holds; `+raw` is YARP's own spelling, under a topic that begins with `raw:`, which
subscribers ask for by subscribing to `raw:`. A SUB never keeps its writer waiting: as with ZeroMQ's
own high-water mark a number of messages wait for it, and others are dropped, and counted. PINGs are
answered; a host that has died is noticed by TCP.
"""

from __future__ import annotations

from typing import ClassVar, Final

from yarpy.carriers.base import Carrier, Delivery, Limits, refuse_unknown, to_write
from yarpy.carriers.payload import message_of, payload_of, to_payload
from yarpy.errors import AccessRefused, LinkClosed, LocalProtocolError, RemoteProtocolError
from yarpy.facts import SOCKET
from yarpy.limit import ZMQ_BACKLOG, ZMQ_FRAMES, ZMQ_HELD, ZMQ_PREFIX, ZMQ_SUBSCRIPTIONS
from yarpy.log import readable
from yarpy.peers.zmq import curve, curve_server, plain, zmtp
from yarpy.route import CarrierSpec, Route
from yarpy.wire.effects import HEAR, May
from yarpy.wire.message import CALL, DATA, SMALL, Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import Buffer, ByteStream

RAW: Final = b"raw:"
_HEADS: Final = [zmtp.head(size) for size in range(256)]  # of messages of one short frame
PORT: Final = "X-Yarp-Port"  # the property by which a port says its name and modifiers
NOBODY: Final = "zmq"  # what a peer without a name is called
HIGH_WATER: Final = 1000  # messages that wait for a SUB, as for one of a PUB with SNDHWM as it is


class Zmq(Carrier):
    """One connection. What it is in the end is one of the classes below."""

    name = "zmq"
    magic = zmtp.MAGIC
    reaches = SOCKET
    role: ClassVar[str] = ""
    partners: ClassVar[tuple[bytes, ...]] = ()

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self.minor = 1  # of the version that both speak
        self.raw = "raw" in route.spec.tokens
        self._open = False
        self._sealed: curve.Sealed | None = None  # where everything is enciphered

    @classmethod
    def of(cls, spec: CarrierSpec) -> type[Carrier]:
        refuse_unknown(spec, _WORDS)
        if curve.keys_of(spec) is None:
            plain.credentials(spec)
        found = roles_of(spec)
        if len(found) != 1:
            raise LocalProtocolError(
                f'"{spec}" does not say what this end is: zmq+pub, zmq+push and zmq+req send, '
                "zmq+sub, zmq+pull and zmq+rep receive"
            )
        return ROLES[found[0]]

    @property
    def topic(self) -> bytes:
        """The text after the role, as in `zmq+sub.cam`."""
        return (self.route.spec.value(self.role) or "").encode("utf-8", "surrogateescape")

    # -- beginning --------------------------------------------------------------------------------

    def greet(self, stream: ByteStream) -> Steps[None]:
        keys = curve.keys_of(self.route.spec)
        login = None if keys else plain.credentials(self.route.spec)
        mechanism = curve.MECHANISM if keys else plain.MECHANISM if login else zmtp.NULL
        stream.write(zmtp.greeting(mechanism))
        try:
            self.minor = min(1, (yield from zmtp.read_greeting(stream, mechanism, dialled=True)))
        except LinkClosed:
            raise LinkClosed(
                "the peer hangs up in the middle of its greeting, as sockets do that ask for a "
                "name and a password (+user.NAME+password.WORD) or are known by a key (+curve.KEY)"
            ) from None
        if keys is not None:
            self._sealed = curve.Sealed(*keys)
            properties = yield from self._sealed.log_in(stream, self._said())
        elif login is None:
            stream.write(zmtp.ready(self._said()))
            properties = yield from zmtp.read_ready(stream)
        else:
            properties = yield from plain.log_in(stream, *login, self._said())
        kind = properties.get("socket-type", b"").upper()
        if kind not in self.partners:
            shown = readable(kind[:20].decode("latin-1")) or "a socket without a type"
            fitting = ROLE_OF.get(kind)
            advice = f": take zmq+{fitting}" if fitting else ""
            raise RemoteProtocolError(
                f"the peer is {shown}, which does not fit {self.role}{advice}"
            )
        self._begin(stream)

    def _said(self) -> dict[str, bytes]:
        said = {"Socket-Type": self.role.upper().encode()}
        if self.role in ("req", "rep"):
            said["Identity"] = b""
        secret = ("user", "password", "curve")
        open_to_all = all(self.route.spec.value(word) is None for word in secret)
        if self.route.source.startswith("/") and open_to_all:
            said[PORT] = self.route.specifier.encode("utf-8", "surrogateescape")
        return said

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[Carrier | None]:
        if self._open:
            return None
        stream.write(zmtp.OPENING)
        stream.unread(len(first))
        minor, mechanism = yield from zmtp.read_any_greeting(stream)
        minor = min(1, minor)
        sealed: curve_server.Server | None = None
        if mechanism == curve.MECHANISM:
            sealed = curve_server.Server(curve_server.own_key())
            admitting = sealed.admit(stream)
        elif mechanism == plain.MECHANISM:
            admitting = plain.admit(stream)
        elif mechanism == zmtp.NULL:
            admitting = zmtp.read_ready(stream)
        else:
            zmtp.refuse(mechanism)
        stream.write(zmtp.greeting(mechanism, mechanism != zmtp.NULL)[len(zmtp.OPENING) :])
        properties = yield from admitting
        kind = properties.get("socket-type", b"").upper()
        if kind not in PARTNER:
            shown = readable(kind[:20].decode("latin-1")) or "socket without a type"
            why = f"a port does not speak with a {shown}: take SUB, PULL, PUB, PUSH, REQ or REP"
            stream.write(zmtp.error(why))
            raise RemoteProtocolError(why)
        other, told = PARTNER[kind]
        old = self.route
        route = Route(NOBODY, old.target, old.spec, old.port, old.host, declared=old.declared)
        says = properties.get(PORT.lower(), b"").decode("utf-8", "surrogateescape")
        if says:
            route.introduce(says)
        if told not in route.spec.tokens and route.spec.value(told) is None:
            route.spec = route.spec.plus(told)
        if roles_of(route.spec) != [told]:
            raise RemoteProtocolError(f"a {kind.decode()} that says that it is {route.spec}")
        carrier = other(route)
        carrier.minor, carrier.push, carrier._open = minor, not other.push, True
        carrier._sealed = sealed
        yield from carrier._admit(stream)
        stream.write((sealed.ready_of if sealed else zmtp.ready)(carrier._said()))
        carrier._begin(stream)
        return carrier

    def _admit(self, stream: ByteStream) -> Steps[None]:
        """Raise AccessRefused for a peer that lacks a right, which is told."""
        rights = ["write", *to_write(self.route)] if self.push else [HEAR]
        for right in dict.fromkeys(rights):
            why = yield May(right)
            if why:
                stream.write(zmtp.error(why))
                raise AccessRefused(why)

    def _begin(self, stream: ByteStream) -> None:
        """The greeting is over."""

    # -- both directions --------------------------------------------------------------------------

    def read_frames(self, stream: ByteStream) -> Steps[list[Buffer]]:
        """The frames of a message; commands on the way are obeyed."""
        frames: list[Buffer] = []
        left = stream.limit
        while True:
            if self._sealed is None:
                flags, body = yield from zmtp.read_frame(stream, left)
            else:
                found = yield from zmtp.read_frame(stream, left + curve.OVERHEAD)
                flags, body = self._sealed.open(*found)
            if flags & zmtp.COMMAND:
                self.obey(stream, body)
                if not frames:
                    stream.pause()
                continue
            left -= len(body)
            frames.append(body)
            if not flags & zmtp.MORE:
                return frames
            if len(frames) >= ZMQ_FRAMES:
                raise RemoteProtocolError(f"a message of more than {ZMQ_FRAMES} frames")

    def obey(self, stream: ByteStream, body: Buffer) -> None:
        """A command of the peer."""
        name, content = zmtp.parse_command(body)
        if name == b"PING":
            stream.write(self.command(b"PONG", zmtp.echo(content)))
        elif name == b"ERROR":
            text = readable(content[1:].decode("utf-8", "replace"))
            raise RemoteProtocolError(f'the peer ends the connection: "{text}"')

    def listen(self, stream: ByteStream) -> Steps[None] | None:
        return self._listen(stream) if self.delivery.attentive or self.acks else None

    def _listen(self, stream: ByteStream) -> Steps[None]:
        """While we write: commands and subscriptions, each once it is complete."""
        while True:
            most = ZMQ_PREFIX + 1 + (curve.OVERHEAD if self._sealed else 0)
            while (found := zmtp.parse_frame(stream, most)) is not None:
                flags, body = self._sealed.open(*found) if self._sealed else found
                if flags & zmtp.COMMAND:
                    self.obey(stream, body)
                else:
                    self.hear(body)
            yield from stream.more(stream.waiting + 1)

    def hear(self, body: Buffer) -> None:
        """A message of somebody to whom we write."""
        raise RemoteProtocolError(f"a message from a socket that only reads ({self.route.spec})")

    def pieces(self, frames: list[Buffer]) -> list[Buffer]:
        """Return a message of these frames as it goes out."""
        return zmtp.encode(frames) if self._sealed is None else self._sealed.encode(frames)

    def command(self, name: bytes, body: bytes) -> bytes:
        """Return a command as it goes out."""
        make = zmtp.command if self._sealed is None else self._sealed.command
        return make(name, body)

    def encode_quit(self, stream: ByteStream) -> None:
        """Only closing ends the connection."""


def roles_of(spec: CarrierSpec) -> list[str]:
    """The roles that a carrier string names."""
    return [word for token in spec.tokens if (word := token.partition(".")[0]) in ROLES]


# -- what sends -----------------------------------------------------------------------------------


class Push(Zmq):
    """Every message in a frame, to a PULL."""

    role = "push"
    partners: ClassVar[tuple[bytes, ...]] = (b"PULL",)
    replies = False
    delivery = Delivery(attentive=True)

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self._small = False

    def gathers(self, packet: Packet) -> bool:
        return self._small

    def prepare(self, packet: Packet) -> bool:
        if self.raw:
            packet.snapshot("binary")
        else:
            to_payload(packet)
        return True

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        if self.raw:
            self.write(stream, [RAW + self.topic, self.raw_of(packet)])
            return
        body = to_payload(packet)
        if len(body) < 256 and self._sealed is None:  # as mostly
            self._small = True
            stream.write(_HEADS[len(body)] + body)
        else:
            self.write(stream, [body])

    def raw_of(self, packet: Packet) -> Buffer:
        """The payload in YARP's own spelling."""
        blocks = packet.blocks
        return blocks[0] if len(blocks) == 1 else b"".join(blocks)

    def write(self, stream: ByteStream, frames: list[Buffer]) -> None:
        """Write a message of these frames."""
        pieces = self.pieces(frames)
        self._small = len(pieces) == 1 and len(pieces[0]) < SMALL
        stream.write(*pieces)


class Pub(Push):
    """The sender of the messages to whose topics its peer has subscribed, as topic and payload."""

    role = "pub"
    partners = (b"SUB", b"XSUB")
    delivery = Delivery(
        lossy=True, backlog=HIGH_WATER, held=ZMQ_BACKLOG, at_once=True, attentive=True
    )

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self._wanted: dict[bytes, int] = {}  # prefixes, and how often each was subscribed to
        self._held = 0  # bytes of them
        self._topic = b""
        self._takes = self._takes_raw = False

    def _begin(self, stream: ByteStream) -> None:
        if not self._open:
            topic = self.topic or self.route.source.encode("utf-8", "surrogateescape")
        else:
            topic = self.route.target.encode("utf-8", "surrogateescape")
        self._topic = topic

    def obey(self, stream: ByteStream, body: Buffer) -> None:
        name, content = zmtp.parse_command(body)
        if name in (b"SUBSCRIBE", b"CANCEL"):
            self._subscribe(content, name == b"SUBSCRIBE")
        else:
            super().obey(stream, body)

    def hear(self, body: Buffer) -> None:
        data = bytes(body)
        if data[:1] in (b"\0", b"\1"):
            self._subscribe(data[1:], data[0] == 1)

    def _subscribe(self, prefix: bytes, on: bool) -> None:
        wanted = self._wanted
        if len(prefix) > ZMQ_PREFIX:
            raise RemoteProtocolError(f"a subscription of more than {ZMQ_PREFIX} bytes")
        if on:
            if prefix not in wanted:
                self._held += len(prefix)
            wanted[prefix] = wanted.get(prefix, 0) + 1
            if len(wanted) > ZMQ_SUBSCRIPTIONS or self._held > ZMQ_HELD:
                raise RemoteProtocolError(
                    f"more than {ZMQ_SUBSCRIPTIONS} subscriptions, or {ZMQ_HELD} bytes of them"
                )
        elif prefix in wanted:
            wanted[prefix] -= 1
            if not wanted[prefix]:
                del wanted[prefix]
                self._held -= len(prefix)
        if self.raw:
            self._takes, self._takes_raw = False, self._is_wanted(RAW + self._topic, False)
        else:
            self._takes = self._is_wanted(self._topic, False)
            self._takes_raw = self._is_wanted(RAW + self._topic, True)

    def _is_wanted(self, topic: bytes, explicitly: bool) -> bool:
        return any(
            topic.startswith(prefix) and (prefix.startswith(RAW) or not explicitly)
            for prefix in self._wanted
        )

    def prepare(self, packet: Packet) -> bool:
        if self._takes_raw:
            packet.snapshot("binary")
        if self._takes or not self._takes_raw:
            to_payload(packet)  # in memory of its own
        return True

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        if self._takes:
            self.write(stream, [self._topic, to_payload(packet)])
            if self._takes_raw:
                raw = self.pieces([RAW + self._topic, self.raw_of(packet)])
                self._small = False
                stream.write(*raw)
        elif self._takes_raw:
            self.write(stream, [RAW + self._topic, self.raw_of(packet)])
        else:
            self.unwanted += 1


class Req(Zmq):
    """Questions to a REP. A message that wants no answer gets one all the same, which is read and
    forgotten."""

    role = "req"
    partners = (b"REP", b"ROUTER")
    acks = True
    delivery = Delivery(coalesces=False)
    limits = Limits(ack_timeout=60.0)

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self._confirmed = False  # the answer to our question was read as its reply
        self._owed = 0  # answers that have not come
        self._over = False

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        content = [RAW, b"".join(packet.blocks)] if self.raw else [to_payload(packet)]
        stream.write(*self.pieces([b"", *content]))
        self._owed += 1

    def encode_quit(self, stream: ByteStream) -> None:
        self._over = True  # nothing comes for that

    def expect_reply(self, stream: ByteStream) -> Steps[Message | None]:
        frames = yield from self.read_frames(stream)
        self._confirmed = True
        self._owed -= 1
        return received(CALL, split(frames)[1])

    def expect_ack(self, stream: ByteStream) -> Steps[None]:
        if not (self._confirmed or (self._over and not self._owed)):
            yield from self.expect_reply(stream)
        self._confirmed = False


# -- what receives --------------------------------------------------------------------------------


class Pull(Zmq):
    """Messages of a PUSH: a frame, or several as a list."""

    role = "pull"
    partners: ClassVar[tuple[bytes, ...]] = (b"PUSH",)
    push = False
    replies = False

    def parse(self, stream: ByteStream) -> Message | None:
        if self._sealed is not None:
            return None
        body = zmtp.parse_body(stream)  # of one frame, as mostly
        if body is not None:
            return message_of(DATA, (body,))
        frames = zmtp.parse_message(stream)
        return None if frames is None else self.take(frames)

    def decode(self, stream: ByteStream) -> Steps[Message]:
        return self.take((yield from self.read_frames(stream)))

    def take(self, frames: list[Buffer]) -> Message:
        """Return the message for our reader."""
        return received(DATA, frames)


class Sub(Pull):
    """Messages of a PUB: the first of several frames is the topic."""

    role = "sub"
    partners = (b"PUB", b"XPUB")

    def _begin(self, stream: ByteStream) -> None:
        topic = b"" if self._open else self.topic
        if self.raw:
            topic = RAW + topic
        if self.minor:
            stream.write(self.command(b"SUBSCRIBE", topic))
        else:
            stream.write(*self.pieces([b"\1" + topic]))

    def take(self, frames: list[Buffer]) -> Message:
        is_raw = len(frames) > 1 and frames[0][: len(RAW)] == RAW
        return received(DATA, frames if is_raw or len(frames) == 1 else frames[1:])


class Rep(Zmq):
    """Questions of a REQ or a DEALER, and the answers to them."""

    role = "rep"
    partners = (b"REQ", b"DEALER")
    push = False

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self._way_back: list[Buffer] = []  # the frames in front of a question
        self._raw_asked = False

    def decode(self, stream: ByteStream) -> Steps[Message]:
        frames = yield from self.read_frames(stream)
        self._way_back, question = split(frames)
        self._raw_asked = is_raw(question)
        return received(CALL, question)

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        if self._raw_asked:
            answer: list[Buffer] = [RAW, b"".join(Packet(value).blocks)]
        else:
            answer = [payload_of(value)]
        stream.write(*self.pieces([*self._way_back, *answer]))


def split(frames: list[Buffer]) -> tuple[list[Buffer], list[Buffer]]:
    """Return the frames in front of a question or an answer, up to an empty frame, and the rest."""
    for place, body in enumerate(frames[:-1]):
        if not body:
            return frames[: place + 1], frames[place + 1 :]
    return [], frames


def is_raw(frames: list[Buffer]) -> bool:
    """Return whether the last frame is in YARP's own format."""
    return len(frames) == 2 and frames[0][: len(RAW)] == RAW


def received(key: str, frames: list[Buffer]) -> Message:
    """The message in these frames."""
    return Message(key, frames[1]) if is_raw(frames) else message_of(key, frames)


#: by what a carrier string says of the side that dials
ROLES: Final[dict[str, type[Zmq]]] = {kind.role: kind for kind in (Pub, Push, Req, Sub, Pull, Rep)}
_WORDS: Final = (
    *("pub.TOPIC", "push", "req", "sub.TOPIC", "pull", "rep"),
    *("user.NAME", "password.WORD", "curve.KEY", "raw"),
)
#: by the type of a socket: what we are to it, and the role of ours that it has itself
PARTNER: Final[dict[bytes, tuple[type[Zmq], str]]] = {
    b"SUB": (Pub, "sub"),
    b"XSUB": (Pub, "sub"),
    b"PULL": (Push, "pull"),
    b"PUB": (Sub, "pub"),
    b"XPUB": (Sub, "pub"),
    b"PUSH": (Pull, "push"),
    b"REQ": (Rep, "req"),
    b"DEALER": (Rep, "req"),
    b"REP": (Req, "rep"),
    b"ROUTER": (Req, "rep"),
}
#: by the type of a bound socket: the role that dials it
ROLE_OF: Final = {kind: other.role for kind, (other, _) in PARTNER.items()}
