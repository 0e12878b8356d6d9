"""The bytes of ROS 2 to a message: CDR, by a function for each type that is compiled once.

    00 01 00 00, then fields; a number of n bytes begins at a multiple of n, counted from behind
    these four; a string is uint32 length with the zero behind it, and bytes; a wstring uint32
    count and units of UTF-16, four bytes each; a list uint32 count and elements; a message without
    fields is one byte

Rules: as in `ros/message/reader.py`: every count is checked against the bytes that are there, and
against the limit of elements, before memory is taken. Only DecodeError and Truncated come out.
Arrays of numbers look at the bytes. Where the compiler knows how a position is aligned, padding
costs nothing. Other spellings of CDR are made this one first. (OMG CDR, as rmw uses it: XCDR1
without options. Wide strings are as all rmw agree to have them, with two bytes more for each unit
than OMG says.)
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from struct import error as struct_error
from typing import Any, Final

from yarpy.data.value import Buffer
from yarpy.errors import DecodeError, Truncated
from yarpy.peers.ros.message.message import Message
from yarpy.peers.ros.message.model import Primitive, Struct, Type
from yarpy.peers.ros.message.reader import SMALL, Read, Reader
from yarpy.peers.ros2.message.cdr_plain import HEAD, is_other, plain

_BEGIN: Final = HEAD[:2]
_FEW: Final = 256
_PADDING: Final = 3  # bytes that writers over DDS may leave behind a message


class Alignment:
    """The known alignment of a position: it is `at` beyond a multiple of `known`."""

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
    return _Reader(classes).compiled(struct)


def whole(struct: Struct, read: Read) -> Callable[[Buffer], Any]:
    """`from_ros` of a class: what `read` reads must be all of the bytes."""
    name, few = struct.name, 0 if struct.has_arrays else _FEW

    def from_ros(view: Buffer) -> Any:
        size = len(view) - 4
        if size < 0 or view[:2] != _BEGIN:
            view = _plain(struct, view)
            size = len(view) - 4
        # A copy of a few bytes costs less than a view of each part of them.
        body = view[4:] if size < few and type(view) is bytes else memoryview(view)[4:]
        try:
            found, end = read(body, 0, size, None if size <= SMALL else [])
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


def _plain(struct: Struct, view: Buffer) -> bytes:
    head = bytes(view[:4])
    if len(head) < 4:
        raise Truncated(f"{struct.name}: {len(head)} bytes are no message of ROS 2", 4)
    if not is_other(head):
        raise DecodeError(f"{struct.name}: bytes that begin with {head.hex(' ')} are no plain CDR")
    return plain(struct, view)


class _Reader(Reader):
    def __init__(self, classes: Mapping[Struct, type[Message]]) -> None:
        super().__init__(classes)
        self.code.globals.update(_unended=_unended, _wide=_wide)
        self.alignment = Alignment()

    def text(self, path: str) -> str:
        self.code.line(f"if _e > _p and _b[_e - 1]: _unended({self.code.name(path)})")
        return "_str(_b[_p:_e - 1], 'utf-8', 'surrogateescape')"

    def displaced(self) -> None:
        self.alignment.forget()

    def value(self, kind: Type, target: str, path: str) -> None:
        if not (isinstance(kind, Primitive) and kind.wide):
            super().value(kind, target, path)
            return
        count = self.count()
        self.room(f"_p + 4 * {count}", path)
        self.code.line(f"{target} = _wide(_b[_p:_e], {self.code.name(path)})")
        self.code.line("_p = _e")
        self.alignment.forget(4)

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
        self.align(size)
        super().number(letter, size, target)
        self.alignment.advance(size)

    def struct(self, struct: Struct, target: str, path: str) -> None:
        super().struct(struct, target, path)
        if not struct.fields:
            self.number("B", 1, self.code.variable())

    def array(
        self, element: Primitive, length: int | None, count: str, target: str, path: str
    ) -> None:
        size = element.size
        if length is not None:
            self.align(size)
        elif self.alignment.padding(size) != 0:  # 8 bytes: an empty list is not aligned
            self.code.line(f"if {count}: _p = _p + {size - 1} & -{size}")
        super().array(element, length, count, target, path)
        if length is not None:
            self.alignment.advance(length * size)
        else:
            self.alignment.forget(min(size, 4))


def _wide(view: memoryview, path: str) -> str:
    """A string of UTF-16, each unit of which has four bytes."""
    data = bytes(view)
    if any(data[2::4]) or any(data[3::4]):
        raise DecodeError(f"{path}: a wide string with a unit of more than 16 bits")
    units = bytearray(len(data) // 2)
    units[0::2], units[1::2] = data[0::4], data[1::4]
    return units.decode("utf-16-le", "surrogatepass")


def _unended(path: str) -> None:
    """Refuse a string whose last byte is no zero; some writers leave that out where it is empty."""
    raise DecodeError(f"{path}: a string without its zero at the end")
