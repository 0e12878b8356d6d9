"""zenoh: keys of Zenoh, for programs that know Zenoh and nothing of YARP.

    yarpy connect /out zenoh://robot/arm         puts what the port writes
    yarpy connect zenoh://robot/** /in           the port subscribes; * and ** as in Zenoh
    yarpy connect /client zenoh+srv://robot/arm  the port asks: a get, with a payload
    yarpy connect zenoh+srv://robot/arm /server  the port answers such questions: a queryable

    zenoh+raw://...                              payloads are YARP's own spelling
    zenoh+delete://..., zenoh+sub+delete://...   the message [delete] is a DELETE, both ways
    zenoh+sub+liveliness://...                   tokens that come and go: [here], [gone]
    zenoh+liveliness://...                       the connection has such a token, at its key
    zenoh+timestamp://...                        what is put says when; with +sub that is heard
    zenoh+priority.REAL_TIME+block+express://... what is put, as publishers of Zenoh say it

Rules: those of `hosted`; `yarpy.zenoh` has the endpoints. What came as text or as bytes, by its
encoding, is that; `payload` says what any other payload holds. An envelope is the attachment, both
ways; where there is none, and `+timestamp` asks for it, that is the time. A get without a payload
asks with its parameters; the source has those of each.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, Final

from yarpy.carriers.base import Carrier, Limits
from yarpy.carriers.hosted import LISTENS, SERVICE, Hosted, failure
from yarpy.carriers.payload import JPEG, message_of, payload_of, to_payload, value_of
from yarpy.data import codec
from yarpy.data.failure import error_of, raised
from yarpy.data.value import Vocab
from yarpy.errors import LocalProtocolError
from yarpy.log import readable
from yarpy.route import CarrierSpec, Route
from yarpy.wire.message import CALL, DATA, Encoded, Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import Buffer, ByteStream

RAW: Final = "raw"
DELETE: Final = "delete"
LIVELINESS: Final = "liveliness"
TIMESTAMP: Final = "timestamp"
HERE: Final = "here"  # of a token of liveliness
GONE: Final = "gone"
BLOCK: Final = "block"  # wait for room on the way instead of dropping
EXPRESS: Final = "express"  # do not wait for more that could go in one packet
#: what a message of Zenoh can have, the most urgent first
PRIORITIES: Final = (
    *("REAL_TIME", "INTERACTIVE_HIGH", "INTERACTIVE_LOW"),
    *("DATA_HIGH", "DATA", "DATA_LOW", "BACKGROUND"),
)

JSON: Final = "application/json"
PICTURE: Final = "image/jpeg"
TEXT: Final = "text/plain"  # of what went wrong; behind it the kind of an exception
BYTES: Final = "zenoh/bytes"  # which says nothing
_TEXTS: Final = (TEXT, "zenoh/string")
_OCTETS: Final = "application/octet-stream"
_CONTROL: Final = re.compile(r"[\x00-\x1f\x7f]")
_UNTOLD: Final = (bytes, bytearray, memoryview, Encoded)  # the last holds anything


@dataclass(slots=True)
class Outgoing:
    """A message, question or answer that goes. `encoding`: its type, as Zenoh writes it. `to`: what
    it answers. `failed`: it says why there is no answer. `attachment`: what goes beside it.
    `deletes`: it is a DELETE."""

    payload: Buffer
    encoding: str = BYTES
    to: Any = None
    failed: bool = False
    attachment: bytes = b""
    deletes: bool = False

    @property
    def size(self) -> int:
        return len(self.payload)


@dataclass(slots=True)
class Incoming:
    """A message, question or answer that came. `asked`: the question, to be answered. `failure`:
    why there is no answer, `raised`: by which kind of exception. `place`: the key that it was put
    at; of a question with parameters, its selector. `attachment`: what came beside it. `event`:
    what happened at that key instead, DELETE, HERE or GONE. `encoding`: its type, as Zenoh writes
    it. `parameters`: of a question without a payload."""

    payload: Buffer
    asked: Any = None
    failure: str = ""
    raised: str = ""
    place: str = ""
    attachment: bytes = b""
    event: str = ""
    encoding: str = BYTES
    parameters: list[tuple[str, str]] | None = None

    @property
    def size(self) -> int:
        return len(self.payload)


class Zenoh(Hosted):
    """A port that puts; or one of the classes below."""

    name = "zenoh"
    over = "zenoh"
    words = (
        *(SERVICE, LISTENS, RAW, DELETE, LIVELINESS, TIMESTAMP),
        *("priority.NAME", BLOCK, EXPRESS),
    )

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self.raw = RAW in route.spec.tokens
        self.deletes = DELETE in route.spec.tokens

    @classmethod
    def of(cls, spec: CarrierSpec) -> type[Carrier]:
        priority = spec.value("priority")
        if priority is not None and priority not in PRIORITIES:
            raise LocalProtocolError(
                f"+priority.{readable(priority[:20])}: Zenoh has {', '.join(PRIORITIES)}"
            )
        reads, service = LISTENS in spec.tokens, SERVICE in spec.tokens
        words = {token.partition(".")[0] for token in spec.tokens}
        said = words & {"priority", BLOCK, EXPRESS}
        if said and (reads or service):
            raise LocalProtocolError(f"+{min(said)} is for ports that put: zenoh://KEY")
        said = words & {DELETE, TIMESTAMP}
        if said and service:
            raise LocalProtocolError(f"+{min(said)} is for messages: zenoh://KEY, zenoh+sub://KEY")
        if LIVELINESS in words and service and not reads:
            raise LocalProtocolError("+liveliness is not for ports that ask: zenoh+srv+sub://KEY")
        return super().of(spec)

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
        if self.deletes and _is_deletion(packet.value):
            return Outgoing(b"", attachment=packet.envelope, deletes=True)
        if self.raw:
            return Outgoing(_joined(packet.blocks), attachment=packet.envelope)
        payload = to_payload(packet)
        encoding = encoding_of(payload, packet.value)
        return Outgoing(payload, encoding, attachment=packet.envelope)

    def _heard(self, key: str, came: Incoming) -> Message:
        if came.event:
            return Message(key, b"".join(codec.encode([Vocab(came.event)])))
        if came.parameters is not None:
            asked = [[name, value_of(value.encode())] for name, value in came.parameters]
            message = Message(key, b"".join(codec.encode(asked)))
        elif self.raw:
            message = Message(key, came.payload)
        else:
            message = _typed(key, came)
        if came.attachment:
            text = came.attachment.decode("utf-8", "replace")
            message.envelope = _CONTROL.split(text, maxsplit=1)[0]  # a line, as everywhere
        return message


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
        message = self._heard(CALL, came)
        if came.place:
            message.source = f"/{self.name}://{readable(came.place)}"
        return message

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


def _typed(key: str, came: Incoming) -> Message:
    """Return the message in a payload, as its encoding says if that says enough."""
    form = came.encoding.partition(";")[0]
    if form == _OCTETS:
        return Message(key, b"".join(codec.encode(bytes(came.payload))))
    if form in _TEXTS:
        try:
            return Message(key, b"".join(codec.encode(str(came.payload, "utf-8"))))
        except UnicodeDecodeError:
            pass
    return message_of(key, [came.payload])


def encoding_of(payload: Buffer, value: object) -> str:
    """Return Zenoh's name for the encoding of a payload that was made of a value."""
    if payload[:3] == JPEG:
        return PICTURE
    if isinstance(value, list | tuple) and len(value) == 1:
        value = value[0]
    return BYTES if isinstance(value, _UNTOLD) else JSON


def _is_deletion(value: object) -> bool:
    if isinstance(value, list | tuple) and len(value) == 1:
        value = value[0]
    return isinstance(value, Vocab) and value == Vocab(DELETE)


def _joined(blocks: list[Buffer] | tuple[Buffer, ...]) -> Buffer:
    return blocks[0] if len(blocks) == 1 else b"".join(blocks)
