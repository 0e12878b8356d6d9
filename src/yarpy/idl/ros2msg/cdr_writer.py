"""A message to the bytes of ROS 2: CDR, by a function for each type that is compiled once.

Rules: as in `cdr_reader` and `rosmsg/writer.py`. Arrays of at least 4096 bytes become blocks of
their own and are not copied. Whatever does not fit is looked for only then, by `fault`, which names
the field.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from struct import error as struct_error
from typing import TYPE_CHECKING, Any, Final

from yarpy.data.value import BIG, Blocks
from yarpy.idl.ros2msg.cdr_reader import HEAD, Alignment
from yarpy.idl.rosmsg.code import Code
from yarpy.idl.rosmsg.fault import array_of, fault, wrong_length
from yarpy.idl.rosmsg.message import Message, attribute
from yarpy.idl.rosmsg.model import ListOf, Primitive, Struct, Type
from yarpy.idl.rosmsg.writer import joined

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: `write(message, add, position)` adds the pieces of a message; the position behind them
Write = Callable[[Any, Callable[[bytes | memoryview], None], int], int]

_INLINE: Final = 100
_ZEROS: Final = tuple(bytes(count) for count in range(8))


def writer(struct: Struct, classes: Mapping[Struct, type[Message]]) -> Write:
    """The function that writes a type; `classes` has those of the structs in it."""
    made = _Writer(classes)
    made.struct(struct, "_o", struct.name)
    made.flush()
    made.code.line("return _p")
    write: Write = made.code.compiled("_write", "_o, _add, _p")
    return write


def whole(struct: Struct, write: Write) -> Callable[[Any], Blocks]:
    """`to_ros` of a class."""

    def to_ros(self: Any) -> Blocks:
        pieces: list[bytes | memoryview] = [HEAD]
        try:
            write(self, pieces.append, 0)
        except (struct_error, TypeError, AttributeError, OverflowError, ValueError) as error:
            raise fault(struct, self) or error from None
        if memoryview in map(type, pieces):
            return joined(pieces)
        return (b"".join(pieces),)

    return to_ros


class _Writer:
    def __init__(self, classes: Mapping[Struct, type[Message]]) -> None:
        self.classes = classes
        self.code = Code()
        self.code.globals.update(_len=len, _wrong=wrong_length, _beyond=_beyond, _zeros=_ZEROS)
        self.inline = _INLINE
        self.alignment = Alignment()

    def flush(self) -> None:
        found = self.code.run()
        if found is not None:
            packing, terms = found
            self.code.line(f"_add({self.code.name(packing.pack)}({', '.join(terms)}))")
            self.code.line(f"_p += {packing.size}")

    def align(self, size: int) -> None:
        padding = self.alignment.padding(size)
        if padding is None:
            self.flush()
            self.pad(size)
            self.alignment.forget(size)
        elif padding:
            self.code.number("x" * padding)
            self.alignment.advance(padding)

    def pad(self, size: int) -> None:
        """Go on at a multiple of `size`, which only the position tells."""
        self.code.line(f"if _p & {size - 1}:")
        self.code.line(f" _add(_zeros[-_p & {size - 1}])")
        self.code.line(f" _p = _p + {size - 1} & -{size}")

    def number(self, letter: str, size: int, source: str) -> None:
        self.align(size)
        self.code.number(letter, source)
        self.alignment.advance(size)

    def struct(self, struct: Struct, source: str, path: str) -> None:
        for field in struct.fields:
            self.value(field.type, f"{source}.{attribute(field)}", f"{path}.{field.name}")
        if not struct.fields:
            self.number("B", 1, "0")

    def value(self, kind: Type, source: str, path: str) -> None:
        if isinstance(kind, Struct):
            if kind.parts > self.inline:
                self.flush()
                self.code.line(
                    f"_p = {self.code.name(self.classes[kind]._write)}({source}, _add, _p)"
                )
                self.alignment.forget()
                return
            self.inline -= kind.parts
            inner = self.code.variable()
            self.code.line(f"{inner} = {source}")
            self.struct(kind, inner, path)
        elif isinstance(kind, ListOf):
            self.list(kind, source, path)
        elif kind.is_number:
            self.number(kind.letters, kind.size, source)
        else:
            self.string(source)

    def string(self, source: str) -> None:
        text = self.code.variable()
        self.code.line(f"{text} = {source}.encode('utf-8', 'surrogateescape') + b'\\0'")
        self.number("I", 4, f"_len({text})")
        self.flush()
        self.code.line(f"_add({text})")
        self.code.line(f"_p += _len({text})")
        self.alignment.forget()

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
            self.number("I", 4, f"_len({items})")
        if isinstance(element, Primitive) and element.is_number:
            self.array(element, kind.length, items)
            return
        self.flush()
        self.code.line(f"if isinstance({items}, str): raise TypeError('letters are no list')")
        self.code.line(f"for _x in {items}:")
        self.code.indent(1)
        if isinstance(element, Struct):
            write = self.code.name(self.classes[element]._write)
            self.code.line(f"_p = {write}(_x, _add, _p)")
        else:
            self.alignment.forget()
            self.string("_x")
        self.code.indent(-1)
        self.alignment.forget()

    def array(self, element: Primitive, length: int | None, items: str) -> None:
        size = element.size
        if length is not None:
            self.align(size)
        self.flush()
        if length is None and self.alignment.padding(size) != 0:
            self.code.line(f"if _len({items}):")
            self.code.indent(1)
            self.pad(size)
            self.code.indent(-1)
        block = self.code.name(_block)
        small = f"{items}.nbytes < {BIG}"
        self.code.line(f"_add({items}.tobytes() if {small} else {block}({items}))")
        self.code.line(f"_p += {items}.nbytes")
        if length is not None:
            self.alignment.advance(length * size)
        else:
            self.alignment.forget(min(size, 4))

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
