"""Wired: values that are copied and pickled in their wire form.

Rules: for values that are views of memory, which Python cannot copy by itself. A copy has memory of
its own; an array that looks at it may be written to.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from typing import Any, Self


class Wired:
    """The base of values with a wire form, for `copy.deepcopy`, `pickle` and `multiprocessing`."""

    __slots__ = ()

    @classmethod
    @abstractmethod
    def from_wire(cls, view: bytes | bytearray | memoryview) -> Self:
        """The value made of these bytes."""

    @abstractmethod
    def to_wire(self) -> tuple[bytes | memoryview, ...]:
        """The bytes, in pieces."""

    def __reduce__(self) -> tuple[Callable[[bytearray], Any], tuple[bytearray]]:
        return type(self).from_wire, (bytearray().join(self.to_wire()),)
