"""tcpros: the topics of ROS 1. Subscribers dial publishers, also on the socket of any port.

    tcpros+topic./chatter        dials a publisher; `+raw.0` takes bodies as blobs, `+raw.1` and
                                 messages without a type as YARP's own spelling
    tcpros+topic.Pose+package.turtlesim      ... names the type

Rules: a header each, then bodies behind their lengths. The publisher decides about the type; one
without a type of its own takes that of its subscriber, and one that meets only `*` sends YARP's own
spelling. A message that is not of the type is not sent, and counted. A header with `service` is a
call: `rossrv`.
"""

from __future__ import annotations

from typing import Final

from yarpy.carriers.base import Carrier, Delivery
from yarpy.errors import AccessRefused, RemoteProtocolError, YarpError
from yarpy.facts import SERVER
from yarpy.log import logger, readable
from yarpy.peers.ros.body import Kind, encode_body, message_of
from yarpy.peers.ros.greeting import (
    ANY,
    answer_header,
    check_answer,
    is_service,
    message_kind,
    mismatch,
    need,
    own_header,
    refuse,
    told,
)
from yarpy.peers.ros.header import (
    LENGTH,
    Header,
    begins_header,
    encode_header,
    read_header,
)
from yarpy.route import Route
from yarpy.wire.effects import HEAR, May
from yarpy.wire.message import DATA, UNSENDABLE, Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import LARGE, Buffer, ByteStream

log = logger("yarpy.link")

#: how strongly two lengths in front suggest a header: less than the letters of any other protocol
_HINT: Final = 1


class TcpRos(Carrier):
    """Messages from the port that was dialled to the one that dialled."""

    name = "tcpros"
    words = ("topic.NAME", "package.NAME", "role.pub", "role.sub", "raw.0", "raw.1")
    push = False
    replies = False
    reaches = SERVER
    delivery = Delivery(coalesces=False)

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self.kind: Kind = None
        self.fields: Header = {}  # what the peer said
        self._raw = route.spec.value("raw") == "0"
        self._plain = route.spec.value("raw") == "1"
        self._headed = False  # whether messages begin with number and time
        self._told = ""  # of a message that does not fit

    @classmethod
    def recognises(cls, first: bytes) -> int:
        return _HINT if begins_header(first) else 0

    # -- the subscriber ---------------------------------------------------------------------------

    def greet(self, stream: ByteStream) -> Steps[None]:
        route = self.route
        self.kind = route.declared.kind
        stream.write(encode_header(own_header(route, "topic", self.kind)))
        self.fields = fields = yield from read_header(stream)
        check_answer(fields, self.kind, "the publisher")
        if self._plain or self._raw:
            self.kind = None
        elif self.kind is None:
            self.kind = message_kind(fields)
        self._headed = self.kind is not None and self.kind._has_header

    def parse(self, stream: ByteStream) -> Message | None:
        head = stream.head
        come = stream.tail - head - 4
        if come < 0:
            return None
        (size,) = LENGTH.unpack_from(stream.buffer, head)
        if size > come or size > LARGE:
            return None
        stream.head = head + 4 + size
        body = bytes(stream.buffer[head + 4 : stream.head])
        return message_of(DATA, body, self.kind, self._raw, self._headed)

    def decode(self, stream: ByteStream) -> Steps[Message]:
        (size,) = LENGTH.unpack((yield from stream.read_exact(4)))
        if size > stream.limit:
            raise RemoteProtocolError(
                f"a message of {size} bytes is announced; the limit is {stream.limit} bytes"
            )
        body = yield from stream.read_exact(size)
        return message_of(DATA, body, self.kind, self._raw, self._headed)

    # -- the publisher ----------------------------------------------------------------------------

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[Carrier | None]:
        stream.unread(len(first))
        self.fields = fields = yield from read_header(stream)
        if "service" in fields:
            from yarpy.peers.ros.service.carrier import RosSrv

            route = self.route
            spec = route.spec.over(RosSrv.name)
            return RosSrv(
                Route("", route.target, spec, route.port, route.host, declared=route.declared),
                fields,
            )
        why = yield May(HEAR)
        if why:
            stream.write(encode_header({"error": why}))
            raise AccessRefused(why)
        self._welcome_subscriber(stream, fields)
        return None

    def _welcome_subscriber(self, stream: ByteStream, fields: Header) -> None:
        route, declared = self.route, self.route.declared
        missing = need(fields, "callerid", "md5sum", "topic")
        if missing:
            refuse(stream, f"the header of a subscriber needs the field {missing!r}")
        topic = fields["topic"]
        if declared.topic and topic.replace("__", ":") != declared.topic.replace("__", ":"):
            refuse(stream, f"{declared.topic} is published here, not {readable(topic[:80])}")
        self.kind = declared.kind
        if is_service(self.kind):
            refuse(stream, f"{declared.topic} is a service, not a topic")
        problem = mismatch(fields, self.kind)
        if problem:
            refuse(stream, f"the subscriber of {topic} {problem}")
        if self.kind is None:
            try:
                if fields["md5sum"] != ANY:
                    self.kind = message_kind(fields)
                elif "/" in declared.type:  # of what the port has written, for who takes any
                    from yarpy.peers.ros.message.library import default_library

                    self.kind = default_library().message(declared.type)
            except YarpError as error:
                told(stream, error)
        route.introduce(fields["callerid"].replace(" ", "_"))
        stream.write(encode_header(answer_header(route, fields, self.kind)))

    def whole(self, value: object) -> bytes | None:
        """A small message of the type as it goes over the wire; None for what takes more."""
        if type(value) is not self.kind or self.kind is None:
            return None
        try:
            body = value.to_ros()
        except UNSENDABLE:
            return None  # `encode` says so
        if len(body) > 1 or len(body[0]) >= LARGE:
            return None
        return LENGTH.pack(len(body[0])) + body[0]

    def _body(self, packet: Packet) -> tuple[Buffer, ...]:
        declared = self.route.declared
        return encode_body(packet, self.kind, declared.clock, declared.frame)

    def prepare(self, packet: Packet) -> bool:
        try:
            body = self._body(packet)
        except UNSENDABLE as error:
            self._complain(str(error))
            return False
        if any(type(block) is not bytes for block in body):  # it leaves later
            packet.forms["ros", self.kind, self.route.declared.frame] = tuple(map(bytes, body))
        return True

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        try:
            body = self._body(packet)
        except UNSENDABLE as error:
            self._complain(str(error))
            self.lost += 1
            return
        self._told = ""
        if len(body) == 1 and len(body[0]) < LARGE:
            stream.write(LENGTH.pack(len(body[0])) + body[0])
        else:
            stream.write(LENGTH.pack(sum(map(len, body))), *body)

    def _complain(self, text: str) -> None:
        """Say why a message is not sent, once for as long as they follow each other."""
        if text != self._told:
            self._told = text
            log.warning("%s: a message is not sent to %s: %s", *_ends(self.route), text)

    def encode_quit(self, stream: ByteStream) -> None:
        """Only closing ends the connection."""


def _ends(route: Route) -> tuple[str, str]:
    return route.source, route.target
