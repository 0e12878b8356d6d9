"""Other spellings of CDR to the plain, little-endian one, which alone `cdr_reader` reads: those of
big-endian computers, and of XCDR2, which programs that speak DDS without ROS use.

    plain(struct, data)     the same message, beginning with 00 01

    00 00    as `cdr_reader` has it, big-endian
    00 06    XCDR2, big-endian: numbers of 8 bytes begin at multiples of 4; behind a uint32 with
             their size in bytes: lists and arrays of anything but numbers
    00 08    the same, and each struct behind such a uint32, too: fields may have been added to it
    00 07, 00 09    these two, little-endian

Rules: as in `cdr_reader`. It goes from value to value, which is slow, and rarely needed.
(OMG DDS-XTypes 1.3, 7.4.)
"""

from __future__ import annotations

from struct import Struct as Packing
from typing import Final

from yarpy.data.value import Buffer
from yarpy.errors import DecodeError
from yarpy.peers.ros.message.model import ListOf, Primitive, Struct, Type, smallest
from yarpy.peers.ros.message.reader import beyond, short, take

HEAD: Final = b"\0\1\0\0"
#: by the second byte: the order of bytes, whether it is XCDR2, whether structs tell their size
_SPELLINGS: Final = {
    0: (">", False, False),
    6: (">", True, False),
    7: ("<", True, False),
    8: (">", True, True),
    9: ("<", True, True),
}
_COUNT: Final = Primitive("uint32", "I", 4)
_BYTE: Final = Primitive("uint8", "B", 1)


def is_other(head: bytes) -> bool:
    """Return whether a message that begins so can be made a plain one."""
    return head[:1] == b"\0" and head[1] in _SPELLINGS


def plain(struct: Struct, data: Buffer) -> bytes:
    """Return the same message in plain CDR. Raises DecodeError, Truncated."""
    return _Walk(memoryview(data)[4:], *_SPELLINGS[data[1]]).whole(struct)


class _Walk:
    def __init__(self, view: Buffer, order: str, version_2: bool, sized: bool) -> None:
        self._view, self._order, self._sized = view, order, sized
        self._version_2 = version_2
        self._at = 0
        self._made = bytearray()
        self._room: list[int] = []

    def whole(self, struct: Struct) -> bytes:
        self._struct(struct, struct.name)
        # What is behind it is kept: whether it may be there `cdr_reader` knows.
        return HEAD + bytes(self._made) + bytes(self._view[self._at :])

    def _struct(self, struct: Struct, path: str) -> None:
        end = self._size(path) if self._sized else None
        for field in struct.fields:
            self._value(field.type, f"{path}.{field.name}")
        if not struct.fields:
            self._numbers(_BYTE, 1, path)
        if end is not None:
            if end < self._at:
                raise DecodeError(f"{path} is longer than it says")
            self._at = end  # what its type did not have when ours was written

    def _value(self, kind: Type, path: str) -> None:
        if isinstance(kind, Struct):
            self._struct(kind, path)
        elif isinstance(kind, ListOf):
            self._list(kind, path)
        elif kind.is_number:
            self._numbers(kind, 1, path)
        elif not kind.wide:
            self._bytes(self._count(path), path)
        elif self._version_2:
            raise DecodeError(f"{path}: a wide string in XCDR2, which is not read here")
        else:
            self._numbers(_COUNT, self._count(path), path)

    def _list(self, kind: ListOf, path: str) -> None:
        element = kind.element
        is_number = isinstance(element, Primitive) and element.is_number
        if self._version_2 and not is_number:
            self._size(path)
        count = self._count(path) if kind.length is None else kind.length
        if kind.most is not None and count > kind.most:
            beyond(path, count, kind.most)
        if isinstance(element, Primitive) and is_number:
            if count:
                self._numbers(element, count, path)
            return
        self._need(count * smallest(element), path)
        take(self._room, count, path)
        for _ in range(count):
            self._value(element, path)

    def _size(self, path: str) -> int:
        """Return where what begins here ends, as the bytes say."""
        self._align(4)
        self._need(4, path)
        size: int = Packing(f"{self._order}I").unpack_from(self._view, self._at)[0]
        self._at += 4
        self._need(size, path)
        return self._at + size

    def _count(self, path: str) -> int:
        self._numbers(_COUNT, 1, path)
        return int.from_bytes(self._made[-4:], "little")

    def _numbers(self, kind: Primitive, count: int, path: str) -> None:
        """Take numbers that stand side by side."""
        size = kind.size
        self._align(min(size, 4) if self._version_2 else size)
        self._made += bytes(-len(self._made) % size)
        begin = len(self._made)
        self._bytes(count * size, path)
        if self._order == ">" and size > 1:
            self._made[begin:] = swapped(self._made[begin:], size)

    def _bytes(self, count: int, path: str) -> None:
        self._need(count, path)
        self._made += self._view[self._at : self._at + count]
        self._at += count

    def _align(self, size: int) -> None:
        self._at += -self._at % size

    def _need(self, count: int, path: str) -> None:
        if self._at + count > len(self._view):
            short(path, self._at + count, len(self._view))


def swapped(data: bytearray, size: int) -> bytearray:
    """Return numbers of so many bytes in the other order of bytes.

    >>> swapped(bytearray(b"abcd"), 2)
    bytearray(b'badc')
    """
    found = bytearray(len(data))
    for place in range(size):
        found[place::size] = data[size - 1 - place :: size]
    return found
