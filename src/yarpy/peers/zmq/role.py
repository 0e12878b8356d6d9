"""A role: what either end of a connection of ZeroMQ does, whatever it is there.

Rules: the end that dials greets and is told what the other is; what an accepting port becomes is
`carrier`'s to say. PINGs are answered, other commands obeyed, between messages and while we write.
"""

from __future__ import annotations

from typing import ClassVar, Final

from yarpy.carriers.base import Carrier, to_write
from yarpy.carriers.payload import message_of
from yarpy.errors import AccessRefused, LinkClosed, RemoteProtocolError
from yarpy.facts import SOCKET
from yarpy.limit import ZMQ_FRAMES, ZMQ_PREFIX
from yarpy.log import readable
from yarpy.peers.zmq import curve, plain, zmtp
from yarpy.route import Route
from yarpy.wire.effects import HEAR, May
from yarpy.wire.message import Message
from yarpy.wire.steps import Steps
from yarpy.wire.stream import Buffer, ByteStream

RAW: Final = b"raw:"
PORT: Final = "X-Yarp-Port"  # the property by which a port says its name and modifiers

#: by the type of the other socket: our role to it, and its own as a carrier string says it
PARTNER: Final[dict[bytes, tuple[str, str]]] = {
    b"SUB": ("pub", "sub"),
    b"XSUB": ("pub", "sub"),
    b"PULL": ("push", "pull"),
    b"PUB": ("sub", "pub"),
    b"XPUB": ("sub", "pub"),
    b"PUSH": ("pull", "push"),
    b"REQ": ("rep", "req"),
    b"DEALER": ("rep", "req"),
    b"REP": ("req", "rep"),
    b"ROUTER": ("req", "rep"),
}


class Role(Carrier):
    """One end of a connection. `role`: its word in carrier strings; `partners`: who fits."""

    name = "zmq"
    reaches = SOCKET
    role: ClassVar[str] = ""
    partners: ClassVar[tuple[bytes, ...]] = ()

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self.minor = 1  # of the version that both speak
        self.raw = "raw" in route.spec.tokens
        self.accepted = False  # the other end has dialled
        self.sealed: curve.Sealed | None = None  # where everything is enciphered

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
            self.sealed = curve.Sealed(*keys)
            properties = yield from self.sealed.log_in(stream, self.said())
        elif login is None:
            stream.write(zmtp.ready(self.said()))
            properties = yield from zmtp.read_ready(stream)
        else:
            properties = yield from plain.log_in(stream, *login, self.said())
        kind = properties.get("socket-type", b"").upper()
        if kind not in self.partners:
            shown = readable(kind[:20].decode("latin-1")) or "a socket without a type"
            advice = f": take zmq+{PARTNER[kind][0]}" if kind in PARTNER else ""
            raise RemoteProtocolError(
                f"the peer is {shown}, which does not fit {self.role}{advice}"
            )
        self.begin(stream)

    def said(self) -> dict[str, bytes]:
        said = {"Socket-Type": self.role.upper().encode()}
        if self.role in ("req", "rep"):
            said["Identity"] = b""
        secret = ("user", "password", "curve")
        open_to_all = all(self.route.spec.value(word) is None for word in secret)
        if self.route.source.startswith("/") and open_to_all:
            said[PORT] = self.route.specifier.encode("utf-8", "surrogateescape")
        return said

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[Carrier | None]:
        """Return None: who is accepted as something has been welcomed."""
        return None
        yield

    def admit(self, stream: ByteStream) -> Steps[None]:
        """Raise AccessRefused for a peer that lacks a right, which is told."""
        rights = ["write", *to_write(self.route)] if self.push else [HEAR]
        for right in dict.fromkeys(rights):
            why = yield May(right)
            if why:
                stream.write(zmtp.error(why))
                raise AccessRefused(why)

    def begin(self, stream: ByteStream) -> None:
        """The greeting is over."""

    # -- both directions --------------------------------------------------------------------------

    def read_frames(self, stream: ByteStream) -> Steps[list[Buffer]]:
        """The frames of a message; commands on the way are obeyed."""
        frames: list[Buffer] = []
        left = stream.limit
        while True:
            if self.sealed is None:
                flags, body = yield from zmtp.read_frame(stream, left)
            else:
                found = yield from zmtp.read_frame(stream, left + curve.OVERHEAD)
                flags, body = self.sealed.open(*found)
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
            most = ZMQ_PREFIX + 1 + (curve.OVERHEAD if self.sealed else 0)
            while (found := zmtp.parse_frame(stream, most)) is not None:
                flags, body = self.sealed.open(*found) if self.sealed else found
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
        return zmtp.encode(frames) if self.sealed is None else self.sealed.encode(frames)

    def command(self, name: bytes, body: bytes) -> bytes:
        """Return a command as it goes out."""
        make = zmtp.command if self.sealed is None else self.sealed.command
        return make(name, body)

    def encode_quit(self, stream: ByteStream) -> None:
        """Only closing ends the connection."""


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
