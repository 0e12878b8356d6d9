"""Types and values of a `.thrift` file as Python code.

Rules: a type that comes later is in quotes. A value is checked against its type, and written as a
literal or as names that are there: DecodeError says file and line.
"""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import replace
from math import isfinite
from typing import Any, Final

from yarpy.errors import DecodeError
from yarpy.kits.thrift import kind as kinds
from yarpy.kits.thrift.file.document import (
    ConstText,
    EnumText,
    FieldText,
    Name,
    Pairs,
    ServiceText,
    StructText,
    TypeText,
)
from yarpy.kits.thrift.file.interface import BASE, Interface, external
from yarpy.kits.thrift.kind import ARRAYS, BINARY, BOOL, DOUBLE, TEXT, External, Scalar, size_of
from yarpy.kits.thrift.word import ENUM, ERROR, STRUCT, TYPES, attribute

_PLAIN: Final = {BOOL: "bool", DOUBLE: "float", TEXT: "str", BINARY: "bytes"}
_SHOWN: Final = 20  # names of an enum in an error
_WORD: Final = re.compile(r"(?<![\w.])[^\W\d]\w*")


def taken(struct: StructText) -> Collection[str]:
    """The names that fields of a struct cannot have in Python."""
    return ERROR if struct.sort == "exception" else STRUCT


def _members(interface: Interface) -> set[str]:
    """The names of all fields and methods."""
    found: set[str] = set()
    for each in interface.document.declarations:
        if isinstance(each, StructText):
            found.update(field.name for field in each.fields)
        elif isinstance(each, ServiceText):
            found.update(method.name for method in each.methods)
    return found


class Code:
    """The code of a file's declarations. `known`: names defined so far; `uses`: names to import."""

    def __init__(self, interface: Interface, stubs: bool) -> None:
        self.interface = interface
        self.stubs = stubs
        self.known: set[str] = set()  # what is defined so far
        self.members: set[str] = set()  # of the class that is being written
        self.hidden: set[str] = set()  # names that members of a class in the stubs hide
        taken = {*interface.names, *interface.includes, *_members(interface)}
        self.thrift = "thrift"
        while self.thrift in taken:
            self.thrift += "_"
        self.yarpy = "yarpy"
        while self.yarpy in taken:
            self.yarpy += "_"
        self.uses: set[str] = set()
        self._enums: dict[int, tuple[dict[int, str], dict[str, int]]] = {}
        self._prefixes: dict[int, str] = {}

    # -- types ------------------------------------------------------------------------------------

    def annotation(self, type_: TypeText, nested: bool = False) -> str:
        """Return the type as it is written in Python."""
        found = self._annotation(type_)
        _, what = self.interface.resolve(type_)
        if nested and isinstance(what, StructText) and external(what) is None:
            found = f"{self.thrift}.Nested[{found}]"
        return self.uncovered(found)

    def optional(self, text: str) -> str:
        """The annotation of what may be None."""
        whole = text.startswith('"') and text.endswith('"') and text.count('"') == 2
        return f'"{text[1:-1]} | None"' if whole else f"{text} | None"

    def uncovered(self, text: str) -> str:
        """An annotation in a class that has members with the names of types: `bytes: bytes`."""
        hidden = self.members.intersection(_WORD.findall(text))
        if not hidden:
            return text
        if not self.stubs:  # it is looked up in the module
            return quoted(text.replace('"', ""))
        self.hidden |= hidden
        return _WORD.sub(lambda found: ("_" if found[0] in hidden else "") + found[0], text)

    def _annotation(self, type_: TypeText) -> str:
        if type_.name == "list":
            _, element = self.interface.resolve(type_.inner[0])
            if isinstance(element, Scalar) and element in ARRAYS and element is not kinds.SIZE:
                return f"{self.thrift}.{ARRAYS[element]}"
        if type_.name in ("list", "set", "map"):
            inner = ", ".join(map(self._annotation, type_.inner))
            return f"{'dict' if type_.name == 'map' else type_.name}[{inner}]"
        _, found = self.interface.resolve(type_)
        if isinstance(found, Scalar) and type_.name in BASE:
            return self.scalar(found)
        return self.mention(type_.name, type_.line)

    def accepted(self, type_: TypeText) -> str:
        """Return the annotation of the values that may be given for a type."""
        where, what = self.interface.resolve(type_)
        if isinstance(what, TypeText) and what.name == "list":
            _, element = where.resolve(what.inner[0])
            if isinstance(element, Scalar) and element in ARRAYS:
                self.uses.add("ArrayLike")
                return "ArrayLike"
        return self.uncovered(self._annotation(type_))

    def scalar(self, kind: Scalar) -> str:
        return _PLAIN.get(kind) or f"{self.thrift}.{kind.name}"

    def external(self, kind: External) -> str:
        self.uses.add("Annotated")
        python = "object"
        if kind.python:
            self.uses.add("yarpy")
            python = f"{self.yarpy}.{kind.python.rpartition('.')[2]}"
        arguments = [quoted(kind.name)]
        if kind.size != 1 or kind.python:
            arguments.append(str(kind.size))
        if kind.python:
            arguments.append(quoted(kind.python))
        return f"Annotated[{python}, {self.thrift}.External({', '.join(arguments)})]"

    def mention(self, name: str, line: int) -> str:
        """A name where it is used: in quotes, if it comes later."""
        where, found = self.interface.find(name, line)
        if where is not self.interface:
            return f"{name.rpartition('.')[0]}.{attribute(found.name, TYPES)}"
        text = attribute(found.name, TYPES)
        return text if name in self.known or self.stubs else f'"{text}"'

    # -- values -----------------------------------------------------------------------------------

    def default(self, field: FieldText, lacks: bool = False) -> str:
        """The default of a field or an argument; `lacks`: it may be None, and begins so."""
        found = self._default(field, lacks)
        make = f"{self.thrift}.new("
        inner = found.removeprefix(make).removesuffix(")") if found.startswith(make) else ""
        if inner.startswith("lambda") or not self.members.intersection(_WORD.findall(found)):
            return found
        # a function looks a name up in the module, not in the class
        return f"{make}lambda: {inner}())" if inner else f"{make}lambda: {found})"

    def _default(self, field: FieldText, lacks: bool) -> str:
        _, what = self.interface.resolve(field.type)
        if self.stubs:
            return "..."
        if field.default is None:
            if lacks:
                return "None"
            if isinstance(what, Scalar):
                if what is kinds.VOCAB:
                    return '""'
                return {BOOL: "False", TEXT: '""', BINARY: 'b""'}.get(
                    what, "0.0" if what.letter in "fd" else "0"
                )
            name = self._annotation(field.type).strip('"')
            if isinstance(what, EnumText):
                if not what.values:
                    return "0"
                if name.strip('"') in self.known or "." in name:
                    return f"{name}.{attribute(what.values[0].name, ENUM)}"
                return f"{self.thrift}.new(lambda: {name}.{attribute(what.values[0].name, ENUM)})"
            if isinstance(what, StructText):
                outside = external(what)
                if outside is not None:
                    return f"{self.thrift}.new({self._empty(outside)})"
                return f"{self.thrift}.new(lambda: {name}())"
            return f"{self.thrift}.new({ {'list': 'list', 'set': 'set'}.get(what.name, 'dict') })"
        value = self.value(field.type, field.default, field.line)
        if isinstance(what, Scalar):
            return value
        if isinstance(what, EnumText) and "." in value and what.name in self.known:
            return value
        return f"{self.thrift}.new(lambda: {value})"

    def _empty(self, kind: External) -> str:
        self.uses.add("yarpy")
        return f"{self.yarpy}.{kind.python.rpartition('.')[2] if kind.python else 'Bottle'}"

    def value(self, type_: TypeText, value: Any, line: int) -> str:
        """A value of a type, as Python code."""
        where, what = self.interface.resolve(type_)
        if isinstance(value, Name):
            return self.named(type_, what, value)
        if isinstance(what, Scalar):
            return self.literal(what, value, line)
        if isinstance(what, EnumText):
            if not isinstance(value, int):
                raise self._misfit(what.name, value, line)
            member = self.members_of(what)[0].get(value)
            name = self.mention(type_.name, line).strip('"')
            return str(value) if member is None else f"{name}.{attribute(member, ENUM)}"
        if isinstance(what, StructText):
            return self.record(type_, what, value, line)
        what = self.seen(what, where)
        if what.name == "map":
            if not isinstance(value, Pairs):
                raise self._misfit("a map", value, line)
            items = (
                f"{self.key(what.inner[0], key, line)}: {self.value(what.inner[1], item, line)}"
                for key, item in value.items
            )
            return f"{{{', '.join(items)}}}"
        if not isinstance(value, list):
            if isinstance(value, Pairs) and not value.items:
                value = []
            else:
                raise self._misfit(f"a {what.name}", value, line)
        write = self.value if what.name == "list" else self.key
        inner = ", ".join(write(what.inner[0], item, line) for item in value)
        return f"[{inner}]" if what.name == "list" else f"{{{inner}}}" if inner else "set()"

    def key(self, type_: TypeText, value: Any, line: int) -> str:
        """A value that can be a key of a dict, or in a set."""
        found = self.value(type_, value, line)
        _, what = self.interface.resolve(type_)
        return f"{self.thrift}.frozen({found})" if isinstance(what, TypeText) else found

    def record(self, type_: TypeText, struct: StructText, value: Any, line: int) -> str:
        if not isinstance(value, Pairs):
            raise self._misfit(struct.name, value, line)
        where, _ = self.interface.resolve(type_)
        fields = {field.name: field for field in struct.fields}
        arguments = []
        for key, item in value.items:
            if not isinstance(key, str) or key not in fields:
                raise self.interface.wrong(line, f"{struct.name} has no field {key!r}")
            text = self.value(self.seen(fields[key].type, where), item, line)
            arguments.append(f"{attribute(key, taken(struct))}={text}")
        return f"{self.mention(type_.name, line).strip(chr(34))}({', '.join(arguments)})"

    def seen(self, type_: TypeText, where: Interface) -> TypeText:
        """A type of another file as it is called here."""
        if where is self.interface:
            return type_
        inner = tuple(self.seen(each, where) for each in type_.inner)
        name = type_.name
        if name not in BASE and not inner:
            name = f"{self._prefix(where)}.{name}"
        return replace(type_, name=name, inner=inner)

    def _prefix(self, wanted: Interface) -> str:
        """Return the names by which an included file is reached, also over others."""
        if not self._prefixes:
            ways = [*self.interface.includes.items()]
            for prefix, other in ways:  # grows; each file is looked at once
                if id(other) not in self._prefixes:
                    self._prefixes[id(other)] = prefix
                    ways += [(f"{prefix}.{inner}", each) for inner, each in other.includes.items()]
        return self._prefixes[id(wanted)]

    def members_of(self, enum: EnumText) -> tuple[dict[int, str], dict[str, int]]:
        """Its names by their numbers, the first of several, and its numbers by their names."""
        found = self._enums.get(id(enum))
        if found is None:
            numbers = {each.number: each.name for each in reversed(enum.values)}
            found = self._enums[id(enum)] = numbers, {e.name: e.number for e in enum.values}
        return found

    def named(self, type_: TypeText, what: Any, value: Name) -> str:
        line = value.line
        if value.text in ("true", "false") and isinstance(what, Scalar):
            return self.literal(what, value.text == "true", line)
        head, _, last = value.text.rpartition(".")
        if isinstance(what, EnumText):
            member = last if head else value.text
            if member not in self.members_of(what)[1]:
                names = ", ".join([each.name for each in what.values[:_SHOWN]])
                names += ", ..." if len(what.values) > _SHOWN else ""
                raise self.interface.wrong(line, f"{what.name} is one of {names}, not {value.text}")
            name = self.mention(type_.name, line).strip('"')
            return f"{name}.{attribute(member, ENUM)}"
        try:
            where, found = self.interface.find(value.text, line, "constant")
        except DecodeError:
            if head:
                where, found = self.interface.find(head, line, "constant")
                if isinstance(found, EnumText) and isinstance(what, Scalar):
                    number = self.members_of(found)[1].get(last)
                    if number is not None:
                        return self.literal(what, number, line)
            raise
        if not isinstance(found, ConstText):
            raise self.interface.wrong(line, f'"{value.text}" is no constant')
        prefix = "" if where is self.interface else value.text.partition(".")[0] + "."
        if not prefix and value.text not in self.known:
            raise self.interface.wrong(line, f'the constant "{value.text}" comes later')
        return prefix + attribute(found.name, TYPES)

    def literal(self, kind: Scalar, value: Any, line: int) -> str:
        if kind is BOOL:
            if isinstance(value, int) and value in (0, 1):
                return repr(bool(value))
        elif kind is TEXT or kind is kinds.VOCAB:
            if isinstance(value, str):
                return quoted(value)
            if kind is kinds.VOCAB and isinstance(value, int):
                self.uses.add("yarpy")
                return f"{self.yarpy}.Vocab.from_code({value})"
        elif kind is BINARY:
            if isinstance(value, str):
                return "b" + _double(repr(value.encode())[1:])
        elif kind.letter in "fd":
            if isinstance(value, (int, float)) and not isinstance(value, bool):
                if not isfinite(value):
                    raise self.interface.wrong(line, f"the number does not fit in {kind}")
                return repr(float(value))
        elif isinstance(value, int) and not isinstance(value, bool):
            self.fit(kind, value, line, str(value))
            return repr(value)
        raise self._misfit(str(kind), value, line)

    def fit(self, kind: Scalar, number: int, line: int, what: str) -> None:
        if kind is kinds.VOCAB:
            kind = kinds.I32
        bits = 8 * size_of(kind)
        low, high = -(1 << (bits - 1)), 1 << (bits - 1)
        if kind.letter.isupper():
            low, high = 0, 1 << bits
        if not low <= number < high:
            shown = what if what == str(number) else f"{what} ({number})"
            raise self.interface.wrong(line, f"{shown} does not fit in {kind}")

    def _misfit(self, wanted: str, value: Any, line: int) -> DecodeError:
        shown = {Pairs: "a map", list: "a list"}.get(type(value)) or f"{value!r:.40}"
        return self.interface.wrong(line, f"expected a value for {wanted}, found {shown}")


def quoted(text: str) -> str:
    """A string literal, in double quotes where that is as simple."""
    return _double(repr(text))


def _double(literal: str) -> str:
    return f'"{literal[1:-1]}"' if literal[0] == "'" and '"' not in literal else literal
