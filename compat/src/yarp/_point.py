"""Vector2D and Vector2DVector: the corners of an area in a map.

Rules: C++'s bindings have the corners without a name for them; these are the names that programs
give them.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from yarp._numbers import StdVector


class Vector2D:
    """Two numbers, x and y: also `point[0]`, and `x, y = point`."""

    def __init__(self, x: float = 0.0, y: float = 0.0) -> None:
        self.x, self.y = float(x), float(y)

    def __iter__(self) -> Iterator[float]:
        return iter((self.x, self.y))

    def __getitem__(self, index: int) -> float:
        return (self.x, self.y)[index]

    def __eq__(self, other: object) -> bool:
        """Return whether it is the same place: another point, or a pair of numbers."""
        if not isinstance(other, (Vector2D, tuple)):
            return NotImplemented
        return tuple(self) == tuple(other)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"({self.x}, {self.y})"


class Vector2DVector(StdVector[Vector2D]):
    """Points. What is added may be a pair of numbers."""

    def __init__(self, size: Any = 0, value: Any = None) -> None:
        super().__init__(() if isinstance(size, int) else size)
        if isinstance(size, int):
            self.resize(size, value)

    @staticmethod
    def _kind(value: Any) -> Vector2D:
        x, y = value
        return Vector2D(x, y)

    def resize(self, new_size: int, x: Any = None) -> None:
        """Cut, or fill up with zeros or `x`."""
        del self._items[new_size:]
        while len(self._items) < new_size:
            self._items.append(self._kind((0.0, 0.0) if x is None else x))
