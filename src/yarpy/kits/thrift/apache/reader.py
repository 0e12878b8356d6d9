"""Reader: what both protocols read alike, and the way to leave out what is not known.

Rules: as `source`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod

from yarpy.errors import DecodeError
from yarpy.kits.thrift.apache import protocol
from yarpy.kits.thrift.apache.source import Source


class Reader(Source, ABC):
    """Reads the bytes `data` from `at` on. All raise DecodeError."""

    @abstractmethod
    def begin(self) -> None:
        """A struct begins."""

    @abstractmethod
    def field(self) -> tuple[int, int]:
        """The sort and the number of the next field; STOP, 0 at the end of the struct."""

    @abstractmethod
    def sequence(self) -> tuple[int, int]:
        """The sort and the number of the elements that follow."""

    @abstractmethod
    def mapping(self) -> tuple[int, int, int]:
        """The sorts of the keys and of the values that follow, and how many pairs."""

    @abstractmethod
    def blob(self) -> memoryview:
        """The bytes of a string."""

    @abstractmethod
    def skip_numbers(self, sort: int, count: int) -> bool:
        """Leave out so many numbers; return False if that sort is none of numbers."""

    def skip(self, sort: int) -> None:
        """Leave out a value."""
        if self.skip_numbers(sort, 1):
            return
        if sort == protocol.STRING:
            self.blob()
        elif sort == protocol.STRUCT:
            self.begin()
            while (inner := self.field()[0]) != protocol.STOP:
                self.skip(inner)
        elif sort == protocol.MAP:
            self.enter()
            key, value, count = self.mapping()
            for _ in range(count):
                self.skip(key)
                self.skip(value)
            self.leave()
        elif sort in (protocol.SET, protocol.LIST):
            self.enter()
            inner, count = self.sequence()
            if not self.skip_numbers(inner, count):
                for _ in range(count):
                    self.skip(inner)
            self.leave()
        else:
            raise DecodeError(f"{sort} is no type of Thrift")
