"""rossrv: the services of ROS 1. Clients dial servers, also on the socket of any port.

    rossrv+service./add_two_ints

Rules: a header each; then a question is a body behind its length, and an answer a byte, a length
and a body: an answer of the type behind 1, behind 0 a text that says why there is none, which is
`[fail] "text"` here. A message that wants no answer gets one all the same, which is read and
forgotten. Without `persistent=1` the server hangs up after one answer; `probe=1` asks for the
header alone.
"""

from __future__ import annotations

from typing import Any

from yarpy.carriers.base import Carrier, Delivery, Limits
from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import AccessRefused, RemoteProtocolError
from yarpy.facts import SERVER
from yarpy.limit import ROS_REASON
from yarpy.log import readable
from yarpy.peers.ros.body import Kind, encode_body, message_of
from yarpy.peers.ros.greeting import (
    ANY,
    answer_header,
    check_answer,
    is_service,
    mismatch,
    need,
    own_header,
    refuse,
    service_kind,
)
from yarpy.peers.ros.header import LENGTH, Header, encode_header, read_header
from yarpy.route import Route
from yarpy.wire.effects import May
from yarpy.wire.message import CALL, QUIT, UNSENDABLE, Encoded, Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream


class RosSrv(Carrier):
    """Questions from the port that dials, answers from the one that was dialled."""

    name = "rossrv"
    words = ("service.NAME", "package.NAME", "raw.0", "raw.1")
    acks = True
    reaches = SERVER
    delivery = Delivery(coalesces=False, side_by_side=True)  # a node asks from all its threads
    limits = Limits(ack_timeout=60.0)

    def __init__(self, route: Route, fields: Header | None = None) -> None:
        super().__init__(route)
        self.fields = fields or {}  # what the peer said
        self._request: Kind = None
        self._response: Kind = None
        self._raw = route.spec.value("raw") == "0"
        self._owed = False  # a question waits for its answer
        self._last = False  # the connection ends after the next answer
        self._over = False  # nothing more is read
        self._confirmed = False  # the answer to our question was read as its reply

    def _take(self, kind: Any) -> None:
        if kind is not None and not self._raw:
            self._request, self._response = kind.Request, kind.Response

    # -- the client -------------------------------------------------------------------------------

    def greet(self, stream: ByteStream) -> Steps[None]:
        kind = self.route.declared.kind
        stream.write(encode_header(own_header(self.route, "service", kind)))
        self.fields = fields = yield from read_header(stream)
        check_answer(fields, kind, "the service")
        self._take(service_kind(fields) if kind is None and not self._raw else kind)

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        body = encode_body(packet, self._request, self.route.declared.clock)
        stream.write(LENGTH.pack(sum(map(len, body))), *body)

    def encode_quit(self, stream: ByteStream) -> None:
        """Only closing ends the connection."""
        self._confirmed = True  # nothing comes for that

    def expect_reply(self, stream: ByteStream) -> Steps[Message | None]:
        (ok,) = yield from stream.read_exact(1)
        (size,) = LENGTH.unpack((yield from stream.read_exact(4)))
        if size > (stream.limit if ok else ROS_REASON):
            raise RemoteProtocolError(f"an answer of {size} bytes is announced")
        body = yield from stream.read_exact(size)
        self._confirmed = True
        if ok:
            return message_of(CALL, body, self._response, self._raw)
        if not size:
            return None  # it was not taken
        reason = readable(bytes(body).decode("utf-8", "replace"))
        return Message(CALL, b"".join(codec.encode([Vocab("fail"), reason])))

    def expect_ack(self, stream: ByteStream) -> Steps[None]:
        if not self._confirmed:
            yield from self.expect_reply(stream)
        self._confirmed = False

    # -- the server -------------------------------------------------------------------------------

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[Carrier | None]:
        if not self.fields:
            stream.unread(len(first))
            self.fields = yield from read_header(stream)
        route, fields, declared = self.route, self.fields, self.route.declared
        kind = declared.kind
        missing = need(fields, "callerid", "md5sum", "service")
        if missing:
            refuse(stream, f"the header of a client needs the field {missing!r}")
        service = fields["service"]
        if declared.topic and service.replace("__", ":") != declared.topic.replace("__", ":"):
            refuse(stream, f"the service here is {declared.topic}, not {readable(service[:80])}")
        if kind is not None and not is_service(kind):
            refuse(stream, f"{declared.topic} is a topic, not a service")
        why = yield May("write")
        if why:
            stream.write(encode_header({"error": why}))
            raise AccessRefused(why)
        problem = mismatch(fields, kind)
        if problem:
            refuse(stream, f"the client of {service} {problem}")
        self._take(kind)
        if kind is None and fields["md5sum"] != ANY:
            self._raw = True  # of a type that we do not know
        stream.write(encode_header(answer_header(route, fields, kind)))
        self._last = fields.get("persistent") != "1"
        if "probe" in fields:
            route.source = "probe"
            self._over = True
        else:
            route.introduce(fields["callerid"].replace(" ", "_"))
        return None

    def decode(self, stream: ByteStream) -> Steps[Message]:
        if self._over:
            return Message(QUIT)
        (size,) = LENGTH.unpack((yield from stream.read_exact(4)))
        if size > stream.limit:
            raise RemoteProtocolError(
                f"a question of {size} bytes is announced; the limit is {stream.limit} bytes"
            )
        body = yield from stream.read_exact(size)
        self._owed = True
        return message_of(CALL, body, self._request, self._raw)

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        reason = _reason(value)
        if reason is None:
            packet = Packet(value)
            try:
                body = encode_body(packet, self._response, self.route.declared.clock)
            except UNSENDABLE as error:
                if value != Bottle():
                    raise
                reason = f"the service gave no answer ({error})"
            else:
                self._respond(stream, 1, *body)
                return
        self._respond(stream, 0, reason.encode("utf-8", "replace")[:ROS_REASON])

    def encode_ack(self, stream: ByteStream, count: int) -> None:
        if self._owed:
            self._respond(stream, 0)

    def _respond(self, stream: ByteStream, ok: int, *body: Any) -> None:
        stream.write(bytes([ok]) + LENGTH.pack(sum(map(len, body))), *body)
        self._owed = False
        if self._last:
            self._over = True


def _reason(value: object) -> str | None:
    """Return why there is no answer: the text in `[fail] "text"`."""
    if isinstance(value, Encoded):
        value = codec.decode(value.data)
    if isinstance(value, (list, tuple)) and value and _is_failure(value[0]):
        return plain_text(value[1]) if len(value) > 1 else "it failed"
    return None


def _is_failure(word: object) -> bool:
    return isinstance(word, Vocab) and word == "fail"
