"""Functions that write values of given kinds, made as text and compiled once.

Rules: numbers, truth values, enums, lengths and tags that stand side by side are packed with a
single call. What does not fit is said by `writer`, which names it; whatever is not a scalar, a
struct or a list of these is written by it, too.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from struct import Struct as Packing
from struct import error as struct_error
from typing import Any, Final

from yarpy.data.generated import Code
from yarpy.data.value import LIST, Buffer
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
    is_enum,
    is_struct,
    size_of,
)
from yarpy.kits.thrift.wire import writer
from yarpy.kits.thrift.wire.writer import FAIL, OK

#: structs in a struct are written in the same function up to so many values of them
INLINE: Final = 100

Dump = Callable[..., bytes]

_HEAD: Final = Packing("<ii").pack


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


class _Writer:
    def __init__(self) -> None:
        self.code = Code()
        self.code.globals.update(_join=b"".join, _put=writer.put, _numbers=writer.numbers)
        self.code.globals.update(_word=writer.word, _blob=writer.blob, _len=len, _range=range)
        self.code.globals.update(_bool=bool, _truth=writer.truth, _type=type)
        self.inline = INLINE

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
            item = f"{inner}.{field.attribute}"
            if field.optional:
                kept = self.code.variable()
                first = self.code.name(field.first)
                self.code.line(f"{kept} = {first}() if {item} is None else {item}")
                item = kept
            self.value(field.kind, item, field.nested)

    def list(self, element: Scalar, term: str) -> None:
        self.code.number("i", str(LIST + element.code))
        if element.is_number or element is BOOL:
            data = self.code.variable()
            size = 4 if element is BOOL else size_of(element)
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


def dump_struct(kind: Any) -> Dump:
    """The function that writes a struct as a list of its own, for lists of it."""
    return dump(kind.__name__, [Part("", kind, nested=True)])
