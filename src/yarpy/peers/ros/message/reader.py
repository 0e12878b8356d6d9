"""The bytes of ROS to a message: a function for each type, written and compiled once.

    little-endian, packed; a string is uint32 length and bytes, a list uint32 count and elements, an
    array of fixed length its elements alone; messages in messages follow in place

Rules: numbers that stand side by side are unpacked together, messages in a message are read in the
same function. Every count is checked against the bytes that are there, and against the limit of
elements, before memory is taken. Only DecodeError and Truncated come out.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from struct import error as struct_error
from struct import unpack_from
from typing import Any, Final

from yarpy.data.generated import Code
from yarpy.data.value import Buffer
from yarpy.errors import DecodeError, Truncated
from yarpy.limit import limits
from yarpy.peers.ros.message.message import Duration, Message, Time, attribute
from yarpy.peers.ros.message.model import ListOf, Primitive, Struct, Type, smallest

#: `read(bytes, position, size, room)` gives a message and the position behind it; `room`: how many
#: more elements there may be, empty at the beginning, or None: as many as there are
Read = Callable[[Buffer, int, int, list[int] | None], tuple[Any, int]]

#: messages up to this size cannot have too many elements; theirs are not counted
SMALL: Final = 1 << 16
#: messages in a message are read in the same function up to so many values of them
_INLINE: Final = 100
_COUNT: Final = 4


def reader(struct: Struct, classes: Mapping[Struct, type[Message]]) -> Read:
    """The function that reads a type. `classes` has its own, and those of all structs in it."""
    return Reader(classes).compiled(struct)


def whole(struct: Struct, read: Read) -> Callable[[Buffer], Any]:
    """`from_ros` of a class: what `read` reads must be all of the bytes."""
    name = struct.name

    def from_ros(view: Buffer) -> Any:
        size = len(view)
        try:
            found, end = read(view, 0, size, None if size <= SMALL else [])
        except struct_error:
            raise Truncated(
                f"{name}: the message goes on beyond its {size} bytes", size + 1
            ) from None
        if end != size:
            raise DecodeError(
                f"{name} takes {end} bytes, here are {size}: this is another type, or another "
                "version of it"
            )
        return found

    return from_ros


class Reader:
    """Writes the function line by line; for bytes in which nothing is aligned. `cdr_reader` says
    where padding goes."""

    def __init__(self, classes: Mapping[Struct, type[Message]]) -> None:
        self.classes = classes
        self.code = Code()
        self.code.globals.update(
            _range=range, _short=short, _take=take, _beyond=beyond, _times=_times, _str=str,
            _tuple=tuple.__new__, _Time=Time, _Duration=Duration,
        )  # fmt: skip
        self.after: list[str] = []
        self.inline = _INLINE

    def compiled(self, struct: Struct) -> Read:
        self.struct(struct, "_o", struct.name)
        self.flush()
        self.code.line("return _o, _p")
        read: Read = self.code.compiled("_read", "_b, _p, _size, _room")
        return read

    def text(self, path: str) -> str:
        """The string in the bytes from `_p` to `_e`."""
        return "_str(_b[_p:_e], 'utf-8', 'surrogateescape')"

    def displaced(self) -> None:
        """Something of unknown size was read."""

    def flush(self) -> None:
        """Unpack the numbers of the run, and make of them what is made of them."""
        found = self.code.run()
        if found is not None:
            packing, targets = found
            if targets:  # else it is padding alone
                unpack = self.code.name(packing.unpack_from)
                self.code.line(f"{', '.join(targets)}, = {unpack}(_b, _p)")
            self.code.line(f"_p += {packing.size}")
        for line in self.after:
            self.code.line(line)
        self.after.clear()

    def struct(self, struct: Struct, target: str, path: str) -> None:
        """Make a message and read its fields; `target` is a variable."""
        cls = self.code.name(self.classes[struct], "C")
        self.code.line(f"{target} = {cls}.__new__({cls})")
        for field in struct.fields:
            self.value(field.type, f"{target}.{attribute(field)}", f"{path}.{field.name}")

    def value(self, kind: Type, target: str, path: str) -> None:
        if isinstance(kind, Struct):
            if kind.parts > self.inline:
                self.flush()
                read = self.code.name(self.classes[kind]._read)
                self.code.line(f"{target}, _p = {read}(_b, _p, _size, _room)")
                self.displaced()
                return
            self.inline -= kind.parts
            inner = self.code.variable()
            self.struct(kind, inner, path)
            self.code.line(f"{target} = {inner}")
        elif isinstance(kind, ListOf):
            self.list(kind, target, path)
        elif kind.is_number:
            self.number(kind.letters, kind.size, target)
        elif kind.name == "string":
            self.string(target, path)
        else:
            self.time(kind, target)

    def number(self, letter: str, size: int, target: str) -> None:
        self.code.number(letter, target)

    def string(self, target: str, path: str) -> None:
        length = self.count()
        self.room(f"_p + {length}", path)
        self.code.line(f"{target} = {self.text(path)}")
        self.code.line("_p = _e")
        self.displaced()

    def time(self, kind: Primitive, target: str) -> None:
        """Add code that reads a time or duration, which ROS 2 has a struct for."""
        seconds, nanoseconds = self.code.variable(), self.code.variable()
        self.code.number(kind.letters, seconds, nanoseconds)
        cls = "_Time" if kind.name == "time" else "_Duration"
        self.after.append(f"{target} = _tuple({cls}, ({seconds}, {nanoseconds}))")

    def count(self) -> str:
        """Read a count or a length; gives the variable."""
        found = self.code.variable()
        self.number("I", _COUNT, found)
        self.flush()
        return found

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
        if isinstance(element, Primitive) and element.letters:
            cls = "_Time" if element.name == "time" else "_Duration"
            self.code.line(f"{target} = _times(_b, _p, {count}, {cls}, {element.letters[0]!r})")
            self.code.line("_p = _e")
            return
        items = self.code.variable()
        self.code.line(f"{items} = {target} = []")
        self.code.line(f"_add = {items}.append")
        self.code.line(f"for _ in _range({count}):")
        self.code.indent(1)
        if isinstance(element, Struct):
            read = self.code.name(self.classes[element]._read)
            self.code.line(f"_x, _p = {read}(_b, _p, _size, _room)")
        else:
            self.displaced()
            self.value(element, "_x", path)
        self.code.line("_add(_x)")
        self.code.indent(-1)
        self.displaced()

    def array(
        self, element: Primitive, length: int | None, count: str, target: str, path: str
    ) -> None:
        """Numbers that numpy sees where they are; bools become proper ones, which takes a copy."""
        import numpy as np

        self.flush()
        self.room(f"_p + {count} * {element.size}", path)
        look = self.code.name(np.frombuffer)
        is_bool = element.name == "bool"
        dtype = self.code.name(np.dtype("u1" if is_bool else "<" + element.letters))
        self.code.line(f"{target} = {look}(_b, {dtype}, {count}, _p){' != 0' if is_bool else ''}")
        self.code.line("_p = _e")


def short(path: str, need: int, size: int) -> None:
    raise Truncated(f"{path} takes bytes up to {need}, the message has {size}", need)


def take(room: list[int], count: int, path: str) -> None:
    if not room:  # the limit is looked up for what it is needed for: for pictures it is not
        room.append(limits().elements)
    room[0] -= count
    if room[0] < 0:
        raise DecodeError(
            f"{path}: more than {limits().elements} strings and messages (YARPY_MAX_ELEMENTS)"
        )


def beyond(path: str, count: int, most: int) -> None:
    raise DecodeError(f"{path}: {count} elements, of {most} that the type allows")


def _times(view: Buffer, at: int, count: int, cls: Callable[..., Any], letter: str) -> list[Any]:
    numbers = iter(unpack_from(f"<{2 * count}{letter}", view, at))
    return [cls(*pair) for pair in zip(numbers, numbers, strict=True)]
