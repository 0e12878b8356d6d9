"""The types of ROS messages: what definitions are parsed into and classes are made of.

    Primitive    numbers, strings, blobs; `time` and `duration`
    ListOf       any number of elements, or a fixed one
    Struct       named; it has Fields, and Constants beside them

Rules: values without behaviour. Structs are told apart by identity, since two versions of a type
may have the same name. `size` is in bytes, what a value takes where it is packed. (Thrift has kinds
of its own, `yarpy.kits.thrift.kind`: its structs are classes with vocabs and nested lists.)
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Final, TypeAlias


@dataclass(frozen=True, slots=True)
class Primitive:
    """`name` as numpy calls numbers; `letters` as the struct module does, "" if the size varies.
    `wide`: text that ROS 2 sends in UTF-16."""

    name: str
    letters: str = ""
    size: int = 0
    wide: bool = False

    @property
    def is_number(self) -> bool:
        return len(self.letters) == 1

    def __str__(self) -> str:
        return self.name


PRIMITIVES: Final = {
    primitive.name: primitive
    for primitive in (
        Primitive("bool", "?", 1),
        Primitive("int8", "b", 1),
        Primitive("uint8", "B", 1),
        Primitive("int16", "h", 2),
        Primitive("uint16", "H", 2),
        Primitive("int32", "i", 4),
        Primitive("uint32", "I", 4),
        Primitive("int64", "q", 8),
        Primitive("uint64", "Q", 8),
        Primitive("float32", "f", 4),
        Primitive("float64", "d", 8),
        Primitive("string"),
        Primitive("binary"),
        Primitive("time", "II", 8),
        Primitive("duration", "ii", 8),
    )
} | {"wstring": Primitive("string", wide=True)}


@dataclass(frozen=True, slots=True)
class ListOf:
    """Elements of one type; `length` is None where there may be any number of them, `most` where
    that number is not limited (which ROS 2 alone does)."""

    element: Type
    length: int | None = None
    most: int | None = None

    def __str__(self) -> str:
        within = f"<={self.most}" if self.most is not None else ""
        return f"{self.element}[{within if self.length is None else self.length}]"


@dataclass(frozen=True, slots=True)
class Field:
    """A value with a name. Without a `default` it begins as 0, "", or empty."""

    name: str
    type: Type
    default: Any = None
    doc: str = ""


@dataclass(frozen=True, slots=True)
class Constant:
    name: str
    type: Primitive
    value: Any
    doc: str = ""


@dataclass(eq=False, slots=True)
class Struct:
    """Fields in the order in which they are written."""

    name: str
    fields: tuple[Field, ...]
    constants: tuple[Constant, ...] = ()
    doc: str = ""
    #: the fewest bytes a value takes when packed, and how many values and structs it has then
    smallest: int = field(init=False)
    parts: int = field(init=False)
    #: whether there are arrays of numbers in it, at any depth
    has_arrays: bool = field(init=False)

    def __post_init__(self) -> None:
        self.smallest = sum(smallest(field.type) for field in self.fields)
        self.parts = 1 + sum(parts(field.type) for field in self.fields)
        self.has_arrays = any(has_arrays(field.type) for field in self.fields)

    def __str__(self) -> str:
        return self.name


Type: TypeAlias = Primitive | ListOf | Struct

#: of lists and strings: what says how many follow
_COUNT: Final = 4


def smallest(type_: Type) -> int:
    """The fewest bytes that a value takes."""
    if isinstance(type_, Struct):
        return type_.smallest
    if isinstance(type_, ListOf) and type_.length is not None:
        return type_.length * smallest(type_.element)
    return (type_.size if isinstance(type_, Primitive) else 0) or _COUNT


def parts(type_: Type) -> int:
    """Return how many Python objects the smallest value is; an array of numbers is one."""
    if isinstance(type_, Struct):
        return type_.parts
    if isinstance(type_, ListOf) and type_.length is not None:
        element = type_.element
        packed = isinstance(element, Primitive) and element.is_number
        return 1 if packed else 1 + type_.length * parts(element)
    return 1


def has_arrays(type_: Type) -> bool:
    """Return whether a value holds arrays of numbers, at any depth."""
    if isinstance(type_, Struct):
        return type_.has_arrays
    if isinstance(type_, ListOf):
        element = type_.element
        return has_arrays(element) or (isinstance(element, Primitive) and element.is_number)
    return False
