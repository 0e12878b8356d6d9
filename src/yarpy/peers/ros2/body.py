"""The bodies of messages of ROS 2: from values of YARP programs, and to them.

Rules: a type is its class (`message`), and always known. Time in a message's header is
its envelope, both ways; of a message without header the time goes beside it. ROS 2 does not number
messages in their headers: the number of an envelope is that of the publisher.
"""

from __future__ import annotations

from collections.abc import Callable
from struct import Struct
from typing import Any, Final

from yarpy.data import codec
from yarpy.data.value import Buffer
from yarpy.peers.ros.body import RosMessage, said_by
from yarpy.peers.ros.message.convert.native import to_message, to_value
from yarpy.peers.ros.message.message import Message as Ros
from yarpy.wire.message import UNSENDABLE, UNSET, Encoded, Packet

_HEAD: Final = 4  # bytes in front of the fields
_STAMP: Final = Struct("<iI")
_FIELDS: Final = _HEAD + _STAMP.size  # ... and those behind the time
_NO_TIME: Final = bytes(_STAMP.size)
_SECOND: Final = 1_000_000_000


def value_of(packet: Packet) -> Any:
    """Return the value of a packet that is to be sent."""
    value = packet.value
    return codec.decode(value.data) if isinstance(value, Encoded) else value


def encode_body(
    packet: Packet, kind: type[Ros], now: Callable[[], float] | None
) -> tuple[Buffer, ...]:
    """The body of what goes out, made once for all connections of a type.

    Raises TypeError, ValueError or OverflowError for what is nothing of that type.
    """
    key, forms = ("ros2", kind), packet.forms
    found: tuple[Buffer, ...] | None = forms.get(key)
    if found is None:
        value: Any = packet.value
        if type(value) is kind and not packet.envelope:
            found = value.to_ros()
        elif type(value) is str and kind._is_text:  # as below, without the steps to it
            try:
                found = kind(value).to_ros()
            except UNSENDABLE as error:
                raise _misfit(kind, error) from None
        else:
            found = _encode(packet, kind, now)
        forms[key] = found
    return found


def _encode(packet: Packet, kind: type[Ros], now: Callable[[], float] | None) -> tuple[Buffer, ...]:
    value = value_of(packet)
    try:
        if isinstance(value, Ros):
            if (value._type, value._md5sum) == (kind._type, kind._md5sum):
                return _stamped(value.to_ros(), kind, packet.envelope, None)
            value = to_value(value)  # of ROS 1, or another version: perhaps there is an Image in it
        made = to_message(value, kind)
    except UNSENDABLE as error:
        raise _misfit(kind, error) from None
    return _stamped(made.to_ros(), kind, packet.envelope, now)


def _misfit(kind: type[Ros], error: Exception) -> Exception:
    return type(error)(f"{kind._type} is expected here: {error}")


def _stamped(
    blocks: tuple[Buffer, ...], kind: type[Ros], envelope: bytes, now: Callable[[], float] | None
) -> tuple[Buffer, ...]:
    """The message with the time of its envelope, else, where it has none, with the time it is."""
    if not kind._has_header:
        return blocks
    said = said_by(envelope)
    first = bytes(blocks[0])
    if said is not None:
        seconds, nanoseconds = said[1:]
    elif now is not None and first[_HEAD:_FIELDS] == _NO_TIME:
        seconds, nanoseconds = divmod(round(now() * 1e9), _SECOND)
    else:
        return blocks
    time = _STAMP.pack(seconds & 0x7FFFFFFF, nanoseconds)
    return (first[:_HEAD] + time + first[_FIELDS:], *blocks[1:])


def time_of(packet: Packet) -> int:
    """The time that its envelope says, in nanoseconds; 0 if it says none."""
    said = said_by(packet.envelope)
    return 0 if said is None else said[1] * _SECOND + said[2]


class Ros2Message(RosMessage):
    """A message that was received. `headed`: it begins with a header; `number`, `time`: those of
    the attachment."""

    __slots__ = ("_headed", "_number", "_said", "_time")

    def __init__(
        self, key: str, body: Buffer, kind: type[Ros], headed: bool, number: int, time: int
    ) -> None:
        # As `RosMessage` and `Message` do, spelled out: this is done for each message.
        self.key = key
        self.payload = body
        self.spelling = "foreign"
        self.text = self.source = ""
        self.answer = self.type = self._ros = None
        self._value = UNSET
        self.kind = kind
        self._headed, self._number, self._time = headed, number, time
        self._said: str | None = None

    @property
    def envelope(self) -> str:
        """The number, and the time in the header, else that of the attachment. Made when somebody
        looks."""
        said = self._said
        if said is None:
            said = self._said = self._envelope()
        return said

    @envelope.setter
    def envelope(self, text: str) -> None:
        self._said = text

    def _envelope(self) -> str:
        body = self.payload
        seconds, nanoseconds = divmod(self._time, _SECOND)
        if self._headed and len(body) >= _FIELDS:
            said = _STAMP.unpack_from(body, _HEAD)
            if said[0] >= 0 and said[1] < _SECOND and any(said):
                seconds, nanoseconds = said
        return f"{self._number & 0x7FFFFFFF} {seconds}.{nanoseconds:09d}" if seconds >= 0 else ""
