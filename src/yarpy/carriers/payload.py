"""Payloads for programs that know nothing of YARP, such as those at a broker.

    what a port writes               what they get
    a picture of 8 bits a channel    a JPEG file
    bytes, or a list of one blob     these bytes
    everything else                  its JSON (yarpy.data.json)

    what they send                   what a port reads
    a JPEG file                      an Image
    JSON                             its value
    other text in UTF-8              a string
    anything else                    bytes

Rules: pure. A payload is decoded when somebody looks at the message, in their thread. The envelope
of a picture is the comment in the JPEG file, as with mjpeg.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

from yarpy.data import codec
from yarpy.data.json import from_json, to_json
from yarpy.data.json_plain import plain_json
from yarpy.data.sig import jpeg
from yarpy.data.sig.image import Image, is_image
from yarpy.data.value import Buffer
from yarpy.errors import DecodeError
from yarpy.wire.message import Encoded, Message, Packet

JPEG: Final = b"\xff\xd8\xff"
#: pixels that a JPEG file holds as they are, but for what compression loses
COLOURS: Final = frozenset(("mono", "rgb", "bgr", "rgba", "bgra"))
_BYTES: Final = (bytes, bytearray, memoryview)
_PLAIN: Final = (str, int, float, Mapping, Image)


def to_payload(packet: Packet) -> Buffer:
    """Return a packet as other middlewares get it, encoded once for all of them. Raises TypeError,
    ValueError or OverflowError for what cannot be sent."""
    found = packet.foreign
    if found is None:
        found = packet.foreign = payload_of(packet.value, packet.envelope)
    return found


def payload_of(value: Any, envelope: bytes = b"") -> Buffer:
    """Return a value as other middlewares get it."""
    text = plain_json(value)
    if text is not None and text.isascii():
        return text.encode()
    if isinstance(value, (list, tuple)):
        if len(value) == 1 and isinstance(value[0], _BYTES):
            return bytes(value[0])
        return to_json(value).encode()
    if isinstance(value, _BYTES):
        return bytes(value)
    if not isinstance(value, _PLAIN):
        blocks = codec.encode(value)
        if blocks and is_image(blocks[0]):
            value = Image.from_wire(blocks[0] if len(blocks) == 1 else b"".join(blocks))
        elif isinstance(value, Encoded):
            return payload_of(codec.decode(value.data), envelope)
    if isinstance(value, Image) and str(value.code) in COLOURS:
        try:
            data = jpeg.encode(value)
        except ValueError:  # none, or more pixels than a JPEG file can have
            return to_json(value).encode()
        return jpeg.commented(data, envelope) if envelope else data
    return to_json(value).encode()


def value_of(data: Buffer) -> Any:
    """Return the value that a payload of another middleware stands for."""
    if data[:3] == JPEG:
        try:
            return Image.from_wire(jpeg.decode(data))
        except DecodeError:
            return bytes(data)
    try:
        return from_json(data)
    except DecodeError:
        pass
    try:
        return str(data, "utf-8")
    except UnicodeDecodeError:
        return bytes(data)


class PayloadMessage(Message):
    """A message of several frames or one, mostly one, in the bytes of others."""

    __slots__ = ()

    def natural(self) -> Any:
        """The value of the payload; of several frames, a list of theirs."""
        if len(self.payload) == 1:
            return value_of(self.payload[0])
        parts = [value_of(part) for part in self.payload]
        return codec.decode(b"".join(codec.encode(parts)))

    def to_bytes(self) -> Buffer:
        return b"".join(codec.encode(self.natural()))

    def as_(self, type_: Any) -> Any:
        type_ = codec.named(type_)
        if type_ is bytes and len(self.payload) == 1:
            return bytes(self.payload[0])
        value = self.value if self.type is None else self.natural()
        if isinstance(type_, type) and type(value) is type_:
            return value
        return codec.decode_as(b"".join(codec.encode(value)), type_)

    def __reduce__(self) -> tuple[Callable[..., Message], tuple[str, Buffer, str, str, Any]]:
        return _copied, (self.key, self.to_bytes(), self.envelope, self.source, self.type)


def _copied(key: str, data: Buffer, envelope: str, source: str, type_: Any) -> Message:
    message = Message[Any](key, data, envelope).typed(type_)
    message.source = source
    return message


def message_of(key: str, frames: Sequence[Buffer]) -> Message:
    """Return the message that has arrived in these frames."""
    envelope = ""
    if len(frames) == 1 and frames[0][:3] == JPEG:
        envelope = jpeg.comment(frames[0])
    return PayloadMessage(key, tuple(frames), envelope, "foreign")
