"""Messages of Foxglove in protobuf: their bytes, and what describes them to a reader.

Rules: pure. A type is a table of fields, whose numbers are those of Foxglove's own files; a message
is a dictionary. Numbers that are 0 and texts that are empty are left out, as protobuf 3 does. What
is read was perhaps written by a stranger: each length is checked, and wrong ones are a DecodeError.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from struct import Struct
from typing import Any, Final, NamedTuple

from yarpy.errors import DecodeError


class Field(NamedTuple):
    """A field of a message: `type` is of protobuf (`fixed32`), the name of another message, or that
    of an enum of this one (`Level`)."""

    name: str
    number: int
    type: str
    repeated: bool = False


TIMESTAMP: Final = "google.protobuf.Timestamp"

TYPES: Final[Mapping[str, tuple[Field, ...]]] = {
    TIMESTAMP: (Field("seconds", 1, "int64"), Field("nanos", 2, "int32")),
    "foxglove.CompressedImage": (
        Field("timestamp", 1, TIMESTAMP),
        Field("data", 2, "bytes"),
        Field("format", 3, "string"),
        Field("frame_id", 4, "string"),
    ),
    "foxglove.RawImage": (
        Field("timestamp", 1, TIMESTAMP),
        Field("width", 2, "fixed32"),
        Field("height", 3, "fixed32"),
        Field("encoding", 4, "string"),
        Field("step", 5, "fixed32"),
        Field("data", 6, "bytes"),
        Field("frame_id", 7, "string"),
    ),
    "foxglove.Vector3": tuple(Field(name, n, "double") for n, name in enumerate("xyz", 1)),
    "foxglove.Quaternion": tuple(Field(name, n, "double") for n, name in enumerate("xyzw", 1)),
    "foxglove.Pose": (
        Field("position", 1, "foxglove.Vector3"),
        Field("orientation", 2, "foxglove.Quaternion"),
    ),
    "foxglove.PackedElementField": (
        Field("name", 1, "string"),
        Field("offset", 2, "fixed32"),
        Field("type", 3, "NumericType"),
    ),
    "foxglove.PointCloud": (
        Field("timestamp", 1, TIMESTAMP),
        Field("frame_id", 2, "string"),
        Field("pose", 3, "foxglove.Pose"),
        Field("point_stride", 4, "fixed32"),
        Field("fields", 5, "foxglove.PackedElementField", True),
        Field("data", 6, "bytes"),
    ),
    "foxglove.LaserScan": (
        Field("timestamp", 1, TIMESTAMP),
        Field("frame_id", 2, "string"),
        Field("pose", 3, "foxglove.Pose"),
        Field("start_angle", 4, "double"),
        Field("end_angle", 5, "double"),
        Field("ranges", 6, "double", True),
        Field("intensities", 7, "double", True),
    ),
    "foxglove.RawAudio": (
        Field("timestamp", 1, TIMESTAMP),
        Field("data", 2, "bytes"),
        Field("format", 3, "string"),
        Field("sample_rate", 4, "fixed32"),
        Field("number_of_channels", 5, "fixed32"),
    ),
    "foxglove.JointState": (
        Field("name", 1, "string"),
        Field("position", 2, "double"),
        Field("velocity", 3, "double"),
        Field("acceleration", 4, "double"),
        Field("effort", 5, "double"),
    ),
    "foxglove.JointStates": (
        Field("timestamp", 1, TIMESTAMP),
        Field("joints", 2, "foxglove.JointState", True),
    ),
    "foxglove.Log": (
        Field("timestamp", 1, TIMESTAMP),
        Field("level", 2, "Level"),
        Field("message", 3, "string"),
        Field("name", 4, "string"),
        Field("file", 5, "string"),
        Field("line", 6, "fixed32"),
    ),
}
#: The names of what an enum counts, from 0.
ENUMS: Final[Mapping[str, tuple[str, ...]]] = {
    "Level": ("UNKNOWN", "DEBUG", "INFO", "WARNING", "ERROR", "FATAL"),
    "NumericType": (
        "UNKNOWN", "UINT8", "INT8", "UINT16", "INT16", "UINT32", "INT32", "FLOAT32", "FLOAT64",
    ),
}  # fmt: skip
#: numbers of types in descriptors, and how they are written
_CODES: Final = {"double": 1, "int64": 3, "int32": 5, "fixed32": 7, "string": 9, "bytes": 12}
_MESSAGE_CODE: Final = 11
_ENUM_CODE: Final = 14
_VARINT, _EIGHT, _BYTES, _FOUR = 0, 1, 2, 5
_DOUBLE: Final = Struct("<d")
_FIXED: Final = Struct("<I")
_SECOND: Final = 1_000_000_000


def timestamp(time: int) -> dict[str, int]:
    """Return a moment, in nanoseconds since 1970, as a field of type TIMESTAMP."""
    return {"seconds": time // _SECOND, "nanos": time % _SECOND}


def encode(name: str, values: Mapping[str, Any]) -> bytes:
    """Return a message of type `name`."""
    found = []
    for field in TYPES[name]:
        value = values.get(field.name)
        if field.repeated and field.type == "double" and value:
            found.append(sized(field.number, Struct(f"<{len(value)}d").pack(*value)))
            continue
        for one in value or () if field.repeated else (value,):
            if one is not None:
                found.append(_field(field, one))
    return b"".join(found)


def _field(field: Field, value: Any) -> bytes:
    number = field.number
    if field.type in TYPES:
        return sized(number, encode(field.type, value))
    if not field.repeated and not value:
        return b""
    if field.type == "string":
        return sized(number, value.encode("utf-8", "replace"))
    if field.type == "bytes":
        return sized(number, value)
    if field.type == "double":
        return key(number, _EIGHT) + _DOUBLE.pack(value)
    if field.type == "fixed32":
        return key(number, _FOUR) + _FIXED.pack(value)
    return key(number, _VARINT) + varint(value)


def varint(value: int) -> bytes:
    """Return a whole number, seven bits in each byte."""
    value &= (1 << 64) - 1
    found = bytearray()
    while value > 0x7F:
        found.append(value & 0x7F | 0x80)
        value >>= 7
    found.append(value)
    return bytes(found)


def key(number: int, kind: int = _BYTES) -> bytes:
    """Return what stands in front of a field."""
    return varint(number << 3 | kind)


def sized(number: int, data: bytes | memoryview) -> bytes:
    """Return a field of bytes, a text, or a message in another one."""
    return b"".join((key(number, _BYTES), varint(len(data)), data))


def _text(number: int, text: str) -> bytes:
    return sized(number, text.encode())


@cache
def descriptor_set(name: str) -> bytes:
    """Return what describes a type and those in it: a FileDescriptorSet, a file for each type."""
    wanted: list[str] = []

    def collect(one: str) -> None:
        for field in TYPES[one]:
            if field.type in TYPES and field.type not in wanted:
                collect(field.type)
        wanted.append(one)

    collect(name)
    return b"".join(sized(1, _file(one)) for one in wanted)


def _file(name: str) -> bytes:
    package, _, own = name.rpartition(".")
    inner = dict.fromkeys(field.type for field in TYPES[name] if field.type in TYPES)
    dependencies = [_text(3, _path(one)) for one in inner]
    fields = [sized(2, _described(field, name)) for field in TYPES[name]]
    counted = [sized(4, _enum(field.type)) for field in TYPES[name] if field.type in ENUMS]
    described = b"".join((_text(1, own), *fields, *counted))
    head = _text(1, _path(name)), _text(2, package)
    return b"".join((*head, *dependencies, sized(4, described), _text(12, "proto3")))


def _path(name: str) -> str:
    if name == TIMESTAMP:
        return "google/protobuf/timestamp.proto"
    return f"{name.replace('.', '/')}.proto"


def _enum(name: str) -> bytes:
    """Return what describes an enum."""
    values = (
        sized(2, _text(1, word) + key(2, _VARINT) + varint(n)) for n, word in enumerate(ENUMS[name])
    )
    return b"".join((_text(1, name), *values))


def _described(field: Field, owner: str) -> bytes:
    if field.type in TYPES:
        code, named = _MESSAGE_CODE, f".{field.type}"
    elif field.type in ENUMS:
        code, named = _ENUM_CODE, f".{owner}.{field.type}"
    else:
        code, named = _CODES[field.type], ""
    found = _text(1, field.name) + key(3, _VARINT) + varint(field.number)
    found += key(4, _VARINT) + varint(3 if field.repeated else 1)
    found += key(5, _VARINT) + varint(code)
    return found + (_text(6, named) if named else b"")


def fields_of(data: memoryview) -> dict[int, memoryview]:
    """Return the fields of bytes in a message by their numbers, the last of each. Raises
    DecodeError."""
    found: dict[int, memoryview] = {}
    at, end = 0, len(data)
    while at < end:
        tag, at = _number(data, at)
        kind = tag & 7
        if kind == _VARINT:
            _, at = _number(data, at)
        elif kind == _EIGHT:
            at += 8
        elif kind == _FOUR:
            at += 4
        elif kind == _BYTES:
            length, at = _number(data, at)
            if length <= end - at:
                found[tag >> 3] = data[at : at + length]
            at += length
        else:
            raise DecodeError(f"a field of the unknown kind {kind}")
        if at > end:
            raise DecodeError("a field that is longer than its message")
    return found


def _number(data: memoryview, at: int) -> tuple[int, int]:
    """Return a whole number, and where it ends."""
    value = 0
    for place in range(10):
        if at >= len(data):
            raise DecodeError("a message that ends within a number")
        byte = data[at]
        at += 1
        value |= (byte & 0x7F) << (7 * place)
        if byte < 0x80:
            return value, at
    raise DecodeError("a number of more than ten bytes")
