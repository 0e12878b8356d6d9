"""Values that a message with a description restores (`described` has the words).

Rules: what a description says is compared with the bytes that are there; it names no code. Arrays
are views of what was received. The elements of a message share one limit. Anything else than what
`described` writes is a DecodeError.
"""

from __future__ import annotations

from importlib import import_module
from math import prod
from struct import Struct
from struct import error as struct_error
from typing import TYPE_CHECKING, Any, Final

from yarpy.data.bottle import Bottle, Property
from yarpy.data.numbers import DTYPES
from yarpy.data.python import description
from yarpy.data.python.array import NUMBERS
from yarpy.data.python.description import BLOBS, OWN
from yarpy.data.reader import read_element, read_list, read_run, room_for
from yarpy.data.value import (
    BLOB,
    FIXED,
    LIST,
    MAX_DEPTH,
    UNIT_MASK,
    Buffer,
)
from yarpy.data.walker import Walker
from yarpy.data.writer import element
from yarpy.errors import DecodeError, Truncated, YarpError
from yarpy.limit import ARRAY_DIMENSIONS, check_hashes

if TYPE_CHECKING:
    from numpy.typing import NDArray

_I32 = Struct("<i")
_PAIR = Struct("<ii")
_HEAD = Struct("<4i")
_MAT: Final = 0x0074616D


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
        if word in BLOBS:
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
        if word not in OWN:
            raise DecodeError(f"a description that is not known here: {word:.40}")
        end = self._end(at - 4)
        return _own(word).from_wire(self._view[at - 4 : end]), end

    def _end(self, pos: int) -> int:
        """Return the byte at which the list that begins at `pos` ends."""
        rest = self._view[pos:]
        walker = Walker(len(rest), nested=True)
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
    module, name = OWN[word]
    return getattr(import_module(f"yarpy.data.{module}"), name)
