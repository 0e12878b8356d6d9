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
Arrays are not copied where their memory is in order, and are views of what was received. What a
description says is compared with the bytes that are there; it names no code. Who does not know
descriptions reads a list, or a Property, with one element more.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, is_dataclass
from importlib import import_module
from math import prod
from struct import Struct
from struct import error as struct_error
from typing import TYPE_CHECKING, Any, Final

from yarpy.data.bottle import Bottle, Property
from yarpy.data.embedded import plain
from yarpy.data.numbers import DTYPES
from yarpy.data.python import description
from yarpy.data.python.array import NUMBERS, array_of, is_listed, little, memory, natural
from yarpy.data.reader import read_element, read_list, read_run, room_for
from yarpy.data.text import Groups
from yarpy.data.value import (
    BLOB,
    FIXED,
    LIST,
    MAX_DEPTH,
    UNIT_MASK,
    Blocks,
    Buffer,
    Float32,
    Int8,
    Int16,
    Int64,
    Vocab,
)
from yarpy.data.walker import Walker
from yarpy.data.writer import element, joined
from yarpy.errors import DecodeError, Truncated, YarpError
from yarpy.limit import ARRAY_DIMENSIONS, check_hashes

if TYPE_CHECKING:
    from numpy.typing import NDArray

_I32 = Struct("<i")
_PAIR = Struct("<ii")
_HEAD = Struct("<4i")
_MAT: Final = 0x0074616D

#: what comes back equal by itself
_LEAVES: Final = frozenset(
    (int, float, str, bool, bytes, bytearray, Vocab, Int8, Int16, Int64, Float32)
)
#: texts that a Property takes for numbers
_READ_AS_NUMBERS: Final = frozenset(("inf", "nan"))
#: types of ours by their word, and where each is
_OWN: Final = {
    "image": ("sig.image", "Image"),
    "matrix": ("sig.matrix", "Matrix"),
    "vector": ("sig.vector", "Vector"),
    "stamp": ("stamp", "Stamp"),
    "sound": ("sig.sound", "Sound"),
    "pointcloud": ("sig.pointcloud", "PointCloud"),
}
_BLOBS: Final = frozenset(("sound", "pointcloud"))  # whose message is no Bottle
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
    module = _OWN.get(word, ("", ""))[0]
    return word if type(value).__module__ == f"yarpy.data.{module}" else ""


# ---------------------------------------------------------------------------------- sending


def blocks(value: Any) -> Blocks:
    """The message of a value, with its description. TypeError, ValueError for what cannot be
    sent."""
    spelling = _Spelling()
    said: list[Any]
    if is_record(value):
        value = _fields(value)
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


def _fields(value: Any) -> dict[str, Any]:
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
            return self.value(_fields(value), depth)
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
        if word in _BLOBS:
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


# ---------------------------------------------------------------------------------- receiving


def restore(view: Buffer, start: int) -> Any:
    """The value of a message whose description begins at `start`. Raises DecodeError."""
    try:
        array = _lone_blob(view, start)
        return _Reading(view, start).whole() if array is None else array
    except YarpError:
        raise
    except struct_error:
        raise Truncated(f"the message goes on beyond its {len(view)} bytes") from None
    except (ValueError, TypeError, OverflowError, LookupError, MemoryError) as error:
        raise DecodeError(f"a message that its description does not fit: {error}") from error


def _lone_blob(view: Buffer, start: int) -> NDArray[Any] | None:
    """The array of a message that is its memory and nothing else, as most are, with many steps
    less; None for any other message."""
    code, count, tag, length = _HEAD.unpack_from(view)
    if code != LIST or count != 2 or tag != BLOB or start != _HEAD.size + length:
        return None
    said = description.array_type(bytes(description.content(view, start)))
    if said is None or said[0] not in NUMBERS or len(said[1]) > ARRAY_DIMENSIONS:
        return None
    import numpy as np

    dtype, shape = said
    if prod(shape) * np.dtype(dtype).itemsize != length:
        return None
    array: NDArray[Any] = np.frombuffer(memoryview(view)[_HEAD.size : start], dtype)
    return array.reshape(shape)


def restore_text(bottle: Bottle) -> Any:
    """The value of a message that came as text, or its Bottle if that has no description."""
    last = bottle[-1] if bottle else None
    if not isinstance(last, list) or len(last) != 3 or last[0] != description.KEY:
        return bottle
    if not isinstance(last[1], list):
        return bottle
    code, payload = element(list(last[1]), 1)
    content = _I32.pack(code) + (payload if isinstance(payload, bytes) else b"".join(payload))
    front = b"".join(
        _I32.pack(tag) + (data if isinstance(data, bytes) else b"".join(data))
        for tag, data in (element(item, 0) for item in bottle[:-1])
    )
    head = _PAIR.pack(LIST, len(bottle)) + front
    return restore(head + description.described(content), len(head))


class _Reading:
    """Makes the value of one message. Its elements share one limit."""

    def __init__(self, view: Buffer, start: int) -> None:
        said = description.content(view, start)
        self._view = memoryview(view)[:start]
        self._said: list[Any] = read_list(list, list, said)
        self._room = room_for(len(view))

    def whole(self) -> Any:
        code, count = _PAIR.unpack_from(self._view)
        if code & UNIT_MASK or count < 1:
            raise DecodeError("a description behind a list of elements of one kind")
        word = self._word(self._said)
        if word in _CONTAINERS:
            value, end = self._container(8, 0, count - 1, self._said, 0)
        elif count == 2:
            value, end = self._element(12, self._tag(8), self._said, 0)
        else:
            raise DecodeError(f"a description of one value behind {count - 1} elements")
        if end != len(self._view):
            raise DecodeError("a description that does not begin behind the last element")
        return value

    def _tag(self, pos: int) -> int:
        tag: int = _I32.unpack_from(self._view, pos)[0]
        return tag

    @staticmethod
    def _word(said: Any) -> str:
        if not isinstance(said, list) or not said or type(said[0]) is not str:
            raise DecodeError("a description that does not begin with a word")
        return str(said[0])

    def _plain(self, at: int, tag: int, tagged: bool, depth: int) -> tuple[Any, int]:
        """An element without a description, whose payload begins at `at`."""
        if tagged:
            return read_element(list, Property.from_bottle, self._view, at - 4, depth, self._room)
        items: list[Any] = []
        end = read_run(self._view, at, tag, 1, items)
        return items[0], end

    def _element(self, at: int, tag: int, said: Any, depth: int) -> tuple[Any, int]:
        """The element that is described as `said`, and where it ends."""
        word = self._word(said)
        if depth > MAX_DEPTH:
            raise DecodeError(f"values nested more than {MAX_DEPTH} deep")
        if word == "array":
            return self._array(at, tag, said)
        if word in _BLOBS:
            data, end = self._blob(at, tag)
            return _own(word).from_wire(data), end
        if not LIST <= tag < 2 * LIST:
            raise DecodeError(f"an element with the tag {tag} that is described as {word:.40}")
        count = self._tag(at)
        if word in _CONTAINERS:
            return self._container(at + 4, tag & UNIT_MASK, count, said, depth + 1)
        if word == "none" and not count:
            return None, at + 4
        if word == "complex":
            parts, end = self._plain(at, tag, True, depth)
            real, imaginary = parts
            return complex(float(real), float(imaginary)), end
        if word not in _OWN:
            raise DecodeError(f"a description that is not known here: {word:.40}")
        end = self._end(at - 4)
        return _own(word).from_wire(self._view[at - 4 : end]), end

    def _end(self, pos: int) -> int:
        """Where a list ends that begins at `pos`."""
        rest = self._view[pos:]
        walker = Walker(len(rest))
        walker.advance(rest)
        if not walker.done:
            raise Truncated(f"a list at byte {pos} that goes on behind the last element")
        return pos + walker.advance(rest)

    def _blob(self, at: int, tag: int) -> tuple[memoryview, int]:
        length = self._tag(at)
        end = at + 4 + length
        if tag != BLOB or length < 0 or end > len(self._view):
            raise DecodeError(f"no blob at byte {at}")
        return self._view[at + 4 : end], end

    def _container(
        self, pos: int, kind: int, count: int, said: list[Any], depth: int
    ) -> tuple[Any, int]:
        """`count` elements of a list from `pos` on; `kind` is their tag if they have none."""
        if not 0 <= count <= len(self._view) - pos:
            raise DecodeError(f"{count} elements at byte {pos}")
        if self._room is not None:
            self._room[0] -= count
            if self._room[0] < 0:
                raise DecodeError("a message of too many elements (YARPY_MAX_ELEMENTS)")
        inner = _by_key(said)
        if said[0] == "dict":
            return self._dict(pos, kind, count, inner, depth)
        items = []
        for index in range(count):
            item, pos = self._one(pos, kind, inner.get(index), depth)
            items.append(item)
        return (tuple(items) if said[0] == "tuple" else items), pos

    def _one(self, pos: int, kind: int, said: Any, depth: int) -> tuple[Any, int]:
        tag, at = (kind, pos) if kind else (self._tag(pos), pos + 4)
        if said is None:
            return self._plain(at, tag, not kind, depth)
        return self._element(at, tag, said, depth)

    def _dict(
        self, pos: int, kind: int, count: int, inner: dict[Any, Any], depth: int
    ) -> tuple[Any, int]:
        pairs: list[tuple[Any, Any]] = []
        for _ in range(count):
            tag = self._tag(pos)
            if kind or not LIST <= tag < 2 * LIST:
                raise DecodeError(f"no pair of key and value at byte {pos}")
            size, each = self._tag(pos + 4), tag & UNIT_MASK
            if not 1 <= size <= 2:
                raise DecodeError(f"{size} elements at byte {pos}, not key and value")
            key, pos = self._one(pos + 8, each, None, depth + 1)
            value = None
            if size == 2:
                value, pos = self._one(pos, each, inner.get(key), depth + 1)
            pairs.append((key, value))
        if not all(isinstance(key, str) for key, _ in pairs):
            check_hashes(key for key, _ in pairs)
        return dict(pairs), pos

    def _array(self, at: int, tag: int, said: list[Any]) -> tuple[NDArray[Any], int]:
        import numpy as np

        dtype, *sizes = said[1:]
        if type(dtype) is not str or dtype not in NUMBERS or len(sizes) > ARRAY_DIMENSIONS:
            raise DecodeError(f"an array of {dtype!s:.40} in {len(sizes)} dimensions")
        if not all(isinstance(size, int) and 0 <= size < 1 << 62 for size in sizes):
            raise DecodeError("an array with sizes that are none")
        shape = tuple(map(int, sizes))
        if tag == BLOB:
            data, end = self._blob(at, tag)
            if prod(shape) * np.dtype(dtype).itemsize != len(data):
                raise DecodeError(f"an array of {dtype} and shape {shape} in {len(data)} bytes")
            flat: NDArray[Any] = np.frombuffer(data, dtype)
            return flat.reshape(shape), end
        found, end = self._listed(at, tag)
        if found.size != prod(shape):
            raise DecodeError(f"an array of the shape {shape} in {found.size} numbers")
        if found.dtype.str != dtype:  # text has fewer kinds than numbers
            found = found.astype(dtype)
        return found.reshape(shape), end

    def _listed(self, at: int, tag: int) -> tuple[NDArray[Any], int]:
        """The array that one of YARP's own types is."""
        import numpy as np

        kind = tag & UNIT_MASK
        if not LIST <= tag < 2 * LIST:
            raise DecodeError(f"an array in an element with the tag {tag}")
        count = self._tag(at)
        if kind in DTYPES:
            end = at + 4 + count * FIXED[kind][1]
            if count < 0 or end > len(self._view):
                raise DecodeError(f"{count} numbers at byte {at}")
            return np.frombuffer(self._view[at + 4 : end], DTYPES[kind]), end
        end = self._end(at - 4)
        view = self._view[at - 4 : end]
        if count == 4 and len(view) >= 16 and _PAIR.unpack_from(view, 8)[1] == _MAT:
            return _own("image").from_wire(view).array, end
        if count == 3:
            return _own("matrix").from_wire(view).array, end
        return np.asarray(read_list(list, list, view), "f8"), end  # an empty list, from C++


_CONTAINERS: Final = frozenset(("dict", "list", "tuple"))


def _by_key(said: list[Any]) -> dict[Any, Any]:
    """The descriptions within one of a container, by key or index."""
    found: dict[Any, Any] = {}
    for pair in said[1:]:
        key, inner = pair
        found[key] = inner
    if not all(isinstance(key, str) for key in found):
        check_hashes(found)
    return found


def _own(word: str) -> Any:
    module, name = _OWN[word]
    return getattr(import_module(f"yarpy.data.{module}"), name)
