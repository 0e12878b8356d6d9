"""Attributes of remote devices: reading one asks the device, assigning to one sets it there.

Rules: the owner has `axes`, and `_ask` with `read(member)` and `write(member, joints, values)`.
Values are tuples, because changing an entry of a list would not change it on the device.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, Generic, Self, TypeVar, overload

T = TypeVar("T")


class Adjustable(Generic[T]):
    """One value for each joint. Assign as many."""

    def __init__(self, unit: str, make: Callable[[Any], T] | None = None) -> None:
        self.__doc__ = unit or "One for each joint."
        self._make = make

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self, owner: None, kind: type) -> Self: ...
    @overload
    def __get__(self, owner: object, kind: type) -> tuple[T, ...]: ...
    def __get__(self, owner: Any, kind: type) -> Self | tuple[T, ...]:
        if owner is None:
            return self
        found = owner._ask.read(self._name)
        return tuple(map(self._make, found)) if self._make is not None else tuple(found)

    def __set__(self, owner: Any, values: Iterable[T]) -> None:
        listed = [*values]
        count = owner._ask.axes
        if len(listed) != count:
            raise ValueError(f"{self._name}: {len(listed)} values for {count} joints")
        owner._ask.write(self._name, [*range(count)], listed)
