"""Values of kinds to the bytes of a protocol.

Rules: TypeError and OverflowError begin with the path, as those of `wire/writer.py`. A
field that is None is left out, unless it is required. Unsigned types and vocabs go as the signed
numbers of the same bits, an enum as an i32, sets and maps in sorted order where there is one.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from struct import Struct as Packing
from struct import error as struct_error
from typing import Any, Final, TypeAlias

from yarpy.data.embedded import with_article
from yarpy.kits.thrift.apache.binary import BinaryWriter
from yarpy.kits.thrift.apache.compact import CompactWriter
from yarpy.kits.thrift.apache.protocol import BOOL, sort_of
from yarpy.kits.thrift.kind import BINARY as BYTES
from yarpy.kits.thrift.kind import BOOL as TRUTH
from yarpy.kits.thrift.kind import (
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
from yarpy.kits.thrift.wire.writer import (
    blob,
    numbers,
    payload,
    shown,
    sized,
    sorted_items,
    truth,
    word,
)
from yarpy.limit import THRIFT_LEVELS

Writer: TypeAlias = BinaryWriter | CompactWriter

WRITERS: Final[dict[str, type[Writer]]] = {"binary": BinaryWriter, "compact": CompactWriter}

#: what unsigned numbers are sent as
_SIGNED: Final = {letter: letter.lower() for letter in "bBhHiIqQ"}
_METHODS: Final = {"b": "i8", "h": "i16", "i": "i32", "q": "i64"}


def fields(writer: Writer, items: Iterable[tuple[int, Kind, Any, str]], depth: int = 0) -> None:
    """Write a struct of these fields: number, kind, value and path; None is no field. TypeError,
    OverflowError."""
    writer.begin()
    for number, kind, value, path in items:
        if value is None:
            continue
        sort = sort_of(kind)
        if sort == BOOL:
            writer.truth_field(truth(value, path), number)
        else:
            writer.field(sort, number)
            put(writer, kind, value, path, depth)
    writer.stop()


def put(writer: Writer, kind: Kind, value: Any, path: str, depth: int = 0) -> None:
    """Write a value. TypeError, OverflowError."""
    if isinstance(kind, Scalar):
        _put_scalar(writer, kind, value, path)
        return
    if is_enum(kind):
        _put_enum(writer, kind, value, path)
        return
    if depth >= THRIFT_LEVELS:
        raise TypeError(f"{path}: more than {THRIFT_LEVELS} levels of structs and containers")
    if isinstance(kind, ListOf):
        _put_list(writer, kind, value, path, depth + 1)
    elif isinstance(kind, SetOf):
        items = sorted_items(sized(value, path))
        writer.sequence(sort_of(kind.element), len(items))
        for at, item in enumerate(items):
            put(writer, kind.element, item, f"{path}[{at}]", depth + 1)
    elif isinstance(kind, MapOf):
        _put_map(writer, kind, value, path, depth + 1)
    else:
        _put_struct(writer, kind, value, path, depth + 1)


def _put_scalar(writer: Writer, kind: Scalar, value: Any, path: str) -> None:
    if kind is TEXT:
        writer.blob(memoryview(payload(kind, value, path))[4:])
    elif kind is BYTES:
        writer.blob(blob(value, path))
    elif kind is TRUTH:
        writer.truth(truth(value, path))
    elif kind is DOUBLE or kind is FLOAT:
        payload(kind, value, path)  # which says what does not fit
        writer.double(value)
    elif kind is VOCAB:
        writer.i32(word(value, path))
    else:
        letter = _SIGNED[kind.letter]
        (number,) = Packing("<" + letter).unpack(payload(kind, value, path))
        getattr(writer, _METHODS[letter])(number)


def _put_enum(writer: Writer, kind: Any, value: Any, path: str) -> None:
    if isinstance(value, (str, bool)) or not hasattr(value, "__index__"):
        names = ", ".join(kind.__members__)
        raise TypeError(f"{path}: expected {kind.__name__}.NAME ({names}), got {shown(value)}")
    try:
        writer.i32(int(value))
    except (OverflowError, struct_error):
        raise OverflowError(f"{path}: {value!r:.40} does not fit in i32") from None


def _put_list(writer: Writer, kind: ListOf, value: Any, path: str, depth: int) -> None:
    element = kind.element
    if isinstance(element, Scalar) and element.is_number and hasattr(value, "__array_interface__"):
        import numpy as np

        data = np.frombuffer(numbers(element, value, path), "<" + element.letter)
        if element is not FLOAT:
            data = data.view("<" + _SIGNED.get(element.letter, "d"))
        writer.sequence(sort_of(element), len(data))
        if not writer.numbers(data.astype("<f8") if element is FLOAT else data):
            for item in data.tolist():
                getattr(writer, _METHODS[_SIGNED[element.letter]])(item)
        return
    items = sized(value, path)
    writer.sequence(sort_of(element), len(items))
    for at, item in enumerate(items):
        put(writer, element, item, f"{path}[{at}]", depth)


def _put_map(writer: Writer, kind: MapOf, value: Any, path: str, depth: int) -> None:
    if not isinstance(value, Mapping):
        raise TypeError(f"{path}: expected a dict, got {shown(value)}")
    writer.mapping(sort_of(kind.key), sort_of(kind.value), len(value))
    for key in sorted_items(value):
        put(writer, kind.key, key, f"{path}, key {key!r:.40}", depth)
        put(writer, kind.value, value[key], f"{path}[{key!r:.40}]", depth)


def _put_struct(writer: Writer, kind: Any, value: Any, path: str, depth: int) -> None:
    if not isinstance(value, kind):
        raise TypeError(f"{path}: expected {with_article(kind.__name__)}, got {shown(value)}")
    fields(writer, struct_fields(kind, value, path), depth)


def struct_fields(kind: Any, value: Any, path: str) -> list[tuple[int, Kind, Any, str]]:
    """Return the fields of a struct. Raises TypeError if a required one is None, or more than one
    of a union is not."""
    found = []
    for spec in kind._specs():
        item = getattr(value, spec.attribute)
        inner = f"{path}.{spec.name}"
        if item is None and spec.required:
            raise TypeError(f"{inner} is required, and None")
        if item is not None:
            found.append((spec.number, spec.kind, item, inner))
    if kind._sort == "union" and len(found) != 1:
        names = ", ".join(each[3] for each in found) or "none"
        raise TypeError(f"{path}: one field of a union is set, here {names}")
    return found
