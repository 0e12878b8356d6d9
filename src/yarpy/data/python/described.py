"""Python values that YARP has no kinds for: a message with a description behind it.

    {"rgb": picture, "q": array}    (rgb ([mat] [rgb] ...)) (q (0.1 0.2))
                                    (yarpy.type (dict (rgb (array "|u1" 480 640 3)) ...) 123)
    (1, None)                       1 () (yarpy.type (tuple (1 (none))) 61)
    array.astype("f2")              {...} (yarpy.type (array "<f2" 2 3) 58)

    dict list tuple     with the descriptions of those in it that have one, by key or index
    array TYPE SIZES    a list of numbers, a Matrix, an Image, or a blob of the memory
    none complex        an empty list, a list of two
    image matrix vector stamp sound pointcloud

Rules: what needs no description is sent without, as ever; a Bottle and a Property never have one.
Arrays are not copied where their memory is in order. Who does not know descriptions reads a list,
or a Property, with one element more; who does, reads them by `restored`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, is_dataclass
from struct import Struct
from typing import TYPE_CHECKING, Any, Final

from yarpy.data.bottle import Bottle
from yarpy.data.embedded import plain
from yarpy.data.python import description
from yarpy.data.python.array import array_of, is_listed, little, memory, natural
from yarpy.data.python.description import BLOBS, OWN
from yarpy.data.text import Groups
from yarpy.data.value import (
    LIST,
    MAX_DEPTH,
    Blocks,
    Buffer,
    Float32,
    Int8,
    Int16,
    Int64,
    Vocab,
)
from yarpy.data.writer import element, joined

if TYPE_CHECKING:
    from numpy.typing import NDArray

_I32 = Struct("<i")
_PAIR = Struct("<ii")

#: what comes back equal by itself
_LEAVES: Final = frozenset(
    (int, float, str, bool, bytes, bytearray, Vocab, Int8, Int16, Int64, Float32)
)
#: texts that a Property takes for numbers
_READ_AS_NUMBERS: Final = frozenset(("inf", "nan"))
_COMPARED: Final = frozenset(("vector", "stamp"))  # equal to the list that they come back as


# ---------------------------------------------------------------------------------- which values


def is_needed(value: Any) -> bool:
    """Return whether a list, a tuple or a dict holds what would not come back equal without."""
    return _is_needed(value, 0, False)


def _is_needed(value: Any, depth: int, keyed: bool) -> bool:
    """`keyed`: it is a value of a dict, which YARP has no dicts, tuples or arrays for."""
    if isinstance(value, (Bottle, Groups)) or depth > MAX_DEPTH:
        return False
    if isinstance(value, (list, tuple)):
        if keyed and isinstance(value, tuple):
            return True
        kinds = set(map(type, value))
        if kinds <= _LEAVES and not (keyed and str in kinds):
            return False
        return any(_is_needed_item(item, depth, keyed) for item in value)
    if set(map(type, value)) - {str}:
        return True  # keys that no Property has
    return any(_is_needed_item(item, depth, True) for item in value.values())


def _is_needed_item(item: Any, depth: int, keyed: bool) -> bool:
    kind = type(item)
    if kind in _LEAVES:
        return keyed and kind is str and item in _READ_AS_NUMBERS
    if item is None:
        return depth > 0 or not keyed
    if isinstance(item, (list, tuple)):
        return _is_needed(item, depth + 1, keyed)
    if isinstance(item, dict):
        return (keyed and not isinstance(item, Groups)) or _is_needed(item, depth + 1, True)
    if isinstance(item, complex):
        return True
    if hasattr(kind, "to_wire"):
        return _word_of(item) not in ("", *_COMPARED)
    if is_record(item):
        return True
    array = None if isinstance(item, (str, int, float, memoryview)) else array_of(item)
    if array is None:
        return False
    if not array.ndim:
        return array.dtype.kind == "c"
    return keyed or not is_listed(array)


def is_record(value: Any) -> bool:
    """Return whether `value` is an object of a dataclass."""
    return is_dataclass(value) and not isinstance(value, type)


def _word_of(value: Any) -> str:
    """The word for an object of one of our own types; "" for any other."""
    word = type(value).__name__.lower()
    module = OWN.get(word, ("", ""))[0]
    return word if type(value).__module__ == f"yarpy.data.{module}" else ""


# ---------------------------------------------------------------------------------- sending


def blocks(value: Any) -> Blocks:
    """The message of a value, with its description. TypeError, ValueError for what cannot be
    sent."""
    spelling = _Spelling()
    said: list[Any]
    if is_record(value):
        value = fields_of(value)
    if isinstance(value, dict):
        said, count = spelling.pairs(value, 0), len(value)
    elif isinstance(value, (list, tuple)):
        said, count = spelling.items(value, 0), len(value)
    else:
        said, count = spelling.value(value, 0) or ["list"], 1
    code, payload = element(said, 1)
    content = _I32.pack(code) + (payload if isinstance(payload, bytes) else b"".join(payload))
    head = _PAIR.pack(LIST, count + 1)
    return joined([head, *spelling.parts, description.described(content)])


def fields_of(value: Any) -> dict[str, Any]:
    """Return what is in an object of a dataclass, by name."""
    return {field.name: getattr(value, field.name) for field in fields(value)}


class _Spelling:
    """The elements of a message in pieces; what each is, it says by its description."""

    def __init__(self) -> None:
        self.parts: list[bytes | memoryview] = []

    def items(self, values: Sequence[Any], depth: int) -> list[Any]:
        """Add the elements of a list; gives its description."""
        said: list[Any] = ["tuple" if isinstance(values, tuple) else "list"]
        for index, item in enumerate(values):
            inner = self.value(item, depth)
            if inner is not None:
                said.append([index, inner])
        return said

    def pairs(self, values: dict[Any, Any], depth: int) -> list[Any]:
        """Add the elements `(key value)`; gives the description of a dict."""
        said: list[Any] = ["dict"]
        for key, item in values.items():
            if not isinstance(key, (str, int, float, bytes)):
                raise TypeError(f"the key {key!r} is neither a string nor a number, nor bytes")
            self.parts.append(_PAIR.pack(LIST, 1 if item is None else 2))
            self._add(element(key, depth + 1))
            inner = None if item is None else self.value(item, depth + 1)
            if inner is not None:
                said.append([key, inner])
        return said

    def value(self, value: Any, depth: int) -> list[Any] | None:
        """Add one element of a list that is `depth` lists deep; gives its description, None if it
        needs none."""
        kind = type(value)
        if kind in _LEAVES:
            self._add(element(value, depth))
            return None
        if value is None:
            self.parts.append(_PAIR.pack(LIST, 0))
            return ["none"]
        if depth >= MAX_DEPTH:
            raise ValueError(f"values nested more than {MAX_DEPTH} deep cannot be sent")
        if isinstance(value, (Bottle, Groups)):
            self._add(element(value, depth))
            return None
        if isinstance(value, (list, tuple)):
            if kind is list and _LEAVES.issuperset(map(type, value)):
                self._add(element(value, depth))
                return None
            self.parts.append(_PAIR.pack(LIST, len(value)))
            said = self.items(value, depth + 1)
            return None if said == ["list"] else said
        if isinstance(value, dict):
            self.parts.append(_PAIR.pack(LIST, len(value)))
            return self.pairs(value, depth + 1)
        if isinstance(value, complex):
            self._add(element([value.real, value.imag], depth))
            return ["complex"]
        if hasattr(kind, "to_wire"):
            return self._own(value, depth)
        if is_record(value):
            return self.value(fields_of(value), depth)
        array = None if isinstance(value, (str, int, float, memoryview)) else array_of(value)
        if array is not None and array.ndim:
            return self._array(array)
        number = plain(value) if array is None or array.dtype.kind != "c" else array.item()
        if isinstance(number, complex):
            return self.value(number, depth)
        self._add(element(number, depth))
        return None

    def _own(self, value: Any, depth: int) -> list[Any] | None:
        word = _word_of(value)
        if not word:
            self._add(element(value, depth))  # a list, if it is one
            return None
        pieces = value.to_wire()
        if word in BLOBS:
            self._blob(b"".join(pieces))
        else:
            self.parts += pieces  # the code of a message is the tag of a list
        return [word]

    def _array(self, array: NDArray[Any]) -> list[Any]:
        array = little(array)
        found = natural(array)
        if found is not None:
            self.parts += found
        else:
            self._blob(memory(array))
        return ["array", array.dtype.str, *array.shape]

    def _blob(self, data: Buffer) -> None:
        self._add(element(data, 0))

    def _add(self, found: tuple[int, bytes | list[bytes | memoryview]]) -> None:
        code, payload = found
        self.parts.append(_I32.pack(code))
        if isinstance(payload, bytes):
            self.parts.append(payload)
        else:
            self.parts += payload
