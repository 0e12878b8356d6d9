"""Cursor: a place in a message of Thrift on YARP's wire, and what is read there whatever its kind.

Rules: as a Bottle's. Counts are checked against the bytes that are there; only DecodeError and
Truncated come out, which name the field. Of a message of YARP 4.0, which has other tags for floats
(`yarpy.data.yarp4`), the tags are those of 3.x.
"""

from __future__ import annotations

from struct import Struct as Packing
from struct import error as struct_error
from typing import Any, Final

from yarpy.data.value import (
    BLOB,
    FIXED,
    FLOAT32,
    FLOAT64,
    GROUP_MASK,
    INT8,
    INT16,
    INT32,
    INT64,
    LIST,
    STRING,
    UNIT_MASK,
    VOCAB32,
    Buffer,
    Vocab,
)
from yarpy.data.yarp4 import FLOAT32_4, FLOAT64_4
from yarpy.errors import DecodeError, Truncated
from yarpy.limit import THRIFT_LISTS, limits

_I32: Final = Packing("<i").unpack_from
_PAIR: Final = Packing("<ii").unpack_from
_PACK: Final = Packing("<i").pack
_PACK_PAIR: Final = Packing("<ii").pack
_UNPACK: Final = {tag: Packing("<" + letter).unpack_from for tag, (letter, _) in FIXED.items()}
#: tags of YARP 4.0 to those of 3.x; one that it has no more to one that nobody has
_NAMES: Final = {FLOAT64_4: FLOAT64, FLOAT32_4: FLOAT32, FLOAT32: 0xFF}
_WHAT: Final = {
    INT32: "an int32", STRING: "a string", VOCAB32: "a vocab", FLOAT64: "a float64",
    BLOB: "a blob", INT64: "an int64", INT8: "an int8", INT16: "an int16", FLOAT32: "a float32",
}  # fmt: skip


class Cursor:
    """A place in a message. `tagged_sets`: sets are as C++ writes them. `yarp4`: it comes from
    YARP 4.0."""

    __slots__ = ("at", "data", "depth", "end", "room", "tagged_sets", "yarp4")

    def __init__(
        self, data: Buffer, at: int = 0, tagged_sets: bool = False, yarp4: bool = False
    ) -> None:
        self.data = data
        self.at = at
        self.end = len(data)
        self.room = limits().elements
        self.depth = 0
        self.tagged_sets = tagged_sets
        self.yarp4 = yarp4

    def tag(self, path: str) -> int:
        """The tag of an element, or the header of a list, as YARP 3.x has it."""
        found = self.number(path)
        if not self.yarp4:
            return found
        kind = found & UNIT_MASK
        return found - kind + _NAMES.get(kind, kind)

    def number(self, path: str) -> int:
        if self.at + 4 > self.end:
            raise Truncated(f"{path} is missing", self.at + 4)
        found: int = _I32(self.data, self.at)[0]
        self.at += 4
        return found

    def count(self, path: str, least: int) -> int:
        """Return how many elements follow, of at least `least` bytes each."""
        count = self.number(path)
        if count < 0 or self.at + count * least > self.end:
            raise Truncated(
                f"{path}: {count} elements are announced, there are {self.end - self.at} bytes"
            )
        self.room -= count
        if self.room < 0:
            raise DecodeError(
                f"{path}: more than {limits().elements} elements (YARPY_MAX_ELEMENTS)"
            )
        return count

    def take(self, count: int, path: str) -> Buffer:
        start, self.at = self.at, self.at + count
        if count < 0 or self.at > self.end:
            raise Truncated(f"{path} takes {count} bytes, there are {self.end - start}")
        return self.data[start : self.at]

    def enter(self, path: str) -> None:
        self.depth += 1
        if self.depth > THRIFT_LISTS:
            raise DecodeError(f"{path}: more than {THRIFT_LISTS} lists within each other")


def number_of(tag: int, cursor: Cursor, path: str) -> Any:
    """Return the number behind a tag of fixed size. Truncated."""
    size = FIXED[tag][1]
    try:
        found = _UNPACK[tag](cursor.data, cursor.at)[0]
    except struct_error:
        raise Truncated(f"{path} is cut off", cursor.at + size) from None
    cursor.at += size
    return found


def bytes_of(cursor: Cursor, path: str) -> Buffer:
    """Return the bytes of a string or a blob. Truncated."""
    return cursor.take(cursor.number(path), path)


def reads_list(cursor: Cursor, path: str) -> bool:
    """Return whether a list begins at the cursor."""
    tag = cursor.tag(path)
    cursor.at -= 4
    return bool(tag & GROUP_MASK)


def skip(cursor: Cursor, path: str, code: int | None = None) -> None:
    """Go behind one element of a Bottle, whatever it is."""
    waiting: list[tuple[int, int]] = [(1, code or 0)]  # how many, and their tag unless it is theirs
    while waiting:
        count, fixed = waiting.pop()
        if not count:
            continue
        if fixed in FIXED:
            cursor.take(count * FIXED[fixed][1], path)
            continue
        waiting.append((count - 1, fixed))
        tag = fixed or cursor.tag(path)
        if tag in FIXED:
            cursor.take(FIXED[tag][1], path)
        elif tag in (STRING, BLOB):
            bytes_of(cursor, path)
        elif tag & GROUP_MASK:
            inner = tag & UNIT_MASK
            least = FIXED[inner][1] if inner in FIXED else 4
            waiting.append((cursor.count(path, least), inner))
            if len(waiting) > 2 * THRIFT_LISTS:
                raise DecodeError(f"{path}: more than {THRIFT_LISTS} lists within each other")
        else:
            raise DecodeError(f"{path}: {tag} is no tag of a Bottle")


def other_kind(wanted: str, tag: int, cursor: Cursor, path: str) -> DecodeError:
    """The error for a value of another kind."""
    if tag & GROUP_MASK:
        return DecodeError(f"{path}: expected {wanted}, got a list")
    if tag == STRING:
        try:
            text = str(bytes_of(cursor, path), "utf-8", "replace")
        except DecodeError as error:
            return error
        return DecodeError(f"{path}: expected {wanted}, got {text[:40]!r}")
    if tag in FIXED:
        try:
            number = number_of(tag, cursor, path)
        except DecodeError as error:
            return error
        value = f"[{Vocab.from_code(number)}]" if tag == VOCAB32 else repr(number)
        return DecodeError(f"{path}: expected {wanted}, got {value}")
    return DecodeError(f"{path}: expected {wanted}, got {_WHAT.get(tag, f'the tag {tag}')}")


def pair(data: Buffer, at: int) -> tuple[int, int]:
    """Two integers. Truncated if they are not there."""
    try:
        found: tuple[int, int] = _PAIR(data, at)
    except struct_error:
        raise Truncated("the message ends in the middle", at + 8) from None
    return found


def spread(view: Buffer) -> Buffer:
    """A list whose elements all have their own tags; the bytes themselves if they have.
    DecodeError if it is none."""
    code, count = pair(view, 0)
    if code == LIST:
        return view
    tag = code & UNIT_MASK
    if not code & GROUP_MASK or (tag and tag not in _WHAT):
        raise DecodeError(f"a message begins with 256 for a list, not with {code}")
    cursor = Cursor(bytes(view), 4)
    count = cursor.count("the message", FIXED[tag][1] if tag in FIXED else 4)
    pieces = [_PACK_PAIR(LIST, count)]
    head = _PACK(tag)
    for _ in range(count):
        start = cursor.at
        skip(cursor, "the message", tag)
        pieces += (head, bytes(cursor.data[start : cursor.at]))
    pieces.append(bytes(cursor.data[cursor.at :]))
    return b"".join(pieces)
