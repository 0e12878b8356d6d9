"""The header with which both sides of a connection of ROS begin: fields `key=value`.

    uint32 length of all, then for each field: uint32 length, key=value

Rules: pure. The first `=` ends the key; values may hold anything (a `message_definition` has many
lines). Fields are written in the order of their keys. Sizes and numbers are limited, and nothing is
allocated for what was only announced.
"""

from __future__ import annotations

from collections.abc import Mapping
from struct import Struct
from typing import Final

from yarpy.errors import RemoteProtocolError
from yarpy.limit import ROS_HEADER, ROS_HEADER_FIELDS
from yarpy.log import readable
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

LENGTH: Final = Struct("<I")
#: so a port of C++ YARP begins to say that it does not know a protocol
REFUSAL: Final = b"* Er"
_TWO: Final = Struct("<II")
_SMALLEST: Final = 2  # bytes of a field: a letter and "="

#: fields by their keys
Header = dict[str, str]


def begins_header(first: bytes) -> bool:
    """Return whether eight bytes can begin a header: two lengths, one within the other."""
    if len(first) < 8:
        return False
    whole, field = _TWO.unpack_from(first)
    return bool(_SMALLEST <= field <= whole - 4 and whole <= ROS_HEADER)


def encode_header(fields: Mapping[str, str]) -> bytes:
    """The bytes of a header."""
    parts = []
    for key in sorted(fields):
        data = f"{key}={fields[key]}".encode("utf-8", "surrogateescape")
        parts.append(LENGTH.pack(len(data)) + data)
    body = b"".join(parts)
    return LENGTH.pack(len(body)) + body


def read_header(stream: ByteStream) -> Steps[Header]:
    """Read a header. Raises RemoteProtocolError."""
    head = bytes((yield from stream.read_exact(4)))
    if head == REFUSAL:
        raise RemoteProtocolError(
            "it is a port of YARP that does not speak this protocol of ROS, a plug-in of C++ YARP: "
            "take another carrier, such as tcp"
        )
    (size,) = LENGTH.unpack(head)
    if size > ROS_HEADER:
        raise RemoteProtocolError(
            f"a header of {size} bytes is announced; the limit is {ROS_HEADER} bytes"
        )
    return parse_header((yield from stream.read_exact(size)))


def parse_header(data: bytes | memoryview) -> Header:
    """The fields of a header, without its length. Raises RemoteProtocolError."""
    fields: Header = {}
    at = 0
    while at < len(data):
        if len(fields) == ROS_HEADER_FIELDS:
            raise RemoteProtocolError(f"a header with more than {ROS_HEADER_FIELDS} fields")
        if at + 4 > len(data):
            raise RemoteProtocolError("a header ends in the middle of a length")
        (size,) = LENGTH.unpack_from(data, at)
        at += 4
        if size > len(data) - at:
            raise RemoteProtocolError(f"a field of {size} bytes goes on beyond its header")
        text = bytes(data[at : at + size]).decode("utf-8", "surrogateescape")
        at += size
        key, equals, value = text.partition("=")
        if not equals or not key:
            raise RemoteProtocolError(f'a field without a key: "{readable(text[:80])}"')
        fields.setdefault(key, value)
    return fields
