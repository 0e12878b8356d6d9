"""Bytes to values, one after the other: all that a peer may send, and the error for the rest.

    bool           vocab or int32: false are 0 and [fail]     i64, float     any integer; any number
    i8 i16 i32     any integer that fits; i32 a vocab too     enum           number, or exact name
    string         string or vocab                            binary         blob or string
    list           plain or specialised, whatever its elements are

Rules: this accepts what C++ accepts and more: plain lists, integers beside fractions, names of
enums. Numbers that do not fit are refused, where C++ cuts them. Sets come as C++ writes them, with
a tag too many at each element, if they are wrong otherwise. A message of YARP 4.0 has other tags
for floats (`yarpy.data.yarp4`), which a Cursor translates. Counts are checked against the bytes
that are there before memory is taken; only DecodeError and Truncated come out, which name the
field.
"""

from __future__ import annotations

from importlib import import_module
from struct import Struct as Packing
from typing import Any, Final

from yarpy.data import codec
from yarpy.data.value import (
    BLOB,
    FIXED,
    FLOAT32,
    FLOAT64,
    GROUP_MASK,
    INT8,
    INT16,
    INT32,
    INT64,
    LIST,
    STRING,
    UNIT_MASK,
    VOCAB32,
    Float32,
    Vocab,
)
from yarpy.data.walker import sound_size
from yarpy.data.yarp4 import to_yarp3
from yarpy.errors import DecodeError
from yarpy.kits.thrift.kind import (
    BINARY,
    BOOL,
    FLOAT,
    SIZE,
    TEXT,
    VOCAB,
    External,
    Kind,
    ListOf,
    MapOf,
    Scalar,
    SetOf,
    flat,
    is_enum,
    name_of,
)
from yarpy.kits.thrift.wire.cursor import Cursor, bytes_of, number_of, other_kind, reads_list, skip
from yarpy.kits.thrift.wire.writer import FAIL

_I32: Final = Packing("<i").unpack_from
_PACK_PAIR: Final = Packing("<ii").pack

#: how a Sound of YARP 3.9 begins, which is no Bottle
_RAW_SOUND: Final = Packing("<iii").pack(LIST, 4, 0)

_INTEGERS: Final = frozenset((INT8, INT16, INT32, INT64))


def get(kind: Kind, cursor: Cursor, path: str, nested: bool = False) -> Any:
    """The value of a kind that begins at the cursor. DecodeError, Truncated."""
    if nested and isinstance(kind, type) and not is_enum(kind):
        return _nested(kind, cursor, path, None)
    return _value(kind, cursor, path, None)


def _value(kind: Kind, cursor: Cursor, path: str, code: int | None) -> Any:
    """`code`: the tag, where it stands in the header of the list."""
    if isinstance(kind, type) and not is_enum(kind):
        return _struct(kind, cursor, path, code)
    if isinstance(kind, External):
        return _external(kind, cursor, path, code)
    tag = cursor.tag(path) if code is None else code
    if isinstance(kind, Scalar):
        return scalar(kind, tag, cursor, path)
    if isinstance(kind, (ListOf, SetOf)):
        return _list(kind, tag, cursor, path)
    if isinstance(kind, MapOf):
        return _map(kind, tag, cursor, path)
    return _enum(kind, tag, cursor, path)


def _struct(kind: Any, cursor: Cursor, path: str, code: int | None) -> Any:
    made = kind.__new__(kind)
    for field in kind._specs():
        inner = f"{path}.{field.name}"
        if field.nested:
            value = _nested(field.kind, cursor, inner, code)
        else:
            value = _value(field.kind, cursor, inner, code)
        setattr(made, field.attribute, value)
    return made


def _nested(kind: Any, cursor: Cursor, path: str, code: int | None) -> Any:
    """A struct that is a list of its own; anything else as it is."""
    if not isinstance(kind, type) or is_enum(kind):
        return _value(kind, cursor, path, code)
    tag = cursor.tag(path) if code is None else code
    if not tag & LIST:
        raise other_kind(f"a list for {name_of(kind)}", tag, cursor, path)
    cursor.enter(path)
    count = cursor.count(path, 1)
    wanted = flat(kind)
    if count != wanted:
        raise DecodeError(f"{path}: {kind.__name__} has {wanted} elements, here are {count}")
    found = _struct(kind, cursor, path, tag & UNIT_MASK or None)
    cursor.depth -= 1
    return found


def _list(kind: ListOf | SetOf, tag: int, cursor: Cursor, path: str) -> Any:
    if not tag & LIST:
        raise other_kind("a list", tag, cursor, path)
    element, code = kind.element, tag & UNIT_MASK
    is_numbers = isinstance(element, Scalar) and element.is_number and code == element.code
    if isinstance(element, Scalar) and is_numbers and isinstance(kind, ListOf):
        return _array(element, cursor, path)
    cursor.enter(path)
    tagged = cursor.tagged_sets and isinstance(kind, SetOf)
    fixed = None if not code or tagged or isinstance(element, (ListOf, SetOf)) else code
    least = FIXED[code][1] if fixed in FIXED else 4
    count = cursor.count(path, max(least, 1))
    items = [_nested(element, cursor, f"{path}[{at}]", fixed) for at in range(count)]
    cursor.depth -= 1
    if isinstance(kind, SetOf):
        try:
            return set(items)
        except TypeError:
            return items  # structs, which have no hash
    if isinstance(element, Scalar) and (element.is_number or element is BOOL):
        import numpy as np

        return np.array(items, "?" if element is BOOL else "<" + element.letter)
    return items


def _array(element: Scalar, cursor: Cursor, path: str) -> Any:
    import numpy as np

    size = Packing("<" + element.letter).size
    count = cursor.number(path)
    data = cursor.take(count * size, path)
    return np.frombuffer(data, "<" + element.letter, count)


def _map(kind: MapOf, tag: int, cursor: Cursor, path: str) -> dict[Any, Any]:
    if not tag & LIST:
        raise other_kind("a list of pairs", tag, cursor, path)
    cursor.enter(path)
    found: dict[Any, Any] = {}
    outer = tag & UNIT_MASK
    for at in range(cursor.count(path, FIXED[outer][1] if outer in FIXED else 4)):
        pair = outer or cursor.tag(path)
        if not pair & LIST:
            raise other_kind("a pair of key and value", pair, cursor, f"{path}[{at}]")
        cursor.number(path)  # two, and not checked by C++ either
        code = pair & UNIT_MASK or None
        key = _value(kind.key, cursor, f"{path}, key {at}", code)
        try:
            hash(key)
        except TypeError:
            raise DecodeError(f"{path}: {name_of(kind.key)} cannot be a key in Python") from None
        found[key] = _nested(kind.value, cursor, f"{path}[{key!r:.40}]", code)
    cursor.depth -= 1
    return found


# ---------------------------------------------------------------------------------- single values


def scalar(kind: Scalar, tag: int, cursor: Cursor, path: str) -> Any:
    """A number, word, string or blob behind its tag."""
    if kind is TEXT:
        if tag == STRING:
            return str(bytes_of(cursor, path), "utf-8", "surrogateescape")
        if tag == VOCAB32:
            return str.__str__(Vocab.from_code(cursor.number(path)))
        raise other_kind("a string", tag, cursor, path)
    if kind is BINARY:
        if tag in (BLOB, STRING):
            return bytes(bytes_of(cursor, path))
        raise other_kind("a blob", tag, cursor, path)
    if kind is BOOL:
        if tag in (INT32, VOCAB32):
            return cursor.number(path) not in (0, FAIL)
        raise other_kind("true or false", tag, cursor, path)
    if kind is VOCAB:
        if tag == VOCAB32:
            return Vocab.from_code(cursor.number(path))
        if tag == STRING:
            text = bytes(bytes_of(cursor, path))
            if len(text) <= 4:
                return Vocab(text.decode("utf-8", "surrogateescape"))
            raise DecodeError(f"{path}: expected a word of four bytes at most, got {text[:40]!r}")
        raise other_kind("a word", tag, cursor, path)
    if kind.letter in "fd":
        if tag in _INTEGERS or tag in (FLOAT32, FLOAT64):
            number = float(number_of(tag, cursor, path))
            return float(Float32(number)) if kind is FLOAT and tag != FLOAT32 else number
        raise other_kind("a number", tag, cursor, path)
    if tag in _INTEGERS or (tag == VOCAB32 and kind.code == INT32 and kind is not SIZE):
        return _fitting(kind, number_of(tag, cursor, path), path)
    raise other_kind(f"an integer ({kind})", tag, cursor, path)


def _fitting(kind: Scalar, number: int, path: str) -> int:
    bits = 8 * Packing("<" + kind.letter).size
    if kind.letter.isupper():
        if -(1 << (bits - 1)) <= number < 1 << bits:
            return number % (1 << bits)
    elif (0 if kind is SIZE else -(1 << (bits - 1))) <= number < 1 << (bits - 1):
        return number
    raise DecodeError(f"{path}: {number} does not fit in {kind}")


def _enum(kind: Any, tag: int, cursor: Cursor, path: str) -> Any:
    if tag == STRING:
        name = str(bytes_of(cursor, path), "utf-8", "replace")
        try:
            return kind[name]
        except KeyError:
            names = ", ".join(kind.__members__)
            raise DecodeError(f"{path}: {kind.__name__} is one of {names}, not {name!r}") from None
    if tag not in _INTEGERS and tag != VOCAB32:
        raise other_kind(f"a {kind.__name__}", tag, cursor, path)
    number = number_of(tag, cursor, path)
    return kind._value2member_map_.get(number, number)


def _external(kind: External, cursor: Cursor, path: str, code: int | None) -> Any:
    """The elements of a type that reads itself."""
    start = cursor.at
    if code is not None or (kind.python and not reads_list(cursor, path)):
        raise other_kind(kind.name, cursor.tag(path) if code is None else code, cursor, path)
    raw = bytes(cursor.data[start : start + 12]) == _RAW_SOUND
    if raw:
        cursor.take(sound_size(cursor.take(40, path)) - 40, path)
    else:
        for _ in range(kind.size):
            skip(cursor, path)
    data = cursor.data[start : cursor.at]
    if cursor.yarp4 and not raw:
        data = to_yarp3(_PACK_PAIR(LIST, kind.size) + data)[8:]
    if kind.size != 1:
        data = _PACK_PAIR(LIST, kind.size) + data
    elif not _I32(data)[0] & GROUP_MASK:
        data = _PACK_PAIR(LIST, 1) + data
    try:
        return codec.decode_as(data, class_of(kind))
    except DecodeError as error:
        raise DecodeError(f"{path}: {error}") from None


def class_of(kind: External) -> Any:
    """The class of a type that yarpy has; of another, what its bytes are."""
    module, _, name = kind.python.rpartition(".")
    return getattr(import_module(module), name) if module else object
