"""A message to the bytes of ROS 2: CDR, by a function for each type that is compiled once.

Rules: as in `cdr_reader` and `ros/message/writer.py`. Arrays of at least 4096 bytes become blocks
of their own and are not copied. Whatever does not fit is looked for only then, by `fault`, which
names the field.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

from yarpy.data.value import Blocks
from yarpy.peers.ros.message import writer as packed
from yarpy.peers.ros.message.message import Message
from yarpy.peers.ros.message.model import Primitive, Struct, Type
from yarpy.peers.ros.message.writer import Write, Writer
from yarpy.peers.ros2.message.cdr_plain import HEAD
from yarpy.peers.ros2.message.cdr_reader import Alignment

_ZEROS: Final = tuple(bytes(count) for count in range(8))


def writer(struct: Struct, classes: Mapping[Struct, type[Message]]) -> Write:
    """The function that writes a type; `classes` has those of the structs in it."""
    return _Writer(classes).compiled(struct)


def whole(struct: Struct, write: Write) -> Callable[[Any], Blocks]:
    """`to_ros` of a class."""
    return packed.whole(struct, write, HEAD)


class _Writer(Writer):
    def __init__(self, classes: Mapping[Struct, type[Message]]) -> None:
        super().__init__(classes)
        self.code.globals.update(_zeros=_ZEROS, _wide=_wide)
        self.alignment = Alignment()

    def moved(self, size: str) -> None:
        self.code.line(f"_p += {size}")

    def displaced(self) -> None:
        self.alignment.forget()

    def value(self, kind: Type, source: str, path: str) -> None:
        if not (isinstance(kind, Primitive) and kind.wide):
            super().value(kind, source, path)
            return
        text = self.code.variable()
        self.code.line(f"{text} = _wide({source})")
        self.number("I", 4, f"_len({text}) // 4")
        self.flush()
        self.code.line(f"_add({text})")
        self.moved(f"_len({text})")
        self.alignment.forget(4)

    def text(self, source: str) -> str:
        return f"{super().text(source)} + b'\\0'"

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
        super().number(letter, size, source)
        self.alignment.advance(size)

    def struct(self, struct: Struct, source: str, path: str) -> None:
        super().struct(struct, source, path)
        if not struct.fields:
            self.number("B", 1, "0")

    def array(self, element: Primitive, length: int | None, items: str) -> None:
        size = element.size
        if length is not None:
            self.align(size)
        elif self.alignment.padding(size) != 0:
            self.flush()
            self.code.line(f"if _len({items}):")
            self.code.indent(1)
            self.pad(size)
            self.code.indent(-1)
        super().array(element, length, items)
        if length is not None:
            self.alignment.advance(length * size)
        else:
            self.alignment.forget(min(size, 4))


def _wide(text: str) -> bytes:
    """The units of a text in UTF-16, four bytes each."""
    units = text.encode("utf-16-le", "surrogatepass")
    found = bytearray(2 * len(units))
    found[0::4], found[1::4] = units[0::2], units[1::2]
    return bytes(found)
