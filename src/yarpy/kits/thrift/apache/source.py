"""Source: the bytes of a message that are being read, and how much may still come of them.

Rules: whatever is counted in a message is held against the bytes that are left, and against the
limits of `yarpy.limit`, before memory is taken for it.
"""

from __future__ import annotations

from yarpy.data.value import Buffer
from yarpy.errors import DecodeError, Truncated
from yarpy.limit import THRIFT_ITEMS, THRIFT_LEVELS


class Source:
    """`data` from the byte `at` on."""

    def __init__(self, data: Buffer, at: int = 0) -> None:
        self.data = memoryview(data)
        self.at = at
        self._levels = 0
        self._items = 0

    @property
    def left(self) -> int:
        """Bytes that were not read."""
        return len(self.data) - self.at

    def take(self, size: int) -> memoryview:
        """Return the next bytes. Raises DecodeError for a negative number, Truncated for more than
        there are."""
        end = self.at + size
        if size < 0:
            raise DecodeError(f"a length of {size} bytes")
        if end > len(self.data):
            raise Truncated(f"{size} bytes are announced, and {self.left} are left")
        found = self.data[self.at : end]
        self.at = end
        return found

    def count(self, count: int, size: int) -> int:
        """Return the number of elements, of which each has at least `size` bytes, if that many can
        be there."""
        if count < 0:
            raise DecodeError(f"a container of {count} elements")
        if count * size > self.left:
            raise Truncated(f"{count} elements are announced, and {self.left} bytes are left")
        return count

    def enter(self) -> None:
        """A struct or a container begins."""
        self._levels += 1
        if self._levels > THRIFT_LEVELS:
            raise DecodeError(f"structs and containers are nested more than {THRIFT_LEVELS} deep")

    def leave(self) -> None:
        """Note that the innermost container or struct ends."""
        self._levels -= 1

    def spend(self, items: int) -> None:
        """Note that so many objects will be made."""
        self._items += items
        if self._items > THRIFT_ITEMS:
            raise DecodeError(f"a message has more than {THRIFT_ITEMS} values")
