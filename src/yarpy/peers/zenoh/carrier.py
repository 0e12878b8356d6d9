"""zenoh: keys of Zenoh, for programs that know Zenoh and nothing of YARP.

    yarpy connect /out zenoh://robot/arm         puts what the port writes
    yarpy connect zenoh://robot/** /in           the port subscribes; * and ** as in Zenoh
    yarpy connect /client zenoh+srv://robot/arm  the port asks: a get, with a payload
    yarpy connect zenoh+srv://robot/arm /server  the port answers such questions: a queryable

    zenoh+raw://...                              payloads are YARP's own spelling

Rules: those of `hosted`; `yarpy.zenoh` has the endpoints. `payload` says what a payload holds.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

from yarpy.carriers.base import Carrier, Limits
from yarpy.carriers.hosted import LISTENS, SERVICE, Hosted, failure
from yarpy.carriers.payload import JPEG, message_of, payload_of, to_payload
from yarpy.data import codec
from yarpy.data.failure import error_of, raised
from yarpy.log import readable
from yarpy.route import Route
from yarpy.wire.message import CALL, DATA, Encoded, Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import Buffer, ByteStream

RAW: Final = "raw"

JSON: Final = "application/json"
PICTURE: Final = "image/jpeg"
TEXT: Final = "text/plain"  # of what went wrong; behind it the kind of an exception
BYTES: Final = "zenoh/bytes"  # which says nothing
_UNTOLD: Final = (bytes, bytearray, memoryview, Encoded)  # the last holds anything


@dataclass(slots=True)
class Outgoing:
    """A message, question or answer that goes. `encoding`: its type, as Zenoh writes it. `to`: what
    it answers. `failed`: it says why there is no answer."""

    payload: Buffer
    encoding: str = BYTES
    to: Any = None
    failed: bool = False

    @property
    def size(self) -> int:
        return len(self.payload)


@dataclass(slots=True)
class Incoming:
    """A message, question or answer that came. `asked`: the question, to be answered. `failure`:
    why there is no answer, `raised`: by which kind of exception. `place`: the key that it was put
    at."""

    payload: Buffer
    asked: Any = None
    failure: str = ""
    raised: str = ""
    place: str = ""

    @property
    def size(self) -> int:
        return len(self.payload)


class Zenoh(Hosted):
    """A port that puts; or one of the classes below."""

    name = "zenoh"
    over = "zenoh"
    words = (SERVICE, LISTENS, RAW)

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self.raw = RAW in route.spec.tokens

    @classmethod
    def roles(cls) -> tuple[type[Carrier], type[Carrier], type[Carrier]]:
        return Subscriber, Asker, Server

    def greet(self, stream: ByteStream) -> Steps[None]:
        yield from self.read_object(stream)  # the endpoint itself

    def prepare(self, packet: Packet) -> bool:
        if self.raw:
            return super().prepare(packet)
        to_payload(packet)
        return True

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        self.write_object(stream, self._said(packet))

    def _said(self, packet: Packet) -> Outgoing:
        if self.raw:
            return Outgoing(_joined(packet.blocks))
        payload = to_payload(packet)
        return Outgoing(payload, encoding_of(payload, packet.value))

    def _heard(self, key: str, came: Incoming) -> Message:
        if self.raw:
            return Message(key, came.payload)
        return message_of(key, [came.payload])


class Subscriber(Zenoh):
    """The port reads what is put."""

    push = False

    def decode(self, stream: ByteStream) -> Steps[Message]:
        came = yield from self.read_object(stream)
        message = self._heard(DATA, came)
        message.source = f"/{self.name}://{readable(came.place)}"
        return message


class Asker(Zenoh):
    """The port asks."""

    replies = True
    limits = Limits(message_timeout=None)

    def expect_reply(self, stream: ByteStream) -> Steps[Message | None]:
        came = yield from self.read_object(stream)
        if came.raised:
            why = came.failure.removeprefix(f"{came.raised}: ")
            return Message(CALL, b"".join(codec.encode(raised(came.raised, why))))
        if came.failure:
            return failure(came.failure)
        return self._heard(CALL, came)


class Server(Zenoh):
    """The port answers."""

    push = False
    replies = True

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self._asked: Any = None

    def decode(self, stream: ByteStream) -> Steps[Message]:
        came = yield from self.read_object(stream)
        self._asked = came.asked
        return self._heard(CALL, came)

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        asked, self._asked = self._asked, None
        error = error_of(codec.decode(value.data) if isinstance(value, Encoded) else value)
        if error is not None:
            why = f"{error.type}: {error.text}".encode("utf-8", "replace")
            self.write_object(stream, Outgoing(why, f"{TEXT};{error.type}", asked, failed=True))
        elif self.raw:
            self.write_object(stream, Outgoing(_joined(codec.encode(value)), to=asked))
        else:
            payload = payload_of(value)
            self.write_object(stream, Outgoing(payload, encoding_of(payload, value), asked))


def encoding_of(payload: Buffer, value: object) -> str:
    """Return Zenoh's name for the encoding of a payload that was made of a value."""
    if payload[:3] == JPEG:
        return PICTURE
    if isinstance(value, list | tuple) and len(value) == 1:
        value = value[0]
    return BYTES if isinstance(value, _UNTOLD) else JSON


def _joined(blocks: list[Buffer] | tuple[Buffer, ...]) -> Buffer:
    return blocks[0] if len(blocks) == 1 else b"".join(blocks)
