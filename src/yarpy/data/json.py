"""JSON of messages, and messages of JSON: what web pages understand.

    [1, ["a", 2], True]             [1, ["a", 2], "true"]
    x (a 1) (b 2)                   {"type": "x", "a": 1, "b": 2}
    Property, dict                  {"a": 1, "b": 2}
    bytes                           {"type": "blob", "base64": "AQL/"}
    an array of no type of YARP's   {"type": "array", "dtype": "<f2", "shape": [2], "base64": ...}
    complex                         [real, imaginary]
    PointCloud                      {"type": "pointcloud", "kind": "xyz", "width": 1, "height": 1,
                                     "points": [[0.5, 1.0, 2.0]]}

Rules: every message gives valid JSON. Where C++ gives valid JSON this is the same value, so
booleans, which are vocabs, are the strings "true" and "false", and a list of pairs is an object;
but only if its keys are different words (C++ repeats keys or writes numbers as keys).
Numbers that JSON cannot express (nan, infinities) are null. Reading, an object is a list of pairs,
its `type` is the word in front of them, and null is the vocab `null`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias

from yarpy.data.bottle import Bottle
from yarpy.data.json_plain import NOT_PLAIN, plain_json, plain_value
from yarpy.data.python.array import is_array
from yarpy.data.text import plain_text
from yarpy.data.value import MAX_DEPTH, Vocab, fits
from yarpy.errors import DecodeError
from yarpy.limit import check_json

if TYPE_CHECKING:
    from json import JSONDecoder, JSONEncoder

Outer: TypeAlias = Literal["auto", "list", "dict"]

_TYPE: Final = "type"
_SMALL: Final = 1 << 62
_SPACE: Final = " \t\n\r"  # of JSON
_C1 = re.compile(r"[\x80-\x9f]")  # control characters, which a terminal obeys


def to_json(value: object, outer: Outer = "auto", *, pixels: bool = True) -> str:
    """The JSON text of a message or of anything that can be sent as one; TypeError for the rest.

    outer: whether the outermost list becomes an array or an object; `auto`: what it looks like.
    pixels: whether an image comes with its pixels and a cloud with its points, or only with size
    and kind.
    """
    text = plain_json(value) if outer == "auto" else None
    if text is None:
        text = _writer().encode(_plain_top(value, outer, pixels))
    if text.isascii():
        return text
    text = _C1.sub(lambda found: f"\\u{ord(found[0]):04x}", text)
    return text if _encodable(text) else _mended(text)


def from_json(text: str | bytes | bytearray | memoryview) -> Any:
    """The value that a JSON text stands for: a Bottle, a string or a number.

    DecodeError if it is no JSON, or holds what no message can.
    """
    try:
        data = text if isinstance(text, str) else bytes(text).decode("utf-8")
        check_json(data)
        data = data.strip(_SPACE)
        found, end = _reader().raw_decode(data)
        if end != len(data):
            raise DecodeError(f"this is not JSON: there is more behind it, {data[end:][:20]!r}")
    except RecursionError:
        raise DecodeError(f"JSON nested more than {MAX_DEPTH} deep") from None
    except DecodeError:
        raise
    except ValueError as error:
        raise DecodeError(f"this is not JSON: {error}") from None
    value = plain_value(found)
    return _message(found, 0) if value is NOT_PLAIN else value


@cache
def _writer() -> JSONEncoder:
    from json import JSONEncoder

    return JSONEncoder(ensure_ascii=False, allow_nan=False)


@cache
def _reader() -> JSONDecoder:
    from json import JSONDecoder

    return JSONDecoder(parse_constant=_no_constant)


# ---------------------------------------------------------------------------------- to JSON


def _plain_top(value: object, outer: Outer, pixels: bool) -> Any:
    if isinstance(value, (list, tuple)):
        return _list(value, outer, 0)
    if isinstance(value, Mapping) or _is_scalar(value):
        return _plain(value, 0)
    # Vector, Image, Stamp, arrays ...: what a reader of the message would find in it.
    from yarpy.data import codec

    described = None
    if outer == "auto" and not is_array(value):
        described = _described(value, pixels)
    if described is not None:
        return described
    message = b"".join(codec.encode(value))
    try:
        natural = codec.decode(message)
        described = _described(natural, pixels) if outer == "auto" else None
        if described is None and isinstance(natural, (Mapping, complex)):
            return _plain(natural, 0)
        return _list(Bottle.from_bytes(message), outer, 0) if described is None else described
    except DecodeError:
        return _plain(message, 0)  # a user's own format


def _described(value: object, pixels: bool = True) -> Any:
    """Images, matrices, sounds and clouds of points by their parts; None for other kinds."""
    from yarpy.data.sig.image import Image
    from yarpy.data.sig.matrix import Matrix
    from yarpy.data.sig.pointcloud import PointCloud
    from yarpy.data.sig.sound import Sound
    from yarpy.data.sig.vector import Vector

    if isinstance(value, Image):
        facts = {
            _TYPE: "image",
            "width": value.width,
            "height": value.height,
            "pixel": str(value.code),
        }
        return {**facts, "base64": _base64(value.array.tobytes())} if pixels else facts
    if isinstance(value, Matrix):
        return [[_number(item) for item in row] for row in value.array.tolist()]
    if isinstance(value, Vector):
        return [_number(item) for item in value.array.tolist()]
    if isinstance(value, Sound):
        return {
            _TYPE: "sound",
            "frequency": value.frequency,
            "channels": value.array.tolist(),
        }
    if isinstance(value, PointCloud):
        facts = {_TYPE: "pointcloud", "kind": value.kind}
        facts |= {"width": value.width, "height": value.height}
        if not pixels:
            return facts
        points = value.array.reshape(-1).tolist()
        return {**facts, "points": [[_number(number) for number in point] for point in points]}
    if is_array(value):
        facts = {_TYPE: "array", "dtype": value.dtype.str, "shape": [*value.shape]}
        return {**facts, "base64": _base64(value.tobytes())} if pixels else facts
    return None


def _plain(value: object, depth: int) -> Any:
    """The value from which `json` makes the right text."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return value
    if isinstance(value, int):
        return int(value)
    if isinstance(value, float):
        return _number(value)
    if isinstance(value, (bytes, bytearray, memoryview)):
        return {_TYPE: "blob", "base64": _base64(value)}
    if depth > MAX_DEPTH:
        raise DecodeError(f"a message nested more than {MAX_DEPTH} deep")
    if isinstance(value, (list, tuple)):
        return _list(value, "auto", depth)
    if isinstance(value, Mapping):
        return {str(key): _plain(item, depth + 1) for key, item in value.items()}
    if value is None:
        return None
    if isinstance(value, complex):
        return [_number(value.real), _number(value.imag)]
    from yarpy.data import codec

    inner = codec.decode(b"".join(codec.encode(value)))  # numpy numbers, vectors inside lists
    if isinstance(inner, (list, tuple, Mapping)) or _is_scalar(inner):
        return _plain(inner, depth)
    return _described(inner)


def _list(items: Sequence[Any], outer: Outer, depth: int) -> Any:
    if outer == "auto" and items and isinstance(items[0], str):
        if items[0] == "list":
            outer, items = "list", items[1:]
        elif items[0] == "dict":
            outer, items = "dict", items[1:]
    if outer == "dict":
        return _object(items, depth, "")
    if outer == "auto" and _is_object(items):
        return _object(items, depth, _TYPE)
    return [_plain(item, depth + 1) for item in items]


def _is_object(items: Sequence[Any]) -> bool:
    """Return whether these are more than one element, all of them pairs but perhaps the first,
    under different words."""
    if len(items) < 2:
        return False
    keys = set()
    first = 0
    if not isinstance(items[0], (list, tuple)):
        if isinstance(items[0], Mapping):
            return False
        first = 1
        keys.add(_TYPE)
    for item in items[first:]:
        if not isinstance(item, (list, tuple)) or len(item) != 2:
            return False
        key = item[0]
        if not isinstance(key, str) or key in keys:
            return False
        keys.add(str(key))
    return True


def _object(items: Sequence[Any], depth: int, front: str) -> dict[str, Any]:
    """The pairs by their keys; what stands before them under the key `front`, if that is one."""
    found: dict[str, Any] = {}
    for place, item in enumerate(items):
        if isinstance(item, (list, tuple)):
            if item:
                value = _plain(item[1], depth + 2) if len(item) > 1 else None
                found[plain_text(item[0])] = value
        elif place == 0 and front:
            found[front] = _plain(item, depth + 1)
    return found


def _is_scalar(value: object) -> bool:
    return value is None or isinstance(value, (str, int, float, bytes, bytearray, memoryview))


def _number(value: Any) -> Any:
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    return value


def _base64(data: bytes | bytearray | memoryview) -> str:
    from binascii import b2a_base64

    return b2a_base64(data, newline=False).decode("ascii")


def _encodable(text: str) -> bool:
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


def _mended(text: str) -> str:
    """Bytes that are not UTF-8 become the replacement character; JSON cannot hold them."""
    raw = text.encode("utf-8", "surrogatepass")
    try:
        raw = text.encode("utf-8", "surrogateescape")
    except UnicodeEncodeError:
        pass  # half a surrogate pair, written as \\ud800
    return raw.decode("utf-8", "replace")


# ---------------------------------------------------------------------------------- from JSON


def _no_constant(word: str) -> Any:
    raise ValueError(f"{word} is not a JSON number")


def _message(value: Any, depth: int) -> Any:
    if isinstance(value, (bool, float)):
        return value
    if isinstance(value, str):
        return value if value.isascii() or _encodable(value) else _mended(value)
    if value is None:
        return Vocab("null")
    if isinstance(value, int):
        if not (-_SMALL < value < _SMALL or fits(value, 64)):
            raise DecodeError(f"a number of {value.bit_length()} bits; a message has room for 64")
        return value
    if depth > MAX_DEPTH:
        raise DecodeError(f"JSON nested more than {MAX_DEPTH} deep")
    if isinstance(value, list):
        return Bottle([_message(item, depth + 1) for item in value])
    return _pairs(value, depth)


def _pairs(value: dict[str, Any], depth: int) -> Any:
    kind = value.get(_TYPE)
    if kind == "blob" and value.keys() == {_TYPE, "base64"} and isinstance(value["base64"], str):
        from binascii import Error, a2b_base64

        try:
            return a2b_base64(value["base64"], strict_mode=True)
        except (Error, ValueError) as error:
            raise DecodeError(f"a blob that is not base64: {error}") from None
    front = isinstance(kind, (str, int, float))
    items = Bottle([_message(kind, depth + 1)] if front else [])
    for key, item in value.items():
        if not (front and key == _TYPE):
            items.append(Bottle([_message(key, depth + 1), _message(item, depth + 2)]))
    return items
