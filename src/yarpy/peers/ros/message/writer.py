"""A message to the bytes of ROS: a function for each type, written and compiled once.

Rules: as in `reader`. Arrays of at least 4096 bytes become blocks of their own and are not copied,
whatever type of array, bytes or list the field holds; the rest is joined. Whatever does not fit is
looked for only then, by `fault`, which names the field.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from struct import error as struct_error
from typing import TYPE_CHECKING, Any, Final

from yarpy.data.generated import Code
from yarpy.data.value import BIG, Blocks
from yarpy.peers.ros.message.fault import array_of, fault, wrong_length
from yarpy.peers.ros.message.message import TIMES, Duration, Message, Time, attribute, moment
from yarpy.peers.ros.message.model import ListOf, Primitive, Struct, Type

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: `write(message, add, position)` adds the pieces of a message; gives the position behind them,
#: which is kept where fields are aligned
Write = Callable[[Any, Callable[[bytes | memoryview], None], int], int]

_INLINE: Final = 100
_COUNT: Final = 4
_MISFITS: Final = (struct_error, TypeError, AttributeError, OverflowError, ValueError)


def writer(struct: Struct, classes: Mapping[Struct, type[Message]]) -> Write:
    """The function that writes a type; `classes` has those of the structs in it."""
    return Writer(classes).compiled(struct)


def whole(struct: Struct, write: Write, head: bytes = b"") -> Callable[[Any], Blocks]:
    """`to_ros` of a class. `head`: stands before each message."""
    before = [head] if head else []

    def in_one_piece(self: Any) -> Blocks:
        pieces: list[bytes | memoryview] = [*before]
        try:
            write(self, pieces.append, 0)
        except _MISFITS as error:
            raise fault(struct, self) or error from None
        return (b"".join(pieces),)

    def to_ros(self: Any) -> Blocks:
        pieces: list[bytes | memoryview] = [*before]
        try:
            write(self, pieces.append, 0)
        except _MISFITS as error:
            raise fault(struct, self) or error from None
        kinds = [*map(type, pieces)]
        arrays = kinds.count(memoryview)
        if not arrays:
            return (b"".join(pieces),)
        if arrays == 1 and kinds[-1] is memoryview and len(kinds) > 1:  # as of a picture
            data = pieces.pop()
            return b"".join(pieces), data
        return joined(pieces)

    return to_ros if struct.has_arrays else in_one_piece


def joined(pieces: list[bytes | memoryview]) -> Blocks:
    """Neighbours joined, arrays left alone."""
    blocks: list[bytes | memoryview] = []
    small: list[bytes | memoryview] = []
    for piece in (*pieces, memoryview(b"")):
        if type(piece) is memoryview:
            blocks += [b"".join(small), piece]
            small.clear()
        else:
            small.append(piece)
    return tuple(filter(None, blocks))


class Writer:
    """Writes the function line by line; for bytes in which nothing is aligned. `cdr_writer` says
    where padding goes."""

    def __init__(self, classes: Mapping[Struct, type[Message]]) -> None:
        self.classes = classes
        self.code = Code()
        self.code.globals.update(_len=len, _wrong=wrong_length, _beyond=_beyond, _block=_block)
        self.inline = _INLINE

    def compiled(self, struct: Struct) -> Write:
        self.struct(struct, "_o", struct.name)
        self.flush()
        self.code.line("return _p")
        write: Write = self.code.compiled("_write", "_o, _add, _p")
        return write

    def moved(self, size: str) -> None:
        """Note that so many bytes were written."""

    def displaced(self) -> None:
        """Something of unknown size was written."""

    def text(self, source: str) -> str:
        """The bytes of a string."""
        return f"{source}.encode('utf-8', 'surrogateescape')"

    def flush(self) -> None:
        found = self.code.run()
        if found is not None:
            packing, terms = found
            self.code.line(f"_add({self.code.name(packing.pack)}({', '.join(terms)}))")
            self.moved(str(packing.size))

    def struct(self, struct: Struct, source: str, path: str) -> None:
        for field in struct.fields:
            self.value(field.type, f"{source}.{attribute(field)}", f"{path}.{field.name}")

    def value(self, kind: Type, source: str, path: str) -> None:
        if isinstance(kind, Struct):
            source = self.timed(kind, source)
            if kind.parts > self.inline:
                self.flush()
                self.inner(kind, source)
                self.displaced()
                return
            self.inline -= kind.parts
            inner = self.code.variable()
            self.code.line(f"{inner} = {source}")
            self.struct(kind, inner, path)
        elif isinstance(kind, ListOf):
            self.list(kind, source, path)
        elif kind.is_number:
            self.number(kind.letters, kind.size, source)
        elif kind.name == "string":
            self.string(source)
        else:
            self.time(kind, source)

    def inner(self, kind: Struct, source: str) -> None:
        """A message in a message, by its own function."""
        write = self.code.name(self.classes[kind]._write)
        self.code.line(f"_p = {write}({source}, _add, _p)")

    def number(self, letter: str, size: int, source: str) -> None:
        self.code.number(letter, source)

    def string(self, source: str) -> None:
        text = self.code.variable()
        self.code.line(f"{text} = {self.text(source)}")
        self.number("I", _COUNT, f"_len({text})")
        self.flush()
        self.code.line(f"_add({text})")
        self.moved(f"_len({text})")
        self.displaced()

    def time(self, kind: Primitive, source: str) -> None:
        """Add code that writes a time or duration, which ROS 2 has a struct for."""
        time = self.moment(Time if kind.name == "time" else Duration, source)
        self.code.number(kind.letters, f"{time}.secs", f"{time}.nsecs")

    def timed(self, kind: Struct, source: str) -> str:
        """A message in a message; where it is a time, a number of seconds is one."""
        return self.moment(self.classes[kind], source) if kind.name in TIMES else source

    def moment(self, cls: type[Any], source: str) -> str:
        """Add code that makes a time of this class of a number of seconds."""
        time, kind, made = self.code.variable(), self.code.name(cls), self.code.name(moment)
        self.code.line(f"{time} = {source}")
        self.code.line(f"if type({time}) is not {kind}: {time} = {made}({kind}, {time})")
        return time

    def list(self, kind: ListOf, source: str, path: str) -> None:
        items = self.code.variable()
        self.code.line(f"{items} = {source}")
        element = kind.element
        if isinstance(element, Primitive) and element.is_number:
            self.as_array(items, element, path)
        if kind.length is not None:
            self.code.line(f"if _len({items}) != {kind.length}:")
            self.code.line(f" _wrong({self.code.name(path)}, {items}, {kind.length})")
        else:
            if kind.most is not None:
                self.code.line(f"if _len({items}) > {kind.most}:")
                self.code.line(f" _beyond({self.code.name(path)}, {items}, {kind.most})")
            self.number("I", _COUNT, f"_len({items})")
        if isinstance(element, Primitive) and element.is_number:
            self.array(element, kind.length, items)
            return
        self.flush()
        self.code.line(f"if isinstance({items}, str): raise TypeError('letters are no list')")
        self.code.line(f"for _x in {items}:")
        self.code.indent(1)
        if isinstance(element, Struct):
            self.inner(element, self.timed(element, "_x"))
        else:
            self.displaced()
            self.value(element, "_x", path)
            self.flush()
        self.code.indent(-1)
        self.displaced()

    def array(self, element: Primitive, length: int | None, items: str) -> None:
        self.flush()
        small = f"{items}.nbytes < {BIG}"
        self.code.line(f"_add({items}.tobytes() if {small} else _block({items}))")
        self.moved(f"{items}.nbytes")

    def as_array(self, items: str, element: Primitive, path: str) -> None:
        import numpy as np

        kind = self.code.name(np.ndarray)
        dtype = np.dtype("<" + element.letters)
        wanted = self.code.name(dtype)
        self.code.line(
            f"if type({items}) is not {kind} or {items}.dtype is not {wanted} or {items}.ndim != 1:"
        )
        convert = self.code.name(array_of)
        self.code.line(f" {items} = {convert}({items}, {wanted}, {self.code.name(path)})")


def _block(array: NDArray[Any]) -> memoryview:
    """The memory of an array, or of a copy if its elements are not side by side."""
    if not array.flags.c_contiguous:
        array = array.copy()
    return memoryview(array.view("u1").data)


def _beyond(path: str, items: Any, most: int) -> None:
    raise ValueError(f"{path}: at most {most} elements, here are {len(items)}")
