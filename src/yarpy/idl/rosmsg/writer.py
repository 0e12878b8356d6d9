"""A message to the bytes of ROS: a function for each type, written and compiled once.

Rules: as in `reader`. Arrays of at least 4096 bytes become blocks of their own and are not copied,
whatever type of array, bytes or list the field holds; the rest is joined. Whatever does not fit is
looked for only then, by `fault`, which names the field.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from struct import error as struct_error
from typing import TYPE_CHECKING, Any

from yarpy.data.value import BIG, Blocks
from yarpy.idl.rosmsg.code import Code
from yarpy.idl.rosmsg.fault import array_of, fault, wrong_length
from yarpy.idl.rosmsg.message import Message, attribute
from yarpy.idl.rosmsg.model import ListOf, Primitive, Struct, Type

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: `write(message, add)` adds the pieces of a message
Write = Callable[[Any, Callable[[bytes | memoryview], None]], None]

_INLINE = 100


def writer(struct: Struct, classes: Mapping[Struct, type[Message]]) -> Write:
    """The function that writes a type; `classes` has those of the structs in it."""
    made = _Writer(classes)
    made.struct(struct, "_o", struct.name)
    made.flush()
    write: Write = made.code.compiled("_write", "_o, _add")
    return write


def whole(struct: Struct, write: Write) -> Callable[[Any], Blocks]:
    """`to_ros` of a class."""

    def to_ros(self: Any) -> Blocks:
        pieces: list[bytes | memoryview] = []
        try:
            write(self, pieces.append)
        except (struct_error, TypeError, AttributeError, OverflowError, ValueError) as error:
            raise fault(struct, self) or error from None
        if memoryview in map(type, pieces):
            return joined(pieces)
        return (b"".join(pieces),)

    return to_ros


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
    return tuple(block for block in blocks if block)


class _Writer:
    def __init__(self, classes: Mapping[Struct, type[Message]]) -> None:
        self.classes = classes
        self.code = Code()
        self.code.globals.update(_len=len, _str=str, _wrong=wrong_length)
        #: lines that follow the numbers of the run
        self.after: list[str] = []
        self.inline = _INLINE

    def flush(self) -> None:
        found = self.code.run()
        if found is not None:
            packing, terms = found
            self.code.line(f"_add({self.code.name(packing.pack)}({', '.join(terms)}))")
        for line in self.after:
            self.code.line(line)
        self.after.clear()

    def struct(self, struct: Struct, source: str, path: str) -> None:
        for field in struct.fields:
            self.value(field.type, f"{source}.{attribute(field)}", f"{path}.{field.name}")

    def value(self, kind: Type, source: str, path: str) -> None:
        if isinstance(kind, Struct):
            if kind.parts > self.inline:
                self.flush()
                self.code.line(f"{self.code.name(self.classes[kind]._write)}({source}, _add)")
                return
            self.inline -= kind.parts
            inner = self.code.variable()
            self.code.line(f"{inner} = {source}")
            self.struct(kind, inner, path)
        elif isinstance(kind, ListOf):
            self.list(kind, source, path)
        else:
            assert isinstance(kind, Primitive)
            self.primitive(kind, source)

    def primitive(self, kind: Primitive, source: str) -> None:
        if kind.is_number:
            self.code.number(kind.letters, source)
        elif kind.name == "string":
            text = self.code.variable()
            self.code.line(f"{text} = {source}.encode('utf-8', 'surrogateescape')")
            self.code.number("I", f"_len({text})")
            self.flush()
            self.code.line(f"_add({text})")
        else:
            time = self.code.variable()
            self.code.line(f"{time} = {source}")
            self.code.number(kind.letters, f"{time}.secs", f"{time}.nsecs")

    def list(self, kind: ListOf, source: str, path: str) -> None:
        items = self.code.variable()
        self.code.line(f"{items} = {source}")
        element = kind.element
        is_array = isinstance(element, Primitive) and element.is_number
        if isinstance(element, Primitive) and element.is_number:
            self.as_array(items, element, path)
        if kind.length is None:
            self.code.number("I", f"_len({items})")
        else:
            self.code.line(f"if _len({items}) != {kind.length}:")
            self.code.line(f" _wrong({self.code.name(path)}, {items}, {kind.length})")
        self.flush()
        if is_array:
            block = self.code.name(_block)
            small = f"{items}.nbytes < {BIG}"
            self.code.line(f"_add({items}.tobytes() if {small} else {block}({items}))")
            return
        self.code.line(f"if isinstance({items}, str): raise TypeError('letters are no list')")
        self.code.line(f"for _x in {items}:")
        self.code.indent(1)
        if isinstance(element, Struct):
            self.code.line(f"{self.code.name(self.classes[element]._write)}(_x, _add)")
        else:
            assert isinstance(element, Primitive)
            self.primitive(element, "_x")
            self.flush()
        self.code.indent(-1)

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
