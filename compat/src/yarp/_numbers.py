"""DVector, IVector, BVector, SVector, SPairVector and ShortVector: lists of one
kind, also where results go.

Rules: what C++ calls an out-parameter is one of these, or the `data()` of a Vector; `store` fills
it.
"""

from __future__ import annotations

import operator
from collections.abc import Iterable, Iterator
from typing import Any, ClassVar, Generic, NoReturn, Self, SupportsIndex, TypeVar, overload

from yarp._iterator import SwigPyIterator
from yarp._refusal import refuses
from yarp._value import int32, number, text

T = TypeVar("T")


class StdVector(Generic[T]):
    """A list that grows. `DVector(3)`, `DVector(3, 1.5)`, `DVector([1, 2, 3])`."""

    _zero: ClassVar[Any]

    def __init__(self, size: Any = 0, value: Any = None) -> None:
        if isinstance(size, int):
            self._items: list[T] = [self._zero if value is None else self._kind(value)] * size
        else:
            self._items = [self._kind(item) for item in size]

    @staticmethod
    def _kind(value: Any) -> Any:
        raise NotImplementedError

    def __len__(self) -> int:
        return len(self._items)

    def __iter__(self) -> Iterator[T]:
        return iter(self._items)

    def __bool__(self) -> bool:
        return bool(self._items)

    @overload
    def __getitem__(self, index: int) -> T: ...
    @overload
    def __getitem__(self, index: slice) -> Self: ...
    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            return type(self)(self._items[index])
        return self._items[index]

    def __setitem__(self, index: Any, value: Any) -> None:
        if isinstance(index, slice):
            self._items[index] = [self._kind(item) for item in value]
        else:
            self._items[index] = self._kind(value)

    def __delitem__(self, index: Any) -> None:
        del self._items[index]

    def get(self, index: int) -> T:
        """Return an element; C++'s bindings have [] alone, some programs this."""
        return self._items[index]

    def size(self) -> int:
        return len(self._items)

    def empty(self) -> bool:
        return not self._items

    def push_back(self, x: T) -> None:
        self._items.append(self._kind(x))

    append = push_back

    def pop(self) -> T:
        """Take the last off, and return it."""
        return self._items.pop()

    def pop_back(self) -> None:
        self._items.pop()

    def front(self) -> T:
        return self._items[0]

    def back(self) -> T:
        return self._items[-1]

    def clear(self) -> None:
        self._items.clear()

    def resize(self, new_size: int, x: Any = None) -> None:
        """Cut, or fill up with zeros or `x`."""
        del self._items[new_size:]
        missing = new_size - len(self._items)
        self._items += [self._zero if x is None else self._kind(x)] * missing

    def assign(self, n: int, x: T) -> None:
        self._items = [self._kind(x)] * n

    def reserve(self, n: int) -> None:
        """Nothing to do."""

    def capacity(self) -> int:
        return len(self._items)

    def swap(self, v: Self) -> None:
        self._items, v._items = v._items, self._items

    def data(self) -> Self:
        """Where results go."""
        return self

    def insert(self, index: SupportsIndex, *more: Any) -> SwigPyIterator | None:
        """Put an element in front of that one; `(place, number, x)`: as many."""
        at = operator.index(index)
        count, x = more if len(more) == 2 else (1, more[0])
        self._items[at:at] = [self._kind(x) for _ in range(count)]
        return None if len(more) == 2 else SwigPyIterator(self, at)

    def erase(self, index: SupportsIndex, last: SupportsIndex | None = None) -> SwigPyIterator:
        """Remove an element, or those from one up to another; return the place of what follows."""
        at = operator.index(index)
        del self._items[at : at + 1 if last is None else operator.index(last)]
        return SwigPyIterator(self, at)

    def begin(self) -> SwigPyIterator:
        """Return the place of the first element."""
        return SwigPyIterator(self, 0)

    def end(self) -> SwigPyIterator:
        """Return the place behind the last element."""
        return SwigPyIterator(self, len(self._items))

    def rbegin(self) -> SwigPyIterator:
        """Return the place of the last element, from where one goes backwards."""
        return SwigPyIterator(self, 0, -1)

    def rend(self) -> SwigPyIterator:
        """Return the place in front of the first element."""
        return SwigPyIterator(self, len(self._items), -1)

    def iterator(self) -> Iterator[T]:
        return iter(self._items)

    @refuses
    def get_allocator(self) -> NoReturn:
        """Refuse: it is where the memory of a vector of C++ comes from."""
        raise NotImplementedError("Python has no allocators: a vector grows by itself")

    def _store(self, values: Iterable[Any]) -> None:
        found = [self._kind(value) for value in values]
        self._items[: len(found)] = found

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self._items!r})"


class DVector(StdVector[float]):
    _zero = 0.0
    _kind = staticmethod(number)


class IVector(StdVector[int]):
    _zero = 0
    _kind = staticmethod(int32)


class ShortVector(StdVector[int]):
    _zero = 0
    _kind = staticmethod(int32)


class BVector(StdVector[bool]):
    _zero = False

    @staticmethod
    def _kind(value: Any) -> bool:
        return bool(value)


class SVector(StdVector[str]):
    _zero = ""
    _kind = staticmethod(text)


class SPairVector(StdVector[tuple[str, str]]):
    """Pairs of words."""

    _zero = ("", "")

    @staticmethod
    def _kind(value: Any) -> tuple[str, str]:
        first, second = value
        return text(first), text(second)


def store(target: Any, values: Iterable[Any]) -> None:
    """Put results into an out-parameter: a DVector and its like, a Vector, or the `data()` of one.

    Raises TypeError for anything else: the caller would look for its results in vain.
    """
    if isinstance(target, list):
        target[:] = values
    elif hasattr(target, "_store"):
        target._store(values)
    elif hasattr(target, "__setitem__"):  # a numpy array
        for index, value in enumerate(values):
            target[index] = value
    else:
        raise TypeError(f"results go into a DVector or the data() of a Vector, not {target!r}")
