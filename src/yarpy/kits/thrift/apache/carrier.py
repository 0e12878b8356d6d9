"""thrift: services for the clients of Apache Thrift, in any language, and its servers for ours.

    thrift            TBinaryProtocol over TBufferedTransport
    thrift+framed     the same over TFramedTransport
    thrift+compact    TCompactProtocol, over either
    thrift+http       either protocol in the bodies of POSTs (`post.py`)

Rules: what comes says by its first bytes what it is: a length before 80 01 or 82 in a frame. Calls
of one connection are answered in their order, each by its number. A port that has no service of
Thrift answers that it knows no such method.
"""

from __future__ import annotations

from struct import Struct as Packing
from typing import Final

from yarpy.carriers.base import Carrier, refuse_unknown
from yarpy.data.value import Buffer
from yarpy.errors import AccessRefused, LocalProtocolError, RemoteProtocolError
from yarpy.facts import MAGIC_SIZE
from yarpy.kits.thrift.apache.asking import Asking
from yarpy.kits.thrift.apache.message import (
    NO_SERVICE,
    NOTHING,
    Answer,
    arrived,
    faulty,
    refusal_of,
    spelling_of,
    whole,
)
from yarpy.kits.thrift.apache.protocol import (
    CALL,
    INTERNAL_ERROR,
    ONEWAY,
    UNKNOWN_METHOD,
    Head,
)
from yarpy.kits.thrift.apache.scan import Scan
from yarpy.route import CarrierSpec, Route
from yarpy.wire.effects import May
from yarpy.wire.message import Message
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

NOBODY: Final = "thrift"  # what a client is called
_WORDS: Final = ("framed", "compact", "http", "path.PATH")
_LENGTH: Final = Packing(">i")


class Thrift(Asking):
    """A connection of a client, or to a server over a socket."""

    magic = b"\x80\x01\0\1"  # among others

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self.framed = "framed" in route.spec.tokens
        self._admitted = False
        self._owed: Head | None = None  # the call that waits for its answer
        self._taken = self._acked = 0  # calls handed to the port, and those it is done with

    @classmethod
    def of(cls, spec: CarrierSpec) -> type[Carrier]:
        refuse_unknown(spec, _WORDS)
        if "http" not in spec.tokens:
            if spec.value("path") is not None:
                raise LocalProtocolError("a path is said of thrift+http, where calls are posted")
            return cls
        if "framed" in spec.tokens:
            raise LocalProtocolError("over HTTP a message has no frame: leave out +framed")
        from yarpy.kits.thrift.apache.post import Post, path_of

        path_of(spec)
        return Post

    @classmethod
    def recognises(cls, first: bytes) -> int:
        if spelling_of(first):
            return 4
        return MAGIC_SIZE - 1 if first[:1] == b"\0" and spelling_of(first[4:]) else 0

    # -- the server -------------------------------------------------------------------------------

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[Carrier | None]:
        stream.unread(len(first))
        self.framed = not spelling_of(first)
        self.spelled = spelling_of(first[4:] if self.framed else first)
        self.route.source = NOBODY
        return None
        yield

    def decode(self, stream: ByteStream) -> Steps[Message]:
        data = yield from self._read(stream)
        call = arrived(self.spelled, data)
        head = call.head
        if head.kind not in (CALL, ONEWAY):
            raise RemoteProtocolError(f"a message of kind {head.kind}, where calls are expected")
        self._owed = head if head.kind == CALL else None
        if not self._admitted:
            why = yield May("write")
            if why:
                self._write(stream, faulty(self.spelled, INTERNAL_ERROR, why))
                raise AccessRefused(why)
            self._admitted = True
        self._taken += 1
        return call

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        if isinstance(value, Answer):
            if value is NOTHING:
                self._owed = None
            else:
                self._write(stream, value)
            return
        why = NO_SERVICE + refusal_of(value)
        self._write(stream, faulty(self.spelled, UNKNOWN_METHOD, why))

    def encode_ack(self, stream: ByteStream, count: int) -> None:
        self._acked += count
        if self._acked >= self._taken:  # not those before, which have come late
            self._write(stream, faulty(self.spelled, UNKNOWN_METHOD, NO_SERVICE))

    def _write(self, stream: ByteStream, answer: Answer) -> None:
        """Answer the call that waits, if there is one."""
        head, self._owed = self._owed, None
        if head is not None:
            self._send(stream, whole(self.spelled, head, answer))

    # -- both roles --------------------------------------------------------------------------------

    def _send(self, stream: ByteStream, data: bytes) -> None:
        stream.write(_LENGTH.pack(len(data)) + data if self.framed else data)

    def _read(self, stream: ByteStream) -> Steps[Buffer]:
        """The bytes of a message."""
        if self.framed:
            (size,) = _LENGTH.unpack((yield from stream.read_exact(4)))
            if not 0 < size <= stream.limit:
                raise RemoteProtocolError(
                    f"a frame of {size} bytes is announced; the limit is {stream.limit} bytes"
                )
            return (yield from stream.read_exact(size))
        scan = Scan(self.spelled)

        def parse(view: memoryview) -> tuple[bytes, int] | int:
            size = scan.advance(view)
            return (bytes(view[:size]), size) if scan.done else size

        return (yield from stream.read_parsed(parse))

    # -- the client -------------------------------------------------------------------------------

    def greet(self, stream: ByteStream) -> Steps[None]:
        self.acks = False  # a oneway call is not confirmed
        return
        yield

    def expect_reply(self, stream: ByteStream) -> Steps[Message | None]:
        if not self._awaits:
            return None
        data = yield from self._read(stream)
        self._awaits = False
        return self._returned(data)
