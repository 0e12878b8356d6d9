"""Functions that read values of given kinds, made as text and compiled once.

Rules: numbers, truth values, enums, lengths and tags that stand side by side are unpacked with a
single call. This is the way of what is spelled as C++ does; anything else is read, or refused, by
`reader`, so both ways accept the same.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from struct import error as struct_error
from typing import Any, Final, Protocol

from yarpy.data.generated import Code
from yarpy.data.value import LIST, Buffer, Vocab
from yarpy.errors import DecodeError
from yarpy.kits.thrift.kind import (
    BOOL,
    SIZE,
    TEXT,
    VOCAB,
    Kind,
    ListOf,
    Part,
    Scalar,
    flat,
    has_sets,
    is_enum,
    is_struct,
    size_of,
)
from yarpy.kits.thrift.wire import reader
from yarpy.kits.thrift.wire.cursor import Cursor
from yarpy.kits.thrift.wire.writer import FAIL, OK

#: structs in a struct are read in the same function up to so many values of them
_INLINE: Final = 100
#: larger messages are read value by value, which costs little then; these are copied once
_SMALL: Final = 1 << 16


class Load(Protocol):
    """A function that reads values from a place on; `yarp4`: as YARP 4.0 spells them."""

    def __call__(self, data: Buffer, at: int, yarp4: bool = False, /) -> tuple[Any, ...]: ...


def load(path: str, parts: Sequence[Part], defaults: Sequence[Callable[[], Any]] = ()) -> Load:
    """The function that reads these values from a place on, up to the end of the bytes. The last
    may be missing for which there are `defaults`. DecodeError, Truncated."""
    made = _Reader()
    names = [f"_{at}" for at in range(len(parts))]
    for part, name in zip(parts, names, strict=True):
        made.value(part.kind, name, part.nested, f"{path}.{part.name}" if part.name else path)
    made.flush()
    made.code.line("if _p != _size: raise _Other")
    made.code.line(f"return ({', '.join(names)}{',' if names else ''})")
    quick = made.code.compiled("load", "_b, _p, _size")
    sets = has_sets([part.kind for part in parts])
    first_default = len(parts) - len(defaults)

    def slow(data: Buffer, at: int, tagged_sets: bool, yarp4: bool) -> tuple[Any, ...]:
        cursor = Cursor(data, at, tagged_sets, yarp4)
        values = []
        for number, part in enumerate(parts):
            if cursor.at == cursor.end and number >= first_default:
                values.append(defaults[number - first_default]())
                continue
            inner = f"{path}.{part.name}" if part.name else path
            values.append(reader.get(part.kind, cursor, inner, part.nested))
        if cursor.at != cursor.end:
            raise surplus(path, parts, cursor.end - cursor.at)
        return tuple(values)

    def read(data: Buffer, at: int, yarp4: bool = False, /) -> tuple[Any, ...]:
        size = len(data)
        if size <= _SMALL and type(data) is not bytes:
            data = bytes(data)
        try:
            if size <= _SMALL and not yarp4:
                found: tuple[Any, ...] = quick(data, at, size)
                return found
        except (Other, struct_error):
            pass
        except RecursionError:
            raise DecodeError(f"{path}: too many lists within each other") from None
        try:
            return slow(data, at, False, yarp4)
        except DecodeError:
            if not sets:
                raise
            try:
                return slow(data, at, True, yarp4)
            except DecodeError:
                pass
            raise

    return read


def surplus(path: str, parts: Sequence[Part], left: int) -> DecodeError:
    why = f"{path}: too many values: {left} bytes are left over"
    if parts and not parts[0].name:  # a result
        return DecodeError(why)
    return DecodeError(f"{why}; it takes {', '.join(part.name for part in parts) or 'nothing'}")


class Other(Exception):
    """This is spelled otherwise than C++ does: `reader` knows better."""


class _Reader:
    def __init__(self) -> None:
        self.code = Code()
        self.code.globals.update(_Other=Other, _get=_get, _str=str, _bytes=bytes, _range=range)
        self.code.globals.update(_vocab=Vocab.from_code, _bools=_bools)
        self.after: list[str] = []
        self.inline = _INLINE

    def flush(self) -> None:
        found = self.code.run()
        if found is not None:
            packing, targets = found
            self.code.line(f"{', '.join(targets)}, = {self.code.name(packing.unpack_from)}(_b, _p)")
            self.code.line(f"_p += {packing.size}")
        for line in self.after:
            self.code.line(line)
        self.after.clear()

    def tag(self, *wanted: int) -> None:
        """Numbers that must be these."""
        for number in wanted:
            found = self.code.variable()
            self.code.number("i", found)
            self.after.append(f"if {found} != {number}: raise _Other")

    def value(self, kind: Kind, target: str, nested: bool, path: str) -> None:
        if is_struct(kind):
            if nested:
                self.tag(LIST, flat(kind))
            if flat(kind) <= self.inline:
                self.inline -= flat(kind)
                self.struct(kind, target, path)
                return
        elif isinstance(kind, Scalar):
            self.tag(kind.code)
            self.scalar(kind, target)
            return
        elif is_enum(kind):
            base: Scalar = kind._base  # type: ignore[union-attr]
            self.tag(base.code)
            self.code.number("i" if base is VOCAB else base.letter, target)
            known = self.code.name(kind._value2member_map_.get)  # type: ignore[union-attr]
            self.after.append(f"{target} = {known}({target}, {target})")
            return
        elif isinstance(kind, ListOf) and isinstance(kind.element, Scalar):
            self.list(kind.element, target)
            return
        elif isinstance(kind, ListOf) and is_struct(kind.element):
            self.structs(kind.element, target)
            return
        self.flush()
        where = self.code.name(path)
        self.code.line(f"{target}, _p = _get({self.code.name(kind)}, _b, _p, {where})")

    def struct(self, kind: Any, target: str, path: str) -> None:
        inner = self.code.variable()
        cls = self.code.name(kind, "C")
        self.code.line(f"{inner} = {cls}.__new__({cls})")
        for field in kind._specs():
            where = f"{path}.{field.name}"
            self.value(field.kind, f"{inner}.{field.attribute}", field.nested, where)
        self.after.append(f"{target} = {inner}")

    def scalar(self, kind: Scalar, target: str) -> None:
        if kind is BOOL:
            self.code.number("i", target)
            self.after.append(f"if {target} != {OK} and {target} != {FAIL}: raise _Other")
            self.after.append(f"{target} = {target} == {OK}")
        elif kind.letter:
            self.code.number(kind.letter, target)
            if kind is VOCAB:
                self.after.append(f"{target} = _vocab({target})")
            elif kind is SIZE:
                self.after.append(f"if {target} < 0: raise _Other")
        else:
            self.data("_p + " + self.count(), target, kind)

    def count(self) -> str:
        found = self.code.variable()
        self.code.number("i", found)
        self.flush()
        self.code.line(f"if {found} < 0: raise _Other")
        return found

    def data(self, end: str, target: str, kind: Scalar) -> None:
        self.code.line(f"_e = {end}")
        self.code.line("if _e > _size: raise _Other")
        text = "_str(_b[_p:_e], 'utf-8', 'surrogateescape')"
        self.code.line(f"{target} = {text if kind is TEXT else '_bytes(_b[_p:_e])'}")
        self.code.line("_p = _e")

    def list(self, element: Scalar, target: str) -> None:
        self.tag(LIST + element.code)
        count = self.count()
        if element.is_number or element is BOOL:
            import numpy as np

            size = 4 if element is BOOL else size_of(element)
            dtype = self.code.name(np.dtype("<i4" if element is BOOL else "<" + element.letter))
            self.code.line(f"_e = _p + {count} * {size}")
            self.code.line("if _e > _size: raise _Other")
            look = f"{self.code.name(np.frombuffer)}(_b, {dtype}, {count}, _p)"
            self.code.line(f"{target} = {f'_bools({look})' if element is BOOL else look}")
            self.code.line("_p = _e")
            return
        least = 4
        self.code.line(f"if _p + {count} * {least} > _size: raise _Other")
        self.code.line(f"_x{target.replace('.', '')} = []")
        items = f"_x{target.replace('.', '')}"
        self.code.line(f"for _ in _range({count}):")
        self.code.indent(1)
        self.scalar(element, "_x")
        self.flush()
        self.code.line(f"{items}.append(_x)")
        self.code.indent(-1)
        self.code.line(f"{target} = {items}")

    def structs(self, kind: Any, target: str) -> None:
        self.tag(LIST)
        count = self.count()
        self.code.line(f"if _p + {count} * 8 > _size: raise _Other")
        items = self.code.variable()
        self.code.line(f"{items} = []")
        self.code.line(f"for _ in _range({count}):")
        cls = self.code.name(kind, "C")
        self.code.line(f" _x, _p = {cls}._load(_b, _p, _size)")
        self.code.line(f" {items}.append(_x)")
        self.code.line(f"{target} = {items}")


def load_struct(kind: Any) -> Callable[[Buffer, int, int], tuple[Any, int]]:
    """The function that reads a struct which is a list of its own: `Other` if it is not plain."""
    made = _Reader()
    made.value(kind, "_o", True, kind.__name__)
    made.flush()
    made.code.line("return _o, _p")
    return made.code.compiled("load", "_b, _p, _size")


def _get(kind: Kind, data: Buffer, at: int, path: str) -> tuple[Any, int]:
    cursor = Cursor(data, at)
    try:
        found = reader.get(kind, cursor, path)
    except DecodeError:
        raise Other from None
    return found, cursor.at


def _bools(codes: Any) -> Any:
    return (codes != FAIL) & (codes != 0)
