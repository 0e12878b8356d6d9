"""Interface: a `.thrift` file with those it includes, and the types that its names stand for.

Rules: a name that is not there is a DecodeError that says file and line, and the nearest name. The
rules of a file are in `check.py`; `include.py` reads it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import Final, TypeAlias

from yarpy.errors import DecodeError
from yarpy.kits.thrift import kind as kinds
from yarpy.kits.thrift.file.document import (
    Declaration,
    Document,
    EnumText,
    StructText,
    TypedefText,
    TypeText,
)
from yarpy.kits.thrift.kind import BINARY, BOOL, DOUBLE, TEXT, External, Scalar
from yarpy.kits.thrift.word import MODULES, PYTHON, attribute

BASE: Final = {
    "bool": BOOL, "byte": kinds.I8, "i8": kinds.I8, "i16": kinds.I16, "i32": kinds.I32,
    "i64": kinds.I64, "double": DOUBLE, "string": TEXT, "binary": BINARY,
}  # fmt: skip
CONTAINERS: Final = ("list", "set", "map")

#: types of C++ that yarpy has, too
NATIVE: Final = {
    "yarp::os::Bottle": "yarpy.Bottle",
    "yarp::os::Property": "yarpy.Property",
    "yarp::os::Stamp": "yarpy.Stamp",
    "yarp::sig::Vector": "yarpy.Vector",
    "yarp::sig::VectorOf<double>": "yarpy.Vector",
    "yarp::sig::VectorOf<int>": "yarpy.Vector",
    "yarp::sig::Matrix": "yarpy.Matrix",
}

_COMPARED: Final = 300  # names, in search of the nearest

Resolved: TypeAlias = TypeText | StructText | EnumText | Scalar


@dataclass(eq=False)
class Interface:
    """A file: what it declares by name, and the interfaces that it includes by prefix."""

    document: Document
    path: Path | None
    includes: dict[str, Interface]
    names: dict[str, Declaration] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """The name of the file without its suffix, by which others mention it."""
        return Path(self.document.file).stem

    @property
    def module_name(self) -> str:
        """The name of a Python module of it. DecodeError if there can be none."""
        if not self.name.isidentifier() or self.name in PYTHON:
            raise DecodeError(f"{self.document.file}: no module is called {self.name}: rename it")
        return attribute(self.name, MODULES)

    def all(self) -> list[Interface]:
        """Return the interfaces that it includes, over others too, and itself as the last."""
        found: dict[int, Interface] = {}
        self._gather(found)
        return [*found.values()]

    def _gather(self, found: dict[int, Interface]) -> None:
        for other in self.includes.values():
            if id(other) not in found:
                other._gather(found)
        found[id(self)] = self

    def wrong(self, line: int, why: str) -> DecodeError:
        return DecodeError(f"{self.document.file}:{line}: {why}")

    def find(self, name: str, line: int, what: str = "type") -> tuple[Interface, Declaration]:
        """The declaration of a name, and the file that it is in. DecodeError."""
        where, rest = self, name
        while rest not in where.names:
            prefix, dot, rest = rest.partition(".")
            inside = where.includes.get(prefix) if dot else None
            if inside is None:
                break
            where = inside
        else:
            return where, where.names[rest]
        inner = (f"{p}.{n}" for p, other in self.includes.items() for n in other.names)
        known = [*self.names, *inner, *(BASE if what == "type" else ())]
        near = get_close_matches(name[:100], known[:_COMPARED], n=1)
        hint = f': did you mean "{near[0]}"?' if near else ""
        raise self.wrong(line, f'no {what} "{name}"{hint}')

    def resolve(self, type_: TypeText) -> tuple[Interface, Resolved]:
        """Return the type behind all typedefs, a Scalar, a struct, an enum or a container, and
        its file."""
        where: Interface = self
        for _ in range(100):
            if type_.name in CONTAINERS:
                return where, type_
            if type_.name in BASE:
                return where, where._scalar(type_)
            where, found = where.find(type_.name, type_.line)
            if isinstance(found, (StructText, EnumText)):
                return where, found
            if not isinstance(found, TypedefText):
                raise self.wrong(type_.line, f'"{type_.name}" is no type')
            type_ = found.type
        raise self.wrong(type_.line, f'"{type_.name}" is defined by itself')

    def _scalar(self, type_: TypeText) -> Scalar:
        base = BASE[type_.name]
        given = type_.annotations.get("yarp.type", "")
        if not given:
            return base
        found = _native_scalar(base, given)
        if found is None:
            raise self.wrong(type_.line, f'"{given}" is not a type that {base} can be')
        return found


_UNSIGNED: Final = {
    kinds.I8: kinds.UI8, kinds.I16: kinds.UI16, kinds.I32: kinds.UI32, kinds.I64: kinds.UI64,
}  # fmt: skip


def _native_scalar(base: Scalar, given: str) -> Scalar | None:
    short = given.rpartition("::")[2].strip()
    if base is DOUBLE:
        return {"float32_t": kinds.FLOAT, "float": kinds.FLOAT}.get(short, DOUBLE)
    if base is kinds.I32 and short == "vocab32_t":
        return kinds.VOCAB
    if base is kinds.I32 and short == "size_t":
        return kinds.SIZE
    if "unsigned" in given or short.startswith("uint"):
        return _UNSIGNED.get(base)
    return base


def external(struct: StructText) -> External | None:
    """The type that C++ has for a struct with `yarp.name`."""
    name = struct.annotations.get("yarp.name") or struct.annotations.get("cpp.name")
    if not name:
        return None
    size = struct.annotations.get("yarp.bottlesize", "1")
    count = int(size) if size.isascii() and size.isdigit() and len(size) < 5 else 1
    return External(name, max(count, 1), NATIVE.get(name.strip(), ""))


def enum_base(interface: Interface, enum: EnumText) -> Scalar:
    """Return the type of an enum on the wire."""
    given = enum.annotations.get("yarp.enumbase", "int").rpartition("::")[2].strip()
    bases = {
        **dict.fromkeys(("int8_t", "int8", "char"), kinds.I8),
        **dict.fromkeys(("uint8_t", "uint8", "unsigned char"), kinds.UI8),
        **dict.fromkeys(("int16_t", "int16", "short"), kinds.I16),
        **dict.fromkeys(("uint16_t", "uint16", "unsigned short"), kinds.UI16),
        **dict.fromkeys(("int32_t", "int32", "int"), kinds.I32),
        **dict.fromkeys(("uint32_t", "uint32"), kinds.UI32),
        **dict.fromkeys(("int64_t", "int64", "unsigned int"), kinds.I64),
        **dict.fromkeys(("uint64_t", "uint64"), kinds.UI64),
        **dict.fromkeys(("vocab32_t",), kinds.VOCAB),
    }
    if given not in bases:
        raise interface.wrong(enum.line, f'"{given}" is no type of integers for an enum')
    return bases[given]
