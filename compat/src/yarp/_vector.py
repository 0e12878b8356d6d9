"""Vector and VectorInt: numbers that ports send.

Rules: `data()` stands for the memory of the vector: what is stored there is stored in it.
"""

from __future__ import annotations

import operator
from collections.abc import Iterable, Iterator
from typing import Any, ClassVar, Self, SupportsIndex

import yarpy
from yarp._iterator import SwigPyIterator
from yarp._portable import Portable
from yarp._value import int32, number


class VectorBase(Portable):
    """The common part."""

    _type = "yarp/vector"
    _dtype: ClassVar[str]
    _tag: ClassVar[int]
    _size: ClassVar[int]
    _zero: ClassVar[Any]

    def __init__(self, size: Any = 0, value: Any = None) -> None:
        if isinstance(size, int):
            if value is not None and hasattr(value, "__iter__"):
                self._items: list[Any] = [self._kind(item) for item in value][:size]
            else:
                self._items = [self._zero if value is None else self._kind(value)] * size
        else:
            self._items = [self._kind(item) for item in size]

    @staticmethod
    def _kind(value: Any) -> Any:
        raise NotImplementedError

    def _outgoing(self) -> Any:
        return yarpy.Vector(self._items, dtype=self._dtype)

    def _take(self, message: yarpy.Message) -> None:
        found = message.as_(yarpy.Vector)
        self._items = [self._kind(item) for item in found]

    def _memory(self) -> bytes:
        """The numbers as they lie in memory."""
        return b"".join(bytes(block) for block in yarpy.Vector(self._items, self._dtype).to_wire())[
            8:
        ]

    def _store(self, values: Iterable[Any]) -> None:
        found = [self._kind(value) for value in values]
        self._items[: len(found)] = found

    def size(self) -> int:
        return len(self._items)

    def length(self) -> int:
        return len(self._items)

    def getListSize(self) -> int:
        return len(self._items)

    def __len__(self) -> int:
        return len(self._items)

    def __iter__(self) -> Iterator[Any]:
        return iter(self._items)

    def __getitem__(self, index: int) -> Any:
        return self._items[index]

    def __setitem__(self, index: int, value: Any) -> None:
        self._items[index] = self._kind(value)

    def get(self, j: int) -> Any:
        """The number at an index."""
        return self._items[j]

    access = get

    def set(self, j: int, v: Any) -> None:
        """Change the number at an index."""
        self._items[j] = self._kind(v)

    def push_back(self, elem: Any) -> None:
        self._items.append(self._kind(elem))

    def pop_back(self) -> None:
        self._items.pop()

    def resize(self, size: int, _def: Any = None) -> None:
        """Cut, or fill up with zeros; with a second argument, all become that."""
        if _def is not None:
            self._items = [self._kind(_def)] * size
        else:
            del self._items[size:]
            self._items += [self._zero] * (size - len(self._items))

    def reserve(self, size: int) -> None:
        """Nothing to do."""

    def capacity(self) -> int:
        return len(self._items)

    def clear(self) -> None:
        self._items.clear()

    def zero(self) -> None:
        """Set all to 0."""
        self._items[:] = [self._zero] * len(self._items)

    def data(self) -> Self:
        """The memory of the numbers: an out-parameter, or an argument."""
        return self

    getFirst = data

    def subVector(self, first: int, last: int) -> Self:
        """The numbers from one index to another, both included."""
        return type(self)(self._items[first : last + 1])

    def setSubvector(self, position: int, v: Any) -> bool:
        """Change the numbers from an index on."""
        if position < 0 or position + len(v._items) > len(self._items):
            return False
        self._items[position : position + len(v._items)] = v._items
        return True

    def isEqual(self, r: Any) -> bool:
        return bool(self._items == r._items)

    def begin(self) -> SwigPyIterator:
        """Return the place of the first number."""
        return SwigPyIterator(self, 0)

    def end(self) -> SwigPyIterator:
        """Return the place behind the last number."""
        return SwigPyIterator(self, len(self._items))

    cbegin = begin
    cend = end

    def erase(self, place: SupportsIndex, last: SupportsIndex | None = None) -> SwigPyIterator:
        """Remove a number, or those from one up to another; return the place of what follows."""
        at = operator.index(place)
        del self._items[at : at + 1 if last is None else operator.index(last)]
        return SwigPyIterator(self, at)

    def getMemoryBlock(self) -> bytes:
        """The numbers as they lie in memory, little endian."""
        return self._memory()

    def getBottleTag(self) -> int:
        return self._tag

    def getElementSize(self) -> int:
        return self._size

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self._items!r})"


class Vector(VectorBase):
    """Float64. `Vector(3)`, `Vector(3, 1.5)`, `Vector([1, 2, 3])`."""

    _dtype = "float64"
    _tag = 10
    _size = 8
    _zero = 0.0
    _kind = staticmethod(number)

    def toString(self, precision: int = -1, width: int = -1) -> str:
        """The numbers as text, with tabulators between them; with a width, with blanks."""
        return row(self._items, precision, width)

    toString_c = toString


class VectorInt(VectorBase):
    """Int32."""

    _dtype = "int32"
    _tag = 1
    _size = 4
    _zero = 0
    _kind = staticmethod(int32)

    def toString(self, precision: int = -1, width: int = -1) -> str:
        """The numbers as text, with blanks between them."""
        return " ".join(map(str, self._items))

    toString_c = toString


def row(items: Iterable[float], precision: int, width: int) -> str:
    """Numbers in a line as C++ prints them."""
    digits = 6 if precision < 0 else precision
    if width < 0:
        return "\t".join(f"{item: .{digits}f}" for item in items)
    return " ".join(f"{item: {width}.{digits}f}" for item in items)
