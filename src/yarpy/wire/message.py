"""Packet (going out) and Message (come in): one unit of what ports say to each other.

Rules: a Packet encodes each spelling at most once, however many links it goes to. A Message keeps
its payload as it arrived and decodes it on first use, in the thread that uses it; a message that is
dropped is never parsed. This is the one file of the wire that knows the data room.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, Generic, Literal, Protocol, Self, TypeAlias, overload

from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.data.yarp4 import newest
from yarpy.errors import DecodeError, LocalProtocolError

if TYPE_CHECKING:
    from collections.abc import Callable

    from typing_extensions import TypeVar

    from yarpy.data.stamp import Stamp
    from yarpy.wire.stream import Buffer

    #: what a port is for: `Port[Image]`; without it its messages may be anything
    T = TypeVar("T", default=Any)
else:
    from typing import TypeVar

    T = TypeVar("T")

K = TypeVar("K")
#: `foreign`: bytes of another system, which its own class of Message can read
Spelling: TypeAlias = Literal["binary", "text", "object", "foreign"]

DATA: Final = "D"  # data, no reply wanted
CALL: Final = "d"  # data, the sender reads a reply
ADMIN: Final = "a"
QUIT: Final = "q"

JSON: Final = "json"  # the asker wants values that programs can read, not lines for a person

#: What encoding raises for a value that cannot be sent: an unknown type, a number too large, a list
#: too deep.
UNSENDABLE: Final = (TypeError, ValueError, OverflowError)

SMALL: Final = 2048  # bytes; larger messages gain nothing from coalescing

UNSET: Final = object()  # the value of a message that nobody has looked at
_COPIED: Final = ("key", "envelope", "spelling", "text", "source", "type")


class Lines(tuple[str, ...]):
    """A reply of plain text lines, as old name services give them: not a Bottle, and not quoted.

    On binary connections it is a Bottle of one string.
    """

    __slots__ = ()

    def to_wire(self) -> tuple[Buffer, ...]:
        return codec.encode(["".join(f"{line}\r\n" for line in self)])

    def to_text(self) -> bytes:
        """The lines with their ends."""
        text = "".join(f"{line}\r\n" for line in self)
        return text.encode("utf-8", "surrogateescape")


class Refused(Bottle):
    """The answer to a peer that may not do what it asks for: `[fail]` and why. `status`: the same
    in HTTP."""

    status = 403

    def __init__(self, why: str) -> None:
        super().__init__([Vocab("fail"), why])
        self.why = why


class Malformed(Refused):
    """The answer to a message that cannot be read."""

    status = 400


class Encoded:
    """A value that is already in its binary spelling; as text, the value of these bytes."""

    __slots__ = ("data",)

    def __init__(self, data: Buffer) -> None:
        self.data = data

    def to_wire(self) -> tuple[Buffer, ...]:
        return (self.data,)

    def to_text(self) -> bytes:
        return codec.encode_text(codec.decode(self.data))


def in_yarp4(value: object) -> object:
    """Return a value as YARP 4 spells it; itself if that is no other."""
    blocks = codec.encode(value)
    other = newest(blocks)
    return value if other is blocks else Encoded(b"".join(other))


class Packet:
    """A message to send: an object, its envelope, and whether a reply is wanted.

    `key` is the port command: `D` data, `d` data with a reply wanted, `a` administrative.
    """

    __slots__ = ("_blocks", "_line", "envelope", "foreign", "forms", "framed", "key", "value")

    def __init__(self, value: object, envelope: bytes = b"", key: str = DATA) -> None:
        self.value = value
        self.envelope = envelope
        self.key = key
        self._blocks: tuple[Buffer, ...] | None = None
        self._line: bytes | None = None
        self.framed: list[Buffer] | None = None  # kept by the framing that several carriers share
        self.foreign: Buffer | None = None  # ... and by the payloads of those for other programs
        #: a cache for carriers: what each made of the packet, under a key of its own
        self.forms: dict[object, Any] = {}

    @property
    def blocks(self) -> tuple[Buffer, ...]:
        """The binary spelling, in pieces; large arrays are views of the user's memory."""
        if self._blocks is None:
            try:
                self._blocks = codec.encode(self.value)
            except Exception as error:
                mark_unsent(error)
                raise
        return self._blocks

    @property
    def newest(self) -> Packet:
        """The packet as YARP 4 spells it; itself if that is no other."""
        if "newest" not in self.forms:
            blocks = newest(self.blocks)
            other = None if blocks is self.blocks else Packet(self.value, self.envelope, self.key)
            if other is not None:
                other._blocks = blocks
            self.forms["newest"] = other
        return self.forms["newest"] or self

    def snapshot(self, spelling: Spelling) -> None:
        """Encode now, into memory of our own: the message leaves later, and its writer goes on
        meanwhile. The text of arrays, which takes long, is made from that when it leaves.
        """
        if spelling == "text" and codec.has_own_text(self.value):
            _ = self.line
        elif spelling != "object":
            blocks = self.blocks
            if any(type(block) is not bytes for block in blocks):
                self._blocks = tuple(map(bytes, blocks))
                self.framed = None

    @property
    def small(self) -> bool:
        """Return whether it is encoded into memory of its own, which the writer cannot change."""
        framed = self.framed
        return framed is not None and len(framed) == 1 and len(framed[0]) < SMALL

    @classmethod
    def of(cls, message: Message, before: Packet) -> Packet:
        """Return the packet that a monitor made of the packet `before`."""
        value = Encoded(message.payload) if message.spelling == "binary" else message.payload
        if value is before.value and message.envelope.encode() == before.envelope:
            return before
        if message.spelling == "text":
            value = message.value
        return cls(value, message.envelope.encode(), before.key)

    @property
    def line(self) -> bytes:
        """The text spelling, without a line end."""
        if self._line is None:
            if codec.has_own_text(self.value):
                try:
                    self._line = codec.encode_text(self.value)
                except Exception as error:
                    mark_unsent(error)
                    raise
            else:
                self._line = codec.encode_as_text(b"".join(self.blocks))
        return self._line


def mark_unsent(error: Exception) -> None:
    """Note at `error` that a method of the value raised it, such as its `to_wire`, so that nothing
    has left. UNSENDABLE say so by themselves."""
    if not isinstance(error, UNSENDABLE):
        try:
            error.yarpy_unsent = True  # type: ignore[attr-defined]
        except AttributeError:
            pass  # it takes no attributes, and so ends the connection


def is_unsent(error: Exception) -> bool:
    """Return whether a value could not be encoded, so that nothing of it has left."""
    return isinstance(error, UNSENDABLE) or getattr(error, "yarpy_unsent", False)


class Answering(Protocol):
    """The part of a connection that answers."""

    yarp4: bool
    """They are spelled as YARP 4 does."""

    def reply(self, value: object) -> None:
        """Put an answer on the wire. Raises as `Message.reply`."""


class Answer:
    """The way back of one question: a holder of the message may answer, once, from any thread.

    `by` puts it on the wire. `then` is called once that is done, or has failed for good; it is
    set by the thread that waits for the end of the question. Who finds, when it leaves a question,
    that another thread is answering sets `left`, which that thread calls behind its answer, and
    then looks whether it is still `busy`.
    """

    __slots__ = ("_ended", "by", "forsaken", "left", "right", "then")

    def __init__(self, by: Answering, then: Callable[[], None] | None = None) -> None:
        self.by = by
        self.then = then
        self.left: Callable[[], None] | None = None
        self.right = [True]  # to answer; a thread takes it out, which only one can
        self._ended = False  # who had the right has used it
        self.forsaken = False  # the port was interrupted or closed: nobody will

    @property
    def busy(self) -> bool:
        """Return whether a thread is answering."""
        return not (self.right or self._ended)

    def note_yarp4(self) -> None:
        """Note that who asks spells floats as YARP 4 does, and is to be answered so."""
        self.by.yarp4 = True

    def give(self, value: object) -> None:
        """Send it. What cannot be sent leaves the question open. Raises as `Message.reply`."""
        try:
            del self.right[0]  # no call: an exception out of a signal handler comes before or after
        except IndexError:
            raise LocalProtocolError(
                "the question was answered already, or its sender went away"
            ) from None
        unsent = False
        try:
            self.by.reply(value)
        except Exception as error:
            unsent = is_unsent(error)
            raise
        finally:
            if unsent:
                self.right.append(True)
            else:
                self._ended = True
                if self.then is not None:
                    self.then()
            if self.left is not None:
                self.left()


class Message(Generic[T]):
    """A message that was received. `value` is the natural Python object, or that of a port's type;
    `as_(Type)` the same bytes as any type.

    `source` is the name of the sending port, `envelope` the text that travels beside the data,
    `stamp` that text read as count and time. `reply(obj)` answers a sender that wants an answer.
    """

    __slots__ = (
        *("_value", "answer", "envelope", "key", "payload", "source", "spelling", "text", "type"),
    )

    def __init__(
        self,
        key: str,
        payload: Any = b"",
        envelope: str = "",
        spelling: Spelling = "binary",
        text: str = "",
    ) -> None:
        self.key = key
        self.payload = payload
        self.envelope = envelope
        self.spelling = spelling
        self.text = text  # what followed a port command; behind data, the form of the answer: JSON
        self.source = ""
        self.answer: Answer | None = None  # set by the link of a question
        self.type: Any = None  # what the port that it came to is for; None: anything
        self._value: object = UNSET

    @classmethod
    def of(cls, packet: Packet) -> Message:
        """An outgoing packet as a message, for a monitor to look at."""
        return cls(packet.key, packet.value, packet.envelope.decode(), "object")

    def replaced(self, value: object, binary: bool = False) -> Message:
        """A message like this one, to the same receiver, with another value.

        With `binary`, `value` is a bytes-like object: the new value's binary spelling.
        """
        fresh = Message(self.key, value, self.envelope, "binary" if binary else "object", self.text)
        fresh.source, fresh.answer, fresh.type = self.source, self.answer, self.type
        return fresh

    def __getstate__(self) -> dict[str, Any]:
        """For copies, also those in other processes: they have memory of their own and take no
        answer.
        """
        payload = self.payload
        return {
            **{name: getattr(self, name) for name in _COPIED},
            "payload": bytearray(payload) if isinstance(payload, memoryview) else payload,
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        for name, value in state.items():
            setattr(self, name, value)
        self.answer, self._value = None, UNSET

    def to_bytes(self) -> Buffer:
        """The payload's binary spelling."""
        if self.spelling == "binary":
            payload: Buffer = self.payload
            return payload
        return b"".join(codec.encode(self.natural()))

    @property
    def value(self) -> T:
        """The payload as the natural Python object (Bottle, str, number, Image, Vector ...), or as
        the type of the port that it came to: an Image of a `Port[Image]`.

        Raises DecodeError if the payload is not what it claims to be, or something else.
        """
        if self._value is UNSET:
            self._value = self.natural() if self.type is None else self.as_(self.type)
        return self._value  # type: ignore[return-value]

    def typed(self, type_: Any) -> Self:
        """Let `value` be of that type, and return the message."""
        self.type = type_
        if type(self._value) is not type_:
            self._value = UNSET
        return self

    def natural(self) -> Any:
        """Return the payload as the Python object that is nearest to it, whatever the port is for.
        Raises DecodeError."""
        if self.spelling == "binary":
            return codec.decode(self.payload, self.answer)
        if self.spelling == "text":
            return codec.decode_text(self.payload)
        return self.payload

    def to_json(self) -> str:
        """The JSON text of the payload, as web pages get it; see `yarpy.to_json`. Raises
        DecodeError."""
        from yarpy.data.json import to_json

        return to_json(self.natural())

    @overload
    def as_(self, type_: type[K]) -> K: ...
    @overload
    def as_(self, type_: object) -> Any: ...
    def as_(self, type_: Any) -> Any:
        """The payload as `type_` (Bottle, Property, dict, Vector, Image, Stamp, numpy.ndarray ...).

        Arrays are views of the received bytes. A type may also be named, as `yarpy plugin` lists
        them: "image", or one of another package. Raises DecodeError if the payload is something
        else, UnknownPlugin for a name that nobody knows.
        """
        if isinstance(type_, str):
            type_ = codec.named(type_)
        if self.spelling == "binary":
            return codec.decode_as(self.payload, type_, self.answer)
        if self.spelling == "text":
            return codec.decode_text_as(self.payload, type_)
        payload: object = self.payload
        if isinstance(type_, type) and type(payload) is type_:
            return payload
        return codec.decode_as(b"".join(codec.encode(payload)), type_)

    @property
    def stamp(self) -> Stamp | None:
        """The envelope read as a Stamp, or None if it is none."""
        from yarpy.data.stamp import Stamp

        try:
            return Stamp.from_text(self.envelope) if self.envelope else None
        except DecodeError:
            return None

    @property
    def wants_reply(self) -> bool:
        """Return whether the sender is waiting for a reply."""
        return self.answer is not None and bool(self.answer.right)

    def reply(self, value: object) -> None:
        """Answer the sender. Once, and only if it asked: see `wants_reply`.

        Raises LocalProtocolError otherwise, LinkClosed if the sender has gone; TypeError,
        ValueError or OverflowError for what cannot be sent, which leaves the question open.
        """
        answer = self.answer
        if answer is None or not answer.right:
            raise LocalProtocolError(
                f'"{self.source}" does not wait for a reply: it sent plain data, went away, or was '
                "answered already; call it with an RpcClient to get replies"
            )
        answer.give(value)

    def __repr__(self) -> str:
        try:
            value = repr(self.value)
        except ValueError as error:
            value = f"undecodable: {error}"
        if len(value) > 100:
            value = value[:97] + "..."
        source = f" from {self.source}" if self.source else ""
        envelope = f" [{self.envelope}]" if self.envelope else ""
        return f"<Message{source}{envelope}: {value}>"
