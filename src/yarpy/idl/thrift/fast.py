"""Functions that write and read one type each, made as text and compiled once.

    dump(kinds)      values -> bytes
    load(kinds)      bytes -> values

Rules: numbers, truth values, enums, lengths and tags that stand side by side are packed or unpacked
with a single call. This is the way of what is as it should be, written exactly as C++ does; for
anything else `writer` names what does not fit, and `reader` reads what may be spelled otherwise, so
both ways accept the same. Whatever is not a scalar, a struct or a list of these is left to them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from struct import error as struct_error
from typing import Any, Final

from yarpy.data.limit import limits
from yarpy.data.value import LIST, Buffer, Vocab
from yarpy.errors import DecodeError
from yarpy.idl.rosmsg.code import Code
from yarpy.idl.thrift import reader, writer
from yarpy.idl.thrift.kind import (
    BOOL,
    SIZE,
    TEXT,
    VOCAB,
    Kind,
    ListOf,
    Scalar,
    flat,
    is_enum,
    is_struct,
)
from yarpy.idl.thrift.writer import FAIL, OK

#: structs in a struct are written and read in the same function up to so many values of them
_INLINE: Final = 100
#: messages up to this size are copied once: slices of bytes are cheaper than those of views
_SMALL: Final = 1 << 16

Dump = Callable[..., bytes]
Load = Callable[[Buffer, int], tuple[Any, ...]]


@dataclass(frozen=True, slots=True)
class Part:
    """A value in a row of them: an argument, a result, the struct that is the whole message."""

    name: str
    kind: Kind
    nested: bool = False


def dump(path: str, parts: Sequence[Part], head: bytes = b"") -> Dump:
    """The function that writes these values behind `head`. TypeError, OverflowError name a part as
    `path.name`, or `path` where it has no name."""
    names = [f"_{at}" for at in range(len(parts))]
    made = _Writer()
    made.code.line("_l = []")
    made.code.line("_a = _l.append")
    if head:
        made.code.line(f"_a({made.code.name(head)})")
    for part, name in zip(parts, names, strict=True):
        made.value(part.kind, name, part.nested)
    made.flush()
    made.code.line("return _join(_l)")
    quick = made.code.compiled("dump", ", ".join(names))
    fixed = len(parts)

    def write(*values: Any) -> bytes:
        try:
            found: bytes = quick(*values)
            return found
        except _FAULTS:
            pass  # said again, with names
        return slow_dump(path, parts, values, head)

    return write if fixed else lambda: head


#: what a value of another kind may cause
_FAULTS: Final = (struct_error, TypeError, AttributeError, ValueError, OverflowError)


def slow_dump(
    path: str, parts: Sequence[Part], values: Sequence[Any], head: bytes = b"", bottle: bool = False
) -> bytes:
    """The same, value by value. `bottle`: so that it is one, whatever C++ would make of it."""
    found: list[Buffer] = [head]
    for part, value in zip(parts, values, strict=True):
        inner = f"{path}.{part.name}" if part.name else path
        if part.nested and is_struct(part.kind):
            found.append(_HEAD(LIST, flat(part.kind)))
        writer.put(part.kind, value, found.append, inner, bottle)
    return b"".join(found)


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
    sets = reader.has_sets([part.kind for part in parts])
    first_default = len(parts) - len(defaults)

    def slow(data: Buffer, at: int, tagged_sets: bool) -> tuple[Any, ...]:
        cursor = reader.Cursor(data, at, tagged_sets)
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

    def read(data: Buffer, at: int) -> tuple[Any, ...]:
        size = len(data)
        if size <= _SMALL and type(data) is not bytes:
            data = bytes(data)
        try:
            if size <= _SMALL:
                found: tuple[Any, ...] = quick(data, at, size)
                return found
        except (Other, struct_error):
            pass
        except RecursionError:
            raise DecodeError(f"{path}: too many lists within each other") from None
        try:
            return slow(data, at, False)
        except DecodeError:
            if not sets:
                raise
            try:
                return slow(data, at, True)
            except DecodeError:
                pass
            raise

    return read


def surplus(path: str, parts: Sequence[Part], left: int) -> DecodeError:
    names = ", ".join(part.name for part in parts)
    what = f"it takes {names}" if names else "it takes nothing"
    return DecodeError(f"{path}: {left} bytes are left over; {what}")


class Other(Exception):
    """This is spelled otherwise than C++ does: `reader` knows better."""


class _Writer:
    def __init__(self) -> None:
        self.code = Code()
        self.code.globals.update(_join=b"".join, _put=writer.put, _numbers=writer.numbers)
        self.code.globals.update(_word=writer.word, _blob=writer.blob, _len=len, _range=range)
        self.code.globals.update(_bool=bool, _truth=writer.truth, _type=type)
        self.inline = _INLINE

    def flush(self) -> None:
        found = self.code.run()
        if found is not None:
            packing, terms = found
            self.code.line(f"_a({self.code.name(packing.pack)}({', '.join(terms)}))")

    def value(self, kind: Kind, term: str, nested: bool = False) -> None:
        if is_struct(kind):
            self.struct(kind, term, nested)
        elif isinstance(kind, Scalar):
            self.code.number("i", str(kind.code))
            self.scalar(kind, term)
        elif is_enum(kind):
            base: Scalar = kind._base  # type: ignore[union-attr]
            self.code.number("i", str(base.code))
            self.code.number("i" if base is VOCAB else base.letter, term)
        elif isinstance(kind, ListOf) and isinstance(kind.element, Scalar):
            self.list(kind.element, term)
        elif isinstance(kind, ListOf) and is_struct(kind.element):
            self.structs(kind.element, term)
        else:
            self.flush()
            self.code.line(f"_put({self.code.name(kind)}, {term}, _a, '')")

    def scalar(self, kind: Scalar, term: str) -> None:
        if kind is BOOL:
            self.code.line(f"if _type({term}) is not _bool: _truth({term}, '')")
            self.code.number("i", f"{OK} if {term} else {FAIL}")
        elif kind is VOCAB:
            self.code.number("i", f"_word({term}, '')")
        elif kind is SIZE:
            self.code.line(f"if {term} < 0 or _type({term}) is _bool: raise OverflowError")
            self.code.number("i", term)
        elif kind.letter:
            self.code.line(f"if _type({term}) is _bool: raise TypeError")
            self.code.number(kind.letter, term)
        else:
            data = self.code.variable()
            encoded = f"{term}.encode('utf-8', 'surrogateescape')"
            given = encoded if kind is TEXT else f"_blob({term}, '')"
            self.code.line(f"{data} = {given}")
            self.code.number("i", f"_len({data})")
            self.flush()
            self.code.line(f"_a({data})")

    def struct(self, kind: Any, term: str, nested: bool) -> None:
        if nested:
            self.code.number("ii", str(LIST), str(flat(kind)))
        if flat(kind) > self.inline:
            self.flush()
            self.code.line(f"_put({self.code.name(kind)}, {term}, _a, '')")
            return
        self.inline -= flat(kind)
        inner = self.code.variable()
        self.code.line(f"{inner} = {term}")
        cls = self.code.name(kind, "C")
        self.code.line(f"if {inner}.__class__ is not {cls}: raise TypeError")
        for field in kind._specs():
            self.value(field.kind, f"{inner}.{field.attribute}", field.nested)

    def list(self, element: Scalar, term: str) -> None:
        self.code.number("i", str(LIST + element.code))
        if element.is_number or element is BOOL:
            data = self.code.variable()
            size = 4 if element is BOOL else _size(element)
            self.code.line(f"{data} = _numbers({self.code.name(element)}, {term}, '')")
            self.code.number("i", f"_len({data}) // {size}")
            self.flush()
            self.code.line(f"_a({data})")
            return
        items = self.code.variable()
        self.code.line(f"{items} = {term}")
        self.code.line(f"if {items}.__class__ is not list: raise TypeError")
        self.code.number("i", f"_len({items})")
        self.flush()
        self.code.line(f"for _x in {items}:")
        self.code.indent(1)
        self.scalar(element, "_x")
        self.flush()
        self.code.indent(-1)

    def structs(self, kind: Any, term: str) -> None:
        items = self.code.variable()
        self.code.line(f"{items} = {term}")
        self.code.line(f"if {items}.__class__ is not list: raise TypeError")
        self.code.number("ii", str(LIST), f"_len({items})")
        self.flush()
        self.code.line(f"for _x in {items}:")
        cls = self.code.name(kind, "C")
        self.code.line(f" _a({cls}._dump(_x))")


class _Reader:
    def __init__(self) -> None:
        self.code = Code()
        self.code.globals.update(_Other=Other, _get=_get, _str=str, _bytes=bytes, _range=range)
        self.code.globals.update(_vocab=Vocab.from_code, _bools=_bools, _take=_take)
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

            size = 4 if element is BOOL else _size(element)
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


def dump_struct(kind: Any) -> Dump:
    """The function that writes a struct as a list of its own, for lists of it."""
    return dump(kind.__name__, [Part("", kind, nested=True)])


def load_struct(kind: Any) -> Callable[[Buffer, int, int], tuple[Any, int]]:
    """The function that reads a struct which is a list of its own: `Other` if it is not plain."""
    made = _Reader()
    made.value(kind, "_o", True, kind.__name__)
    made.flush()
    made.code.line("return _o, _p")
    return made.code.compiled("load", "_b, _p, _size")


def _get(kind: Kind, data: Buffer, at: int, path: str) -> tuple[Any, int]:
    cursor = reader.Cursor(data, at)
    try:
        found = reader.get(kind, cursor, path)
    except DecodeError:
        raise Other from None
    return found, cursor.at


def _bools(codes: Any) -> Any:
    return (codes != FAIL) & (codes != 0)


def _take(count: int) -> None:
    if count > limits().elements:
        raise Other


def _size(kind: Scalar) -> int:
    from struct import calcsize

    return calcsize("<" + kind.letter)


def _head() -> Callable[..., bytes]:
    from struct import Struct as Packing

    return Packing("<ii").pack


_HEAD: Final = _head()
