"""The bytes of ROS 2 to a message: CDR, by a function for each type that is compiled once.

    00 01 00 00, then fields; a number of n bytes begins at a multiple of n, counted from behind
    these four; a string is uint32 length with the zero behind it, and bytes; a list uint32 count
    and elements; a message without fields is one byte

Rules: as in `rosmsg/reader.py`: every count is checked against the bytes that are there, and
against the limit of elements, before memory is taken. Only DecodeError and Truncated come out.
Arrays of numbers look at the bytes. Where the compiler knows how a position is aligned, padding
costs nothing. (OMG CDR, as rmw uses it: XCDR1 without options.)
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from struct import error as struct_error
from typing import Any, Final

from yarpy.data.limit import limits
from yarpy.data.value import Buffer
from yarpy.errors import DecodeError, Truncated
from yarpy.idl.rosmsg.code import Code
from yarpy.idl.rosmsg.message import Message, attribute
from yarpy.idl.rosmsg.model import ListOf, Primitive, Struct, Type, smallest
from yarpy.idl.rosmsg.reader import short, take

#: `read(bytes, position, size, room)` gives a message and the position behind it
Read = Callable[[Buffer, int, int, list[int] | None], tuple[Any, int]]

HEAD: Final = b"\0\1\0\0"  # little-endian, plain
_PADDING: Final = 3  # bytes that writers over DDS may leave behind a message
_SMALL: Final = 1 << 16
_INLINE: Final = 100
_MAX_ALIGN: Final = 8


class Alignment:
    """What is known of a position: it is `at` beyond a multiple of `known`."""

    def __init__(self) -> None:
        self.known, self.at = 1, 0

    def forget(self, known: int = 1, at: int = 0) -> None:
        self.known, self.at = known, at % known

    def padding(self, size: int) -> int | None:
        """The bytes up to a multiple of `size`; None: that is not known."""
        return -self.at % size if self.known >= size else None

    def advance(self, by: int) -> None:
        self.at = (self.at + by) % self.known


def reader(struct: Struct, classes: Mapping[Struct, type[Message]]) -> Read:
    """The function that reads a type. `classes` has its own, and those of all structs in it."""
    made = _Reader(classes)
    made.struct(struct, "_o", struct.name)
    made.flush()
    made.code.line("return _o, _p")
    read: Read = made.code.compiled("_read", "_b, _p, _size, _room")
    return read


def whole(name: str, read: Read) -> Callable[[Buffer], Any]:
    """`from_ros` of a class: what `read` reads must be all of the bytes."""

    def from_ros(view: Buffer) -> Any:
        body = memoryview(view)[4:]
        if bytes(view[:2]) != HEAD[:2] or len(view) < 4:
            _refuse(name, bytes(view[:4]))
        size = len(body)
        try:
            found, end = read(body, 0, size, None if size <= _SMALL else [limits().elements])
        except struct_error:
            raise Truncated(
                f"{name}: the message goes on beyond its {size} bytes", size + 5
            ) from None
        if end > size:
            raise Truncated(f"{name}: the message goes on beyond its {size} bytes", end + 4)
        if end + _PADDING < size:
            raise DecodeError(
                f"{name} takes {end} bytes, here are {size}: this is another type, or another "
                "version of it"
            )
        return found

    return from_ros


def _refuse(name: str, head: bytes) -> None:
    if len(head) < 4:
        raise Truncated(f"{name}: {len(head)} bytes are no message of ROS 2", 4)
    if head[:2] == b"\0\0":
        raise DecodeError(f"{name}: a message of a big-endian computer, which is not read here")
    raise DecodeError(f"{name}: bytes that begin with {head.hex(' ')} are no plain CDR")


class _Reader:
    def __init__(self, classes: Mapping[Struct, type[Message]]) -> None:
        self.classes = classes
        self.code = Code()
        self.code.globals.update(
            _str=str, _range=range, _short=short, _take=take, _beyond=_beyond, _text=_text
        )
        self.inline = _INLINE
        self.alignment = Alignment()

    def flush(self) -> None:
        """Unpack the numbers of the run."""
        found = self.code.run()
        if found is not None:
            packing, targets = found
            if targets:  # else it is padding in front of an array
                unpack = self.code.name(packing.unpack_from)
                self.code.line(f"{', '.join(targets)}, = {unpack}(_b, _p)")
            self.code.line(f"_p += {packing.size}")

    def align(self, size: int) -> None:
        """Go on at a multiple of `size`, within the run if that can be."""
        padding = self.alignment.padding(size)
        if padding is None:
            self.flush()
            self.code.line(f"_p = _p + {size - 1} & -{size}")
            self.alignment.forget(size)
        elif padding:
            self.code.number("x" * padding)
            self.alignment.advance(padding)

    def number(self, letter: str, size: int, target: str) -> None:
        self.align(min(size, _MAX_ALIGN))
        self.code.number(letter, target)
        self.alignment.advance(size)

    def struct(self, struct: Struct, target: str, path: str) -> None:
        """Make a message and read its fields; `target` is a variable."""
        cls = self.code.name(self.classes[struct], "C")
        self.code.line(f"{target} = {cls}.__new__({cls})")
        for field in struct.fields:
            self.value(field.type, f"{target}.{attribute(field)}", f"{path}.{field.name}")
        if not struct.fields:
            self.number("B", 1, self.code.variable())

    def value(self, kind: Type, target: str, path: str) -> None:
        if isinstance(kind, Struct):
            if kind.parts > self.inline:
                self.flush()
                read = self.code.name(self.classes[kind]._read)
                self.code.line(f"{target}, _p = {read}(_b, _p, _size, _room)")
                self.alignment.forget()
                return
            self.inline -= kind.parts
            inner = self.code.variable()
            self.struct(kind, inner, path)
            self.code.line(f"{target} = {inner}")
        elif isinstance(kind, ListOf):
            self.list(kind, target, path)
        elif kind.is_number:
            self.number(kind.letters, kind.size, target)
        else:
            self.string(target, path)

    def count(self) -> str:
        """Read a count or a length; gives the variable."""
        found = self.code.variable()
        self.number("I", 4, found)
        self.flush()
        return found

    def string(self, target: str, path: str) -> None:
        length = self.count()
        self.room(f"_p + {length}", path)
        self.code.line(f"{target} = _text(_b[_p:_e], {self.code.name(path)})")
        self.code.line("_p = _e")
        self.alignment.forget()

    def room(self, end: str, path: str) -> None:
        """Check that the bytes up to `end` are there; it is in `_e` then."""
        self.code.line(f"_e = {end}")
        self.code.line("if _e > _size:")
        self.code.line(f" _short({self.code.name(path)}, _e, _size)")

    def list(self, kind: ListOf, target: str, path: str) -> None:
        element = kind.element
        if kind.length is None:
            count = self.count()
            if kind.most is not None:
                self.code.line(f"if {count} > {kind.most}:")
                self.code.line(f" _beyond({self.code.name(path)}, {count}, {kind.most})")
        else:
            count = str(kind.length)
        if isinstance(element, Primitive) and element.is_number:
            self.array(element, kind.length, count, target, path)
            return
        self.flush()
        self.room(f"_p + {count} * {smallest(element)}", path)
        self.code.line("if _room is not None:")
        self.code.line(f" _take(_room, {count}, {self.code.name(path)})")
        items = self.code.variable()
        self.code.line(f"{items} = {target} = []")
        self.code.line(f"for _ in _range({count}):")
        self.code.indent(1)
        if isinstance(element, Struct):
            read = self.code.name(self.classes[element]._read)
            self.code.line(f"_x, _p = {read}(_b, _p, _size, _room)")
        else:
            self.alignment.forget()
            self.string("_x", path)
        self.code.line(f"{items}.append(_x)")
        self.code.indent(-1)
        self.alignment.forget()

    def array(
        self, element: Primitive, length: int | None, count: str, target: str, path: str
    ) -> None:
        """Numbers that numpy sees where they are; bools become proper ones, which takes a copy."""
        import numpy as np

        size = element.size
        if length is not None:
            self.align(size)
            self.flush()
        elif self.alignment.padding(size) != 0:  # 8 bytes: an empty list is not aligned
            self.code.line(f"if {count}: _p = _p + {size - 1} & -{size}")
        self.room(f"_p + {count} * {size}", path)
        look = self.code.name(np.frombuffer)
        is_bool = element.name == "bool"
        dtype = self.code.name(np.dtype("u1" if is_bool else "<" + element.letters))
        self.code.line(f"{target} = {look}(_b, {dtype}, {count}, _p){' != 0' if is_bool else ''}")
        self.code.line("_p = _e")
        if length is not None:
            self.alignment.advance(length * size)
        else:
            self.alignment.forget(min(size, 4))


def _beyond(path: str, count: int, most: int) -> None:
    raise DecodeError(f"{path}: {count} elements, of {most} that the type allows")


def _text(view: memoryview, path: str) -> str:
    """A string, whose last byte is a zero; some writers leave that out where it is empty."""
    if view and view[-1]:
        raise DecodeError(f"{path}: a string without its zero at the end")
    return str(view[:-1], "utf-8", "surrogateescape")
