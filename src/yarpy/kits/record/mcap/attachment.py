"""Attachments of an MCAP file: files that were given to it, such as definitions of types.

Rules: pure. Where one lies is known from its record, not from what the summary says of it; its
content is read when it is asked for, and its checksum is right then. The layout is that of
https://mcap.dev/spec.
"""

from __future__ import annotations

from struct import Struct
from typing import Final, NamedTuple

from yarpy.kits.record.mcap.checksum import crc32
from yarpy.kits.record.mcap.layout import HEAD, Bytes, Cursor, Damaged
from yarpy.limit import RECORDED_CHUNK, RECORDED_TEXT

MOST: Final = 1000  # of one file
LARGEST: Final = RECORDED_CHUNK // 2  # bytes of one
START: Final = 2 * RECORDED_TEXT + 64  # bytes in which the content begins
_CHECKSUM: Final = Struct("<I")


class Attachment(NamedTuple):
    """A file within a file: its name, its type (`text/xml`), and its record, at that byte with so
    many of them behind its head; `size` is that of its content."""

    name: str
    kind: str
    place: int
    length: int
    size: int


def parse_attachment(view: Bytes, place: int, length: int) -> Attachment:
    """Return what a record at `place` is, of whose `length` bytes `view` has the first. Raises
    Damaged."""
    cursor = Cursor(view, place + HEAD.size)
    cursor.data(16)  # when it was written, and made
    name, kind, size = cursor.text(), cursor.text(), cursor.u64()
    if cursor.at + size + _CHECKSUM.size != length:
        raise Damaged(place, f"an attachment of {size} bytes in a record of {length}")
    return Attachment(name, kind, place, length, size)


def content_of(found: Attachment, body: bytes) -> bytes:
    """Return what is in an attachment, whose record is `body`. Raises Damaged if it has changed."""
    content = body[found.length - found.size - _CHECKSUM.size : -_CHECKSUM.size]
    (checksum,) = _CHECKSUM.unpack(body[-_CHECKSUM.size :])
    if checksum and crc32(body[: -_CHECKSUM.size]) != checksum:
        raise Damaged(found.place, f'the attachment "{found.name}" has changed')
    return content
