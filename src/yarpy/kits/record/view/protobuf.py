"""Messages of Foxglove in protobuf: their bytes, and what describes them to a reader.

Rules: pure. A type is a table of fields, whose numbers are those of Foxglove's own files; a message
is a dictionary. Numbers that are 0 and texts that are empty are left out, as protobuf 3 does.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from struct import Struct
from typing import Any, Final, NamedTuple


class Field(NamedTuple):
    """A field of a message: `type` is of protobuf (`fixed32`) or the name of another message."""

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
}
#: numbers of types in descriptors, and how they are written
_CODES: Final = {"double": 1, "int64": 3, "int32": 5, "fixed32": 7, "string": 9, "bytes": 12}
_MESSAGE_CODE: Final = 11
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
        for one in value or () if field.repeated else (value,):
            if one is not None:
                found.append(_field(field, one))
    return b"".join(found)


def _field(field: Field, value: Any) -> bytes:
    number = field.number
    if field.type in TYPES:
        return _sized(number, encode(field.type, value))
    if not field.repeated and not value:
        return b""
    if field.type == "string":
        return _sized(number, value.encode("utf-8", "replace"))
    if field.type == "bytes":
        return _sized(number, value)
    if field.type == "double":
        return _key(number, _EIGHT) + _DOUBLE.pack(value)
    if field.type == "fixed32":
        return _key(number, _FOUR) + _FIXED.pack(value)
    return _key(number, _VARINT) + _varint(value)


def _varint(value: int) -> bytes:
    value &= (1 << 64) - 1
    found = bytearray()
    while value > 0x7F:
        found.append(value & 0x7F | 0x80)
        value >>= 7
    found.append(value)
    return bytes(found)


def _key(number: int, kind: int) -> bytes:
    return _varint(number << 3 | kind)


def _sized(number: int, data: bytes | memoryview) -> bytes:
    return b"".join((_key(number, _BYTES), _varint(len(data)), data))


def _text(number: int, text: str) -> bytes:
    return _sized(number, text.encode())


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
    return b"".join(_sized(1, _file(one)) for one in wanted)


def _file(name: str) -> bytes:
    package, _, own = name.rpartition(".")
    inner = dict.fromkeys(field.type for field in TYPES[name] if field.type in TYPES)
    dependencies = [_text(3, _path(one)) for one in inner]
    fields = [_sized(2, _described(field)) for field in TYPES[name]]
    described = b"".join((_text(1, own), *fields))
    head = _text(1, _path(name)), _text(2, package)
    return b"".join((*head, *dependencies, _sized(4, described), _text(12, "proto3")))


def _path(name: str) -> str:
    if name == TIMESTAMP:
        return "google/protobuf/timestamp.proto"
    return f"{name.replace('.', '/')}.proto"


def _described(field: Field) -> bytes:
    inner = field.type in TYPES
    code = _MESSAGE_CODE if inner else _CODES[field.type]
    found = _text(1, field.name) + _key(3, _VARINT) + _varint(field.number)
    found += _key(4, _VARINT) + _varint(3 if field.repeated else 1)
    found += _key(5, _VARINT) + _varint(code)
    return found + (_text(6, f".{field.type}") if inner else b"")
