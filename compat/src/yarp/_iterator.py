"""SwigPyIterator: a place in a vector, as `begin()` and `end()` return it.

Rules: it is a number where one is needed (`vector[it]`), and equal to it; it stays at its number
when the vector changes.
"""

from __future__ import annotations

from typing import Any, Self


class SwigPyIterator:
    """`value()`, `incr()`, `next()`; `==`, `+` and `-` as those of C++."""

    def __init__(self, owner: Any, at: int, step: int = 1) -> None:
        self._owner, self._at, self._step = owner, at, step

    def _index(self) -> int:
        """Return which element that is; a place that goes backwards begins behind the last."""
        return self._at if self._step > 0 else len(self._owner) - 1 - self._at

    def value(self) -> Any:
        """Return the element; StopIteration behind the last."""
        if not 0 <= self._at < len(self._owner):
            raise StopIteration
        return self._owner[self._index()]

    def incr(self, n: int = 1) -> Self:
        """Go on by so many; StopIteration behind the end."""
        if not 0 <= self._at + n <= len(self._owner):
            raise StopIteration
        self._at += n
        return self

    def decr(self, n: int = 1) -> Self:
        """Go back by so many."""
        return self.incr(-n)

    def advance(self, n: int) -> Self:
        return self.incr(n)

    def next(self) -> Any:
        """Return the element, and go on."""
        found = self.value()
        self._at += 1
        return found

    __next__ = next

    def previous(self) -> Any:
        """Go back, and return the element."""
        self.decr()
        return self.value()

    def __iter__(self) -> Self:
        return self

    def copy(self) -> SwigPyIterator:
        return SwigPyIterator(self._owner, self._at, self._step)

    def distance(self, x: SwigPyIterator) -> int:
        """Return how far the other is ahead."""
        return x._at - self._at

    def equal(self, x: SwigPyIterator) -> bool:
        return self._owner is x._owner and self._at == x._at

    def __eq__(self, other: object) -> bool:
        if isinstance(other, SwigPyIterator):
            return self.equal(other)
        return self._at == other

    __hash__ = None  # type: ignore[assignment]

    def __index__(self) -> int:
        return self._index()

    def __add__(self, n: int) -> SwigPyIterator:
        return self.copy().incr(n)

    def __sub__(self, other: Any) -> Any:
        if isinstance(other, SwigPyIterator):
            return other.distance(self)
        return self.copy().decr(other)
