"""Sniffing: a `.msg` file for what a YARP port already sends, so that ROS can read it unchanged.

A Bottle's bytes are a message of ROS as they are: tags are int32, counts stand before lists and
strings. The file declares those tags as fields; its messages are the untouched bytes of the port.

Rules: the fields are named after their place: `v` is the message, `v2` its third element, `v2_0`
the first in that. Lists of equal numbers become arrays of any length; in other lists the number and
kinds of the elements are part of the type. Text of the sample is in comments alone, on one line.
"""

from __future__ import annotations

import json
from struct import Struct as Packing
from struct import error as struct_error
from typing import Any, Final

from yarpy.data import codec
from yarpy.data.value import (
    BLOB,
    DICT,
    FIXED,
    FLOAT32,
    FLOAT64,
    INT8,
    INT16,
    INT32,
    INT64,
    LIST,
    MAX_DEPTH,
    STRING,
    UNIT_MASK,
    VOCAB32,
    Vocab,
)
from yarpy.errors import DecodeError
from yarpy.limit import ROS_SNIFF_LINES

_I32: Final = Packing("<i")
_SHOWN: Final = 50  # arrays with fewer numbers are listed in a comment

_TYPES: Final = {
    INT8: "int8",
    INT16: "int16",
    INT32: "int32",
    INT64: "int64",
    VOCAB32: "int32",
    FLOAT32: "float32",
    FLOAT64: "float64",
    STRING: "string",
    BLOB: "int8[]",
}
_TAGS: Final = {
    INT8: "BOTTLE_TAG_INT8",
    INT16: "BOTTLE_TAG_INT16",
    INT32: "BOTTLE_TAG_INT32",
    INT64: "BOTTLE_TAG_INT64",
    VOCAB32: "BOTTLE_TAG_VOCAB32",
    FLOAT32: "BOTTLE_TAG_FLOAT32",
    FLOAT64: "BOTTLE_TAG_FLOAT64",
    STRING: "BOTTLE_TAG_STRING",
    BLOB: "BOTTLE_TAG_BLOB",
}


def sniff(*samples: Any) -> str:
    """The text of a `.msg` file for these messages: values, or the bytes that a port sent.

    DecodeError if they are no Bottles, or if one of them is of another structure than the first.
    """
    if not samples:
        raise ValueError("sniffing takes a message at least")
    found = [_Sniffer(_bytes(sample)).lines() for sample in samples]
    first = [_declaration(line) for line in found[0]]
    for number, lines in enumerate(found[1:], 2):
        other = [_declaration(line) for line in lines]
        if other != first:
            mine, theirs = next(
                (pair for pair in zip(first, other, strict=False) if pair[0] != pair[1]),
                (first[len(other) :][:1] or "nothing", other[len(first) :][:1] or "nothing"),
            )
            raise DecodeError(
                f"message {number} is of another structure than the first: {theirs} instead of "
                f"{mine}; one type of ROS cannot be both"
            )
    return "".join(f"{line}\n" for line in found[0])


def _bytes(sample: Any) -> bytes:
    if isinstance(sample, (bytes, bytearray, memoryview)):
        return bytes(sample)
    return b"".join(codec.encode(sample))


def _declaration(line: str) -> str:
    """A line without what may differ between messages of one type; tags and counts may not."""
    declared, _, remark = line.partition(" # ")
    fixed = declared.endswith(("_tag", "_len"))
    return f"{declared} # {remark}" if fixed else declared


class _Sniffer:
    """Walks through the bytes of a message and declares what it passes."""

    def __init__(self, data: bytes) -> None:
        self.data = data
        self.at = 0
        self.found: list[str] = []

    def lines(self) -> list[str]:
        try:
            self.tagged("v", 0)
        except struct_error:
            raise DecodeError("a message that ends within an element cannot be sniffed") from None
        if self.at != len(self.data):
            raise DecodeError("this message is no Bottle, and only those are messages of ROS too")
        return self.found

    def add(self, line: str, remark: str = "") -> None:
        if len(self.found) >= ROS_SNIFF_LINES:
            raise DecodeError(
                f"a message of more than {ROS_SNIFF_LINES} different elements is no type of ROS"
            )
        self.found.append(f"{line} # {remark}" if remark else line)

    def number(self) -> int:
        found: int = _I32.unpack_from(self.data, self.at)[0]
        self.at += 4
        return found

    def skip(self, size: int) -> bytes:
        if size < 0 or self.at + size > len(self.data):
            raise DecodeError("a length in this message is beyond its end: it is no Bottle")
        self.at += size
        return self.data[self.at - size : self.at]

    def tagged(self, name: str, depth: int) -> None:
        """A tag, and what follows it."""
        tag = self.number()
        if tag & LIST and tag & DICT:
            self.add(f"int32 {name}_tag", f"set to {tag} (BOTTLE_TAG_DICT)")
            self.tagged(f"{name}_list", depth)
            return
        if tag & LIST:
            self.add(f"int32 {name}_tag", f"set to {tag} (BOTTLE_TAG_LIST+code)")
        else:
            self.add(f"int32 {name}_tag", f"set to {tag} ({_TAGS.get(tag, 'unknown')})")
        self.value(tag, name, depth)

    def value(self, tag: int, name: str, depth: int) -> None:
        if tag & LIST and tag < LIST + DICT:
            self.list(tag & UNIT_MASK, name, depth)
            return
        kind = _TYPES.get(tag)
        if kind is None:
            raise DecodeError(f"the tag {tag} of {name} is none of a Bottle")
        if tag == STRING:
            text = self.skip(self.number()).decode("utf-8", "replace")
            self.add(f"{kind} {name}", _quoted(text))
        elif tag == BLOB:
            self.add(f"{kind} {name}", f"{len(self.skip(self.number()))} bytes")
        else:
            letter, size = FIXED[tag]
            number = Packing("<" + letter).unpack(self.skip(size))[0]
            shown = _quoted(Vocab.from_code(number)) if tag == VOCAB32 else str(number)
            self.add(f"{kind} {name}", shown)

    def list(self, unit: int, name: str, depth: int) -> None:
        if depth == MAX_DEPTH:
            raise DecodeError(f"lists nested more than {MAX_DEPTH} deep")
        count = self.number()
        if count < 0:
            raise DecodeError(f"a list of {count} elements: this is no Bottle")
        if unit in FIXED:
            letter, size = FIXED[unit]
            numbers = self.skip(count * size)
            remark = f"suggested length: {count}"
            if 0 < count < _SHOWN:
                values = Packing(f"<{count}{letter}").unpack(numbers)
                remark += f" ({' '.join(map(str, values))})"
            self.add(f"{_TYPES[unit]}[] {name}", remark)
        elif unit == STRING:
            for _ in range(count):
                self.skip(self.number())
            self.add(f"string[] {name}", f"suggested length: {count}")
        else:
            self.add(f"int32 {name}_len", f"set to {count}")
            separator = "_" if depth else ""
            for index in range(count):
                inner = f"{name}{separator}{index}"
                if unit:
                    self.value(unit, inner, depth + 1)
                else:
                    self.tagged(inner, depth + 1)


def _quoted(text: str) -> str:
    """A text of the sample for a comment: on one line, and short."""
    return json.dumps(text if len(text) <= 40 else text[:40] + "...")
