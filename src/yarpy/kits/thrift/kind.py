"""Kinds of values: their form on the wire of Thrift, and their names in Python.

    Scalar                 numbers, words, strings, blobs: one element of a Bottle
    ListOf, SetOf, MapOf   one element, too
    External               a type that C++ serialises by itself: yarp::sig::Vector, a `yarpy.Vector`
    a Struct, an Enum      their Python classes

    thrift.i32, thrift.Float64s ...    annotations: Python's type for people, the kind for the wire

Rules: a struct takes as many elements as its fields do (`flat`), for it is spliced in where it
stands. `float`, `str`, `bool` and `bytes` are double, string, bool and binary; a plain `int` is an
i32. (Wire of YARP 3.7 to 3.12.)
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from struct import calcsize
from types import UnionType
from typing import (
    TYPE_CHECKING,
    Annotated,
    Any,
    Final,
    TypeAlias,
    TypeVar,
    Union,
    get_args,
    get_origin,
)

from yarpy.data.value import (
    BLOB,
    FLOAT32,
    FLOAT64,
    INT8,
    INT16,
    INT32,
    INT64,
    STRING,
    VOCAB32,
    Vocab,
)

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Scalar:
    """`code` is the tag of an element, `letter` what the struct module calls its payload, "" where
    the length varies."""

    name: str
    code: int
    letter: str = ""

    @property
    def is_number(self) -> bool:
        """True if lists of it are arrays."""
        return bool(self.letter) and self.code != VOCAB32

    def __str__(self) -> str:
        return self.name


@dataclass(frozen=True, slots=True)
class ListOf:
    element: Kind

    def __str__(self) -> str:
        return f"list<{name_of(self.element)}>"


@dataclass(frozen=True, slots=True)
class SetOf:
    element: Kind

    def __str__(self) -> str:
        return f"set<{name_of(self.element)}>"


@dataclass(frozen=True, slots=True)
class MapOf:
    key: Kind
    value: Kind

    def __str__(self) -> str:
        return f"map<{name_of(self.key)}, {name_of(self.value)}>"


@dataclass(frozen=True, slots=True)
class External:
    """A type that writes itself. `size`: elements that it takes; `python`: where its class is."""

    name: str
    size: int = 1
    python: str = ""

    def __str__(self) -> str:
        return self.name


@dataclass(frozen=True, slots=True)
class _Nested:
    """A mark: this struct is a list of its own where it stands."""


NESTED: Final = _Nested()

#: the last is the class of a Struct or of an Enum
Kind: TypeAlias = Scalar | ListOf | SetOf | MapOf | External | type[Any]


@dataclass(frozen=True, slots=True)
class Part:
    """A value in a row of them: an argument, a result, the struct that is the whole message."""

    name: str
    kind: Kind
    nested: bool = False


BOOL: Final = Scalar("bool", VOCAB32, "?")
I8: Final = Scalar("i8", INT8, "b")
I16: Final = Scalar("i16", INT16, "h")
I32: Final = Scalar("i32", INT32, "i")
I64: Final = Scalar("i64", INT64, "q")
UI8: Final = Scalar("ui8", INT8, "B")
UI16: Final = Scalar("ui16", INT16, "H")
UI32: Final = Scalar("ui32", INT32, "I")
UI64: Final = Scalar("ui64", INT64, "Q")
SIZE: Final = Scalar("size_t", INT32, "i")
VOCAB: Final = Scalar("vocab", VOCAB32, "i")
FLOAT: Final = Scalar("float32", FLOAT32, "f")
DOUBLE: Final = Scalar("double", FLOAT64, "d")
TEXT: Final = Scalar("string", STRING)
BINARY: Final = Scalar("binary", BLOB)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    i8: TypeAlias = int
    i16: TypeAlias = int
    i32: TypeAlias = int
    i64: TypeAlias = int
    ui8: TypeAlias = int
    ui16: TypeAlias = int
    ui32: TypeAlias = int
    ui64: TypeAlias = int
    size_t: TypeAlias = int
    vocab: TypeAlias = str
    float32: TypeAlias = float
    Bools: TypeAlias = NDArray[np.bool_]
    Int8s: TypeAlias = NDArray[np.int8]
    Int16s: TypeAlias = NDArray[np.int16]
    Int32s: TypeAlias = NDArray[np.int32]
    Int64s: TypeAlias = NDArray[np.int64]
    UInt8s: TypeAlias = NDArray[np.uint8]
    UInt16s: TypeAlias = NDArray[np.uint16]
    UInt32s: TypeAlias = NDArray[np.uint32]
    UInt64s: TypeAlias = NDArray[np.uint64]
    Float32s: TypeAlias = NDArray[np.float32]
    Float64s: TypeAlias = NDArray[np.float64]
else:
    i8 = Annotated[int, I8]
    i16 = Annotated[int, I16]
    i32 = Annotated[int, I32]
    i64 = Annotated[int, I64]
    ui8 = Annotated[int, UI8]
    ui16 = Annotated[int, UI16]
    ui32 = Annotated[int, UI32]
    ui64 = Annotated[int, UI64]
    size_t = Annotated[int, SIZE]
    vocab = Annotated[str, VOCAB]
    float32 = Annotated[float, FLOAT]
    Bools = Annotated[list, ListOf(BOOL)]
    Int8s = Annotated[list, ListOf(I8)]
    Int16s = Annotated[list, ListOf(I16)]
    Int32s = Annotated[list, ListOf(I32)]
    Int64s = Annotated[list, ListOf(I64)]
    UInt8s = Annotated[list, ListOf(UI8)]
    UInt16s = Annotated[list, ListOf(UI16)]
    UInt32s = Annotated[list, ListOf(UI32)]
    UInt64s = Annotated[list, ListOf(UI64)]
    Float32s = Annotated[list, ListOf(FLOAT)]
    Float64s = Annotated[list, ListOf(DOUBLE)]

#: a struct that is a list of its own, whether a field or an argument
Nested: TypeAlias = Annotated[T, NESTED]

#: what a list of numbers is called as an annotation
ARRAYS: Final = {
    BOOL: "Bools",
    FLOAT: "Float32s",
    DOUBLE: "Float64s",
    SIZE: "Int32s",
    I8: "Int8s",
    I16: "Int16s",
    I32: "Int32s",
    I64: "Int64s",
    UI8: "UInt8s",
    UI16: "UInt16s",
    UI32: "UInt32s",
    UI64: "UInt64s",
}

_PLAIN: Final[dict[Any, Kind]] = {
    bool: BOOL, int: I32, float: DOUBLE, str: TEXT, bytes: BINARY, Vocab: VOCAB,
}  # fmt: skip


def kind_of(annotation: Any, names: Mapping[str, Any]) -> tuple[Kind, bool]:
    """The kind of an annotation, and whether it is marked as nested. `names` are those that a
    string may mention. TypeError for what Thrift has no type for."""
    while isinstance(annotation, str):
        annotation = eval(annotation, dict(names))  # text of the module itself
    nested = False
    while get_origin(annotation) is Annotated:
        annotation, *marks = get_args(annotation)
        nested = nested or NESTED in marks
        for mark in marks:
            if isinstance(mark, (Scalar, ListOf, SetOf, MapOf, External)):
                return mark, nested
    if isinstance(annotation, type) and hasattr(annotation, "_thrift"):
        return annotation, nested
    found = _PLAIN.get(annotation)
    if found is not None:
        return found, nested
    origin, inner = get_origin(annotation), get_args(annotation)
    if origin in (list, set, dict) and inner:
        kinds = [kind_of(each, names)[0] for each in inner]
        return {list: ListOf, set: SetOf, dict: MapOf}[origin](*kinds), nested
    raise TypeError(
        f"{annotation!r} is no type of Thrift: use int, float, str, bool, bytes, those of "
        "yarpy.kits.thrift, list[...], set[...], dict[...], or a class made from Struct or Enum"
    )


def without_none(annotation: Any, names: Mapping[str, Any]) -> tuple[Any, bool]:
    """An annotation without its `| None`, and whether it had one. `names` as of `kind_of`."""
    while isinstance(annotation, str):
        annotation = eval(annotation, dict(names))  # text of the module itself
    if get_origin(annotation) in (Union, UnionType):
        inner = [each for each in get_args(annotation) if each is not type(None)]
        if len(inner) == 1:
            return inner[0], True
    return annotation, False


def namespace_of(owner: Any) -> Mapping[str, Any]:
    """The names that annotations of a class or function may mention."""
    module = sys.modules.get(owner.__module__)
    return getattr(owner, "_namespace", None) or (vars(module) if module is not None else {})


def is_struct(kind: Kind) -> bool:
    return isinstance(kind, type) and kind._thrift == "struct"


def is_enum(kind: Kind) -> bool:
    return isinstance(kind, type) and kind._thrift == "enum"


def flat(kind: Kind) -> int:
    """Return how many elements of a Bottle a value takes that is not in a list of its own."""
    if is_struct(kind):
        found: int = kind._flat()  # type: ignore[union-attr]
        return found
    return kind.size if isinstance(kind, External) else 1


def within(kinds: Iterable[Kind]) -> Iterator[Kind]:
    """These kinds, and all that are in them."""
    known: set[Any] = set()
    waiting = [*kinds]
    while waiting:
        kind = waiting.pop()
        yield kind
        if isinstance(kind, (ListOf, SetOf)):
            waiting.append(kind.element)
        elif isinstance(kind, MapOf):
            waiting += (kind.key, kind.value)
        elif is_struct(kind) and kind not in known:
            known.add(kind)
            waiting += [field.kind for field in kind._specs()]  # type: ignore[union-attr]


def has_sets(kinds: Iterable[Kind]) -> bool:
    """Return whether there are sets among the kinds, which C++ writes wrong."""
    return any(isinstance(kind, SetOf) for kind in within(kinds))


def has_floats(kinds: Iterable[Kind]) -> bool:
    """Return whether there are fractions among the kinds, which YARP 4.0 writes otherwise than
    3.x."""
    return any(kind in (FLOAT, DOUBLE) or isinstance(kind, External) for kind in within(kinds))


def has_narrow(kinds: Iterable[Kind]) -> bool:
    """Return whether there is a float32 among the kinds, whose tag in YARP 4.0 is that of a float64
    in 3.x."""
    return FLOAT in within(kinds)


def list_code(element: Kind) -> int:
    """Return what is added to 256 in the header of a list; 0 where each element has its own tag.

    A list of lists has the code of the elements within, which is no Bottle, but what C++ does.
    """
    if isinstance(element, Scalar):
        return element.code
    if is_enum(element):
        base: Scalar = element._base  # type: ignore[union-attr]
        return INT32 if base is VOCAB else base.code
    if isinstance(element, (ListOf, SetOf)):
        return list_code(element.element)
    return 0


def name_of(kind: Kind) -> str:
    """Return the name of a kind in errors."""
    return kind.__name__ if isinstance(kind, type) else str(kind)


def size_of(kind: Scalar) -> int:
    """The bytes of a number without its tag."""
    return calcsize("<" + kind.letter)
