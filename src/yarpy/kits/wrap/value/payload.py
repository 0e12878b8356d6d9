"""Values as bytes, for middlewares that carry nothing else: JSON, a JPEG file, bytes, or a frame.

    a value that JSON brings back equal      JSON
    bytes, where the hint says so            these bytes
    a picture with jpeg=                     a JPEG file
    everything else                          a frame, as one message

Rules: who reads tells these by their first bytes, and with them what Wrapyfi sends over MQTT and
Zenoh: a header in JSON, in front of it its length (u32, big-endian) or behind it a line end, then
pixels, samples or a JPEG file. JSON has no room for count and time; frames have.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

from yarpy.data.sig.image import Image
from yarpy.data.sig.jpeg import decode as decode_jpeg
from yarpy.errors import DecodeError
from yarpy.kits.wrap.middleware import Failure, Item, Received
from yarpy.kits.wrap.value import frame
from yarpy.kits.wrap.value.array import Picture
from yarpy.kits.wrap.value.shape import ANY, Row, Scalar, Several, Shape
from yarpy.kits.wrap.value.spelling import jpeg_of
from yarpy.kits.wrap.value.tree import TAG, Buffer, from_text, to_text
from yarpy.limit import WRAPYFI_HEADER

if TYPE_CHECKING:
    from numpy.typing import NDArray

JPEG: Final = b"\xff\xd8\xff"
_HEADER: Final = b'{"yarpy": 1,'  # how that of a frame begins
_ERROR: Final = "error"  # the tag of an answer that tells of an exception


def pack(item: Item, encoding: str = "native") -> list[Buffer]:
    """The bytes of an item, in pieces. Raises TypeError, ValueError for what cannot be sent."""
    jpeg = jpeg_of(item)
    if encoding == "wrapyfi" and not isinstance(item.shape, Picture):
        return [to_text(item.plain).encode()]
    if encoding == "native":
        if jpeg is not None:
            return [jpeg.data]
        found = _native(item)
        if found is not None:
            return [found]
    value = item.plain if jpeg is None else jpeg
    return frame.to_bytes(frame.Frame(value, item.count, item.time, item.source))


def parts(item: Item, encoding: str = "native") -> list[Buffer]:
    """The same for middlewares with messages of several parts: of a frame, header and buffers."""
    jpeg = jpeg_of(item)
    if encoding == "native" and jpeg is None:
        found = _native(item)
        if found is not None:
            return [found]
    elif encoding != "frame":
        return pack(item, encoding)
    value = item.plain if jpeg is None else jpeg
    return frame.to_parts(frame.Frame(value, item.count, item.time, item.source))


def joined(item: Item, encoding: str = "native") -> bytes:
    """The same as one piece."""
    return b"".join(pack(item, encoding))


def _native(item: Item) -> bytes | None:
    plain, shape = item.plain, item.shape
    if isinstance(shape, Scalar) and shape.kind is bytes:
        return None if frame.is_frame(plain) else plain
    if isinstance(shape, (Row, Several)) and not isinstance(plain, (set, frozenset)):
        plain = list(plain)
    return json.dumps(plain).encode() if _survives(plain) else None


def _survives(value: Any) -> bool:
    """Return whether a value is equal after JSON."""
    kind = type(value)
    if kind is str or kind is int or kind is bool or value is None:
        return True
    if kind is float:
        return math.isfinite(value)
    if kind is list:
        return all(map(_survives, value))
    if kind is dict:
        return all(type(key) is str and key != TAG and _survives(v) for key, v in value.items())
    return False


def unpack(data: Buffer, shape: Shape) -> Received:
    """Decode the bytes of a payload. Raises DecodeError."""
    if frame.is_frame(data):
        found = frame.from_bytes(data)
        return Received(shape.load(found.value), found.count, found.time, found.source)
    if isinstance(shape, Scalar) and shape.kind is bytes:
        return Received(bytes(data))
    return Received(shape.load(value_of(data)))


def of_parts(found: Sequence[Buffer], shape: Shape = ANY) -> Received:
    """Decode the parts of a message: those of `parts`, or of Wrapyfi. Raises DecodeError."""
    if not found:
        raise DecodeError("a message without a payload")
    if bytes(found[0][: len(_HEADER)]) == _HEADER:
        made = frame.from_parts(found)
        return Received(shape.load(made.value), made.count, made.time, made.source)
    if len(found) == 2 and bytes(found[0][:10]) == b"{timestamp":  # of its pictures and sounds
        found = found[1:]
    if len(found) != 1:
        raise DecodeError(f"a message of {len(found)} parts")
    return unpack(found[0], shape)


def value_of(data: Buffer) -> Any:
    """The value of bytes that are no frame: of JSON, of Wrapyfi's forms, of a JPEG file; a text;
    else the bytes."""
    if bytes(data[:3]) == JPEG:
        return _picture(data)
    whole = bytes(data)
    if whole[:1] == b"\0" and len(whole) > 4:
        length = int.from_bytes(whole[:4], "big")
        if length <= WRAPYFI_HEADER and whole[4:5] == b"{":
            return _of_header(whole[4 : 4 + length], memoryview(data)[4 + length :])
    line = whole.find(b"\n", 0, WRAPYFI_HEADER) if whole[:1] == b"{" else -1
    if line >= 0 and whole[line - 1 : line] == b"}":
        try:
            return _of_header(whole[:line], memoryview(data)[line + 1 :])
        except DecodeError:
            pass  # perhaps a JSON text of several lines
    try:
        return from_text(whole)
    except DecodeError:
        pass
    try:
        return whole.decode()
    except UnicodeDecodeError:
        return whole


def _picture(data: Buffer) -> Image:
    return Image.from_wire(decode_jpeg(data))


def _of_header(header: bytes, body: memoryview) -> Any:
    """Decode Wrapyfi's header and body. Raises DecodeError."""
    said = from_text(header)
    if not isinstance(said, dict) or "timestamp" not in said:
        raise DecodeError("a header without a timestamp")
    if "shape" not in said:
        return _picture(body)
    array = _array(said.get("dtype", "uint8"), said["shape"], body)
    return (array, said["rate"]) if "rate" in said else array


def _array(dtype: Any, shape: Any, body: memoryview) -> NDArray[Any]:
    import numpy as np

    try:
        kind = np.dtype(dtype) if isinstance(dtype, str) and dtype.isalnum() else None
        if kind is None or kind.kind not in "biufc":
            raise DecodeError(f"an array of {dtype!r}")
        lengths = [int(length) for length in shape]
        if min(lengths, default=0) < 0 or math.prod(lengths) * kind.itemsize != len(body):
            raise DecodeError(f"an array of the shape {lengths} in {len(body)} bytes")
        return np.frombuffer(body, kind).reshape(lengths)
    except (ValueError, TypeError, OverflowError) as error:
        raise DecodeError(f"not an array: {error}") from error


# ------------------------------------------------------------------------------------ questions


def question(args: list[Any], kwargs: dict[str, Any]) -> bytes:
    """The arguments of a question: JSON as Wrapyfi has it, or a frame."""
    asked = [args, kwargs]
    if _survives(asked):
        return json.dumps(asked).encode()
    return b"".join(frame.to_bytes(frame.Frame(asked)))


def question_parts(args: list[Any], kwargs: dict[str, Any]) -> list[Buffer]:
    """The same in parts."""
    asked = [args, kwargs]
    if _survives(asked):
        return [json.dumps(asked).encode()]
    return frame.to_parts(frame.Frame(asked))


def asked(data: Buffer) -> Any:
    """Decode the bytes that `question` made, or Wrapyfi."""
    return frame.from_bytes(data).value if frame.is_frame(data) else value_of(data)


def failure(found: Failure) -> bytes:
    """The answer of a server whose method raised an exception."""
    return json.dumps({TAG: [_ERROR, found.type, found.text]}).encode()


def failure_of(data: Buffer) -> Failure | None:
    """The failure that an answer tells of."""
    if bytes(data[:1]) != b"{" or len(data) > WRAPYFI_HEADER:
        return None
    try:
        said = json.loads(bytes(data))
    except (ValueError, RecursionError):
        return None
    content = said.get(TAG) if isinstance(said, dict) and len(said) == 1 else None
    if not isinstance(content, list) or len(content) != 3 or content[0] != _ERROR:
        return None
    return Failure(str(content[1]), str(content[2]))
