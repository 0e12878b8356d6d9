"""Calls and answers, as they travel between the carrier and those who know the service.

    Call      a call that has come: the head, and the struct of its arguments
    Asked     a call to make
    Answer    what is answered to a Call, or NOTHING
    Returned  an answer that has come

Rules: bytes in the spelling of the connection, `binary` or `compact`; who has the service reads
them. To loggers a call is what it would be on YARP's wire, once a service has taken it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from yarpy.data import codec
from yarpy.data.value import Buffer
from yarpy.errors import DecodeError
from yarpy.kits.thrift.apache.decode import READERS
from yarpy.kits.thrift.apache.encode import WRITERS
from yarpy.kits.thrift.apache.protocol import (
    EXCEPTION,
    ONEWAY,
    REPLY,
    Fault,
    Head,
)
from yarpy.kits.thrift.kind import I32, TEXT
from yarpy.limit import THRIFT_REASON
from yarpy.wire.message import CALL, DATA, Message, Refused

NO_SERVICE: Final = "there is no service of Thrift at this port"
_BINARY: Final = b"\x80\x01\x00"
_COMPACT: Final = (b"\x82\x21", b"\x82\x41", b"\x82\x61", b"\x82\x81")


def spelling_of(first: bytes) -> str:
    """Return which protocol a message begins in: `binary`, `compact`, "" for neither."""
    if first.startswith(_BINARY):
        return "binary"
    return "compact" if first.startswith(_COMPACT) else ""


class Call(Message[Any]):
    """A call that has come, of a method in a service of Thrift. What is no such service cannot read
    its value: DecodeError."""

    __slots__ = ("at", "head", "request", "thrift")

    def __init__(self, thrift: str, head: Head, data: Buffer, at: int) -> None:
        super().__init__(DATA if head.kind == ONEWAY else CALL, data, spelling="foreign")
        self.thrift = thrift
        self.head = head
        self.at = at  # where the struct begins
        self.request: Callable[[], bytes] | None = None  # the same on YARP's wire

    def natural(self) -> Any:
        """The call as it would be on YARP's wire, for loggers."""
        if self.request is None:
            raise DecodeError(
                f'a call of "{self.head.name[:60]}" in a protocol of Apache Thrift: only a service '
                "of a .thrift file answers those"
            )
        return codec.decode(self.request())

    def to_bytes(self) -> Buffer:
        self.natural()
        assert self.request is not None
        return self.request()

    def as_(self, type_: Any) -> Any:
        return codec.decode_as(self.to_bytes(), type_)

    def __reduce__(self) -> tuple[Any, ...]:
        return Call, (self.thrift, self.head, bytes(self.payload), self.at)


class Answer:
    """An answer: REPLY or EXCEPTION, and a struct. `request` makes the answer on YARP's
    wire, for loggers."""

    def __init__(self, kind: int, body: bytes, wire: Callable[[], bytes] | None = None) -> None:
        self.kind = kind
        self.body = body
        self._wire = wire

    def to_wire(self) -> tuple[Buffer, ...]:
        """The bytes of YARP's wire."""
        return (self._wire(),) if self._wire is not None else codec.encode([])


#: the answer to a call that wants none
NOTHING: Final = Answer(REPLY, b"")


def arrived(thrift: str, data: Buffer) -> Call:
    """Return the call in a whole message. DecodeError."""
    reader = READERS[thrift](data)
    return Call(thrift, reader.head(), data, reader.at)


def written(thrift: str, head: Head, body: bytes) -> bytes:
    """Return a whole message."""
    writer = WRITERS[thrift]()
    writer.head(head)
    return bytes(writer.out) + body


def whole(thrift: str, head: Head, answer: Answer) -> bytes:
    """Return the answer to the call with that head as a whole message."""
    return written(thrift, Head(answer.kind, head.name, head.number), answer.body)


def refusal_of(value: object) -> str:
    """Return why a port that has no service refuses a call, as the end of a text."""
    return f": {value.why}" if isinstance(value, Refused) else ""


class Asked:
    """A call to make: its method, the struct of its arguments, and whether an answer comes."""

    def __init__(self, thrift: str, kind: int, name: str, body: bytes) -> None:
        self.thrift = thrift
        self.kind = kind
        self.name = name
        self.body = body

    def to_wire(self) -> tuple[Buffer, ...]:
        raise TypeError(
            f"a call of {self.name} in a protocol of Apache Thrift leaves over the carrier thrift "
            "alone"
        )


class Returned(Message[Any]):
    """An answer that has come."""

    __slots__ = ("at", "head", "thrift")

    def __init__(self, thrift: str, head: Head, data: Buffer, at: int) -> None:
        super().__init__(CALL, data, spelling="foreign")
        self.thrift, self.head, self.at = thrift, head, at

    def natural(self) -> Any:
        """The struct of the answer, as bytes."""
        return bytes(self.payload[self.at :])


def faulty(thrift: str, kind: int, text: str) -> Answer:
    """Return the answer to a call that has no result: why, and a number for that."""
    writer = WRITERS[thrift]()
    writer.begin()
    data = text.encode("utf-8", "replace")[:THRIFT_REASON]
    writer.field(11, 1)
    writer.blob(data)
    writer.field(8, 2)
    writer.i32(kind)
    writer.stop()
    return Answer(EXCEPTION, bytes(writer.out), lambda: b"".join(codec.encode(["fail", text])))


def fault_of(message: Returned) -> Fault:
    """Return what an answer of the kind EXCEPTION says. DecodeError."""
    from yarpy.kits.thrift.apache.decode import fields

    reader = READERS[message.thrift](message.payload, message.at)
    found = fields(reader, {1: TEXT, 2: I32}, "the exception")
    return Fault(found.get(2, 0), found.get(1, ""))
