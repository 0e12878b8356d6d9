"""Forms: how a message is written so that other programs see it, and how YARP's bytes come back.

    protobuf   fields of Foxglove's type, [a field whose bytes are those of the message,] REST
    cdr        the head of a list, its numbers, rest

Rules: pure. Pixels, points, samples and numbers that are the same bytes for YARP are not copied and
not kept twice: `body`. What else YARP sends is the `rest`, which comes in front of them when the
message is put together again; others skip it, as a field that they do not know, or as what follows
a message. An envelope that is kept as text stands at the end of the rest, its length behind it.
"""

from __future__ import annotations

from struct import Struct
from typing import Final, NamedTuple, TypeAlias

from yarpy.errors import DecodeError
from yarpy.kits.record.form.protobuf import fields_of, key, varint

Bytes: TypeAlias = bytes | bytearray | memoryview

REST: Final = 1000  # the number of the field
FORM: Final = "yarp.form"  # metadata of a channel: how its messages are put together
PLAIN: Final = ""  # they are YARP's bytes
CDR_HEAD: Final = Struct("<BBHIII4x")  # little endian; no dimensions, no offset, count of doubles
_LENGTH: Final = Struct("<I")
_DOUBLE: Final = 8


class Form(NamedTuple):
    """A way in which messages are written: `name` is kept with the channel.

    `protobuf` has all of YARP's bytes in the rest, `protobuf 6` also those of field 6; `cdr` all in
    the rest, `cdr body` also the numbers.
    """

    name: str
    encoding: str
    schema: str
    schema_encoding: str
    description: bytes


class Converted(NamedTuple):
    """A message: `front`, then `body` and `rest` of YARP's bytes."""

    form: Form
    front: bytes
    body: Bytes
    rest: Bytes

    def parts(self, envelope: bytes | None) -> tuple[Bytes, ...]:
        """Return what is written. envelope: None if it is kept as numbers."""
        tail = () if envelope is None else (envelope, _LENGTH.pack(len(envelope)))
        if self.form.encoding != "protobuf":
            return (self.front, self.body, self.rest, *tail)
        size = len(self.rest) + sum(map(len, tail))
        return (self.front, self.body, key(REST) + varint(size), self.rest, *tail)


def restored(name: str, data: memoryview, text: bool) -> tuple[tuple[memoryview, ...], str]:
    """Return the parts of a message of YARP, and its envelope if that was kept as `text`. name:
    that of its form. Raises DecodeError."""
    if name.startswith("cdr"):
        body, rest = _of_cdr(data)
        body = body if name == "cdr body" else memoryview(b"")
    else:
        word, _, number = name.partition(" ")
        if word != "protobuf" or not (number.isdigit() or not number) or len(number) > 4:
            raise DecodeError(f"the unknown form {name[:40]!r}")
        fields = fields_of(data)
        if REST not in fields:
            raise DecodeError("a message without the bytes of YARP")
        rest = fields[REST]
        body = fields.get(int(number), memoryview(b"")) if number else memoryview(b"")
    envelope = ""
    if text:
        end = len(rest) - _LENGTH.size
        if end < 0:
            raise DecodeError("a message that ends within its envelope")
        start = end - _LENGTH.unpack_from(rest, end)[0]
        if start < 0:
            raise DecodeError("an envelope that is longer than its message")
        envelope, rest = str(rest[start:end], "utf-8", "replace"), rest[:start]
    return ((rest, body) if body else (rest,)), envelope


def _of_cdr(data: memoryview) -> tuple[memoryview, memoryview]:
    """Return the numbers, and what follows them."""
    if len(data) < CDR_HEAD.size:
        raise DecodeError("a list of numbers that ends in its head")
    end = CDR_HEAD.size + _DOUBLE * CDR_HEAD.unpack_from(data)[5]
    if end > len(data):
        raise DecodeError("a list of numbers that is cut off")
    return data[CDR_HEAD.size : end], data[end:]
