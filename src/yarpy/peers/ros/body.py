"""The bodies of messages on connections of ROS: from values of YARP programs, and to them.

    RosMessage      what came, as bytes; decoded when somebody looks, as what they ask for
    encode_body     what goes: an object of the type, or what can be made one

Rules: a type is its class (`yarpy.idl`). Where neither side says a type, a body is YARP's own
spelling; a list of one blob is the body itself. Time and number of a message with a header are its
envelope, both ways.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from struct import Struct
from typing import TYPE_CHECKING, Any, Final, TypeAlias, TypeGuard

from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.data.value import Blocks, Buffer
from yarpy.errors import DecodeError
from yarpy.wire.message import UNSENDABLE, Encoded, Message, Packet

if TYPE_CHECKING:
    from yarpy.peers.ros.message.message import Message as Ros

#: the class of a type; None where neither side has said one
Kind: TypeAlias = "type[Ros] | None"

#: what a message of one element is, where the element is one of these
SCALARS: Final = (str, int, float)
_STAMP: Final = Struct("<III")
_ENVELOPE: Final = re.compile(rb"\s*+([+-]?\d{1,10}+)\s++(\d{1,10}+)(?>(?:\.(\d{1,9}+)\d*+)?)")


class RosMessage(Message):
    """A message in the bytes of ROS. `ros` is the object of its type, `value` what a YARP program
    makes of it."""

    __slots__ = ("_ros", "kind")

    def __init__(self, key: str, body: Buffer, kind: type[Ros], envelope: str = "") -> None:
        Message.__init__(self, key, body, envelope, "foreign")  # quicker than by `super()`
        self.kind = kind
        self._ros: Ros | None = None

    @property
    def ros(self) -> Ros:
        """The object of the type. Raises DecodeError."""
        if self._ros is None:
            self._ros = self.kind.from_ros(self.payload)
        return self._ros

    def natural(self) -> Any:
        """An Image, a list of the fields, or the only field, as of any other message."""
        from yarpy.peers.ros.message.convert.native import to_value

        names, ros = self.kind._names, self.ros
        if len(names) == 1 and type(text := getattr(ros, names[0])) is str:
            return text  # as below, and as usual
        found = to_value(ros)
        alone = isinstance(found, Bottle) and len(found) == 1 and isinstance(found[0], SCALARS)
        return found[0] if alone else found

    def to_bytes(self) -> Buffer:
        from yarpy.peers.ros.message.convert.native import to_value

        return b"".join(codec.encode(to_value(self.ros)))

    def as_(self, type_: Any) -> Any:
        from yarpy.peers.ros.message.convert.native import to_value
        from yarpy.peers.ros.message.message import Message as Ros

        if not (isinstance(type_, type) and issubclass(type_, Ros)):
            return to_value(self.ros, type_)
        if type_ is self.kind:
            return self.ros
        if _identity(type_) == _identity(self.kind):
            return type_.from_ros(self.payload)
        raise DecodeError(f"a message of the type {self.kind._type}, not {type_._type}")

    def __reduce__(self) -> tuple[Callable[..., Message], tuple[str, bytes, str, str, Any]]:
        data = b"".join(codec.encode(self.natural()))
        return _copied, (self.key, data, self.envelope, self.source, self.type)


def _copied(key: str, data: bytes, envelope: str, source: str, type_: Any) -> Message:
    message = Message[Any](key, data, envelope).typed(type_)
    message.source = source
    return message


def _identity(kind: type[Ros]) -> tuple[str, str]:
    return kind._type, kind._md5sum


def message_of(key: str, body: Buffer, kind: Kind, raw: bool, headed: bool = False) -> Message:
    """Return the message for a body that was received. Without a type it is in YARP's format.
    `raw`: always make a blob of it; `headed`: `kind._has_header`."""
    if kind is not None:
        return RosMessage(key, body, kind, envelope_of(body) if headed else "")
    return Message(key, b"".join(codec.encode([bytes(body)])) if raw else body)


def encode_body(
    packet: Packet, kind: Kind, now: Callable[[], float] | None, frame: str = ""
) -> tuple[Buffer, ...]:
    """The body of what goes out, made once for all connections of a type and a `frame`: that of
    pictures and points.

    Raises TypeError, ValueError or OverflowError for what is nothing of that type.
    """
    key = "ros", kind, frame
    found = packet.forms.get(key)
    if found is None:
        found = packet.forms[key] = _encode(packet, kind, now, frame)
    return found


def _encode(
    packet: Packet, kind: Kind, now: Callable[[], float] | None, frame: str
) -> tuple[Buffer, ...]:
    value: Any = packet.value
    if kind is not None and type(value) is kind and not packet.envelope:
        blocks: Blocks = value.to_ros()
        return blocks
    if isinstance(value, Encoded):
        value = codec.decode(value.data)
    if _is_blob(value) and (kind is None or not _takes_blob(kind)):
        return (value[0],)
    if kind is None:
        return tuple(packet.blocks)
    from yarpy.peers.ros.message.convert.native import to_message
    from yarpy.peers.ros.message.message import Message as Ros

    if isinstance(value, Ros):
        if (value._type, value._md5sum) != _identity(kind):
            raise TypeError(f"{kind._type} is expected here, not {value._type}")
        if not packet.envelope:
            return value.to_ros()
    try:
        made = to_message(value, kind, frame_id=frame)
    except UNSENDABLE as error:
        raise type(error)(f"{kind._type} is expected here: {error}") from None
    return _stamped(made.to_ros(), kind, packet.envelope, now)


def _is_blob(value: Any) -> TypeGuard[Sequence[bytes]]:
    """Return whether a value is a list of one blob."""
    return isinstance(value, (list, tuple)) and len(value) == 1 and isinstance(value[0], bytes)


def _takes_blob(kind: type[Ros]) -> bool:
    """Return whether a list of one blob can be a message of the type: its one field is an array of
    bytes."""
    fields = kind._definition.struct.fields
    return len(fields) == 1 and str(fields[0].type).startswith("uint8[")


def envelope_of(body: Buffer) -> str:
    """Number and time of a message with a header, as an envelope."""
    if len(body) < _STAMP.size:
        return ""
    count, seconds, nanoseconds = _STAMP.unpack_from(body)
    if nanoseconds >= 1_000_000_000:
        return ""
    return f"{count & 0x7FFFFFFF} {seconds}.{nanoseconds:09d}"


def said_by(envelope: bytes) -> tuple[int, int, int] | None:
    """Number, seconds and nanoseconds in an envelope, if it is a Stamp."""
    found = _ENVELOPE.match(envelope)
    if found is None:
        return None
    return max(int(found[1]), 0), int(found[2]), int((found[3] or b"0").ljust(9, b"0"))


def _stamped(
    blocks: Blocks, kind: type[Ros], envelope: bytes, now: Callable[[], float] | None
) -> Blocks:
    """The message with number and time of its envelope, else with the time that it is."""
    if not kind._has_header:
        return blocks
    count, seconds, nanoseconds = _STAMP.unpack_from(blocks[0])
    said = said_by(envelope)
    if said is not None:
        count, seconds, nanoseconds = said
    elif not (seconds or nanoseconds) and now is not None:
        seconds, nanoseconds = divmod(round(now() * 1e9), 1_000_000_000)
    head = _STAMP.pack(count & 0xFFFFFFFF, seconds & 0xFFFFFFFF, nanoseconds)
    return (head + bytes(blocks[0][_STAMP.size :]), *blocks[1:])
