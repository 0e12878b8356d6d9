"""The bytes of a protocol to values of kinds.

Rules: what is not known is left out, as are fields of another type than theirs: a program with a
newer file may have sent them. Lists of numbers are arrays. DecodeError names the field; what a
message may hold is limited by `source`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final, TypeAlias

from yarpy.data.value import Vocab
from yarpy.errors import DecodeError
from yarpy.kits.thrift.apache.binary import BinaryReader
from yarpy.kits.thrift.apache.compact import CompactReader
from yarpy.kits.thrift.apache.protocol import STOP, sort_of
from yarpy.kits.thrift.key import frozen
from yarpy.kits.thrift.kind import (
    BINARY,
    BOOL,
    DOUBLE,
    FLOAT,
    TEXT,
    VOCAB,
    Kind,
    ListOf,
    MapOf,
    Scalar,
    SetOf,
    is_enum,
)

Reader: TypeAlias = BinaryReader | CompactReader

READERS: Final[dict[str, type[Reader]]] = {"binary": BinaryReader, "compact": CompactReader}

_METHODS: Final = {"b": "i8", "h": "i16", "i": "i32", "q": "i64"}


def fields(reader: Reader, kinds: Mapping[int, Kind], path: str) -> dict[int, Any]:
    """Return the values of the fields of a struct that are among these, by their numbers.
    DecodeError."""
    reader.begin()
    reader.spend(len(kinds))
    found: dict[int, Any] = {}
    while True:
        sort, number = reader.field()
        if sort == STOP:
            return found
        kind = kinds.get(number)
        if kind is None or sort_of(kind) != sort:
            reader.skip(sort)
        else:
            found[number] = get(reader, kind, path)


def get(reader: Reader, kind: Kind, path: str) -> Any:
    """Return the value that comes next. DecodeError."""
    if isinstance(kind, Scalar):
        return _scalar(reader, kind)
    if isinstance(kind, ListOf):
        return _list(reader, kind, path)
    if isinstance(kind, SetOf):
        return {frozen(item) for item in _items(reader, kind.element, path)}
    if isinstance(kind, MapOf):
        return _map(reader, kind, path)
    if is_enum(kind):
        number = reader.i32()
        return kind._value2member_map_.get(number, number)  # type: ignore[union-attr]
    return struct(reader, kind, path)


def struct(reader: Reader, kind: Any, path: str) -> Any:
    """Return the struct that comes next. DecodeError."""
    specs = kind._specs()
    kinds = {spec.number: spec.kind for spec in specs}
    found = fields(reader, kinds, f"{path}.{kind.__name__}" if path else kind.__name__)
    made = kind.__new__(kind)
    for spec in specs:
        if spec.number in found:
            value = found[spec.number]
        elif spec.required:
            raise DecodeError(f"{path or kind.__name__}: {spec.name} is required, and not there")
        else:
            value = spec.default()
        setattr(made, spec.attribute, value)
    return made


def _scalar(reader: Reader, kind: Scalar) -> Any:
    if kind is TEXT:
        return str(reader.blob(), "utf-8", "surrogateescape")
    if kind is BINARY:
        return bytes(reader.blob())
    if kind is BOOL:
        return reader.truth()
    if kind is DOUBLE or kind is FLOAT:
        return reader.double()
    letter = kind.letter.lower()
    number = getattr(reader, _METHODS[letter])()
    if kind is VOCAB:
        return Vocab.from_code(number)
    if number < 0 and kind.letter != letter:
        return number + (1 << {"b": 8, "h": 16, "i": 32, "q": 64}[letter])
    return number


def _items(reader: Reader, element: Kind, path: str) -> list[Any]:
    reader.enter()
    sort, count = reader.sequence()
    if count and sort != sort_of(element):
        raise DecodeError(f"{path}: a container of other elements (type {sort})")
    reader.spend(count)
    found = [get(reader, element, path) for _ in range(count)]
    reader.leave()
    return found


def _list(reader: Reader, kind: ListOf, path: str) -> Any:
    element = kind.element
    if not isinstance(element, Scalar) or not (element.is_number or element is BOOL):
        return _items(reader, element, path)
    import numpy as np

    reader.enter()
    sort, count = reader.sequence()
    if count and sort != sort_of(element):
        raise DecodeError(f"{path}: a list of other elements (type {sort})")
    letter = "?" if element is BOOL else "d" if element is FLOAT else element.letter
    found = reader.array(letter.lower(), count)
    reader.leave()
    if element is FLOAT:
        with np.errstate(over="ignore"):
            return found.astype("<f4")
    return found if letter == letter.lower() else found.view("<" + letter)


def _map(reader: Reader, kind: MapOf, path: str) -> dict[Any, Any]:
    reader.enter()
    key, value, count = reader.mapping()
    if count and (key != sort_of(kind.key) or value != sort_of(kind.value)):
        raise DecodeError(f"{path}: a map of other keys or values (types {key} and {value})")
    reader.spend(2 * count)
    found: dict[Any, Any] = {}
    for _ in range(count):
        name = frozen(get(reader, kind.key, path))
        found[name] = get(reader, kind.value, path)
    reader.leave()
    return found
