"""NetInt16, NetInt32, NetInt64: integers of so many bits, as C++ has them on the network.
UnionNetInt64: one of them as its bytes.

Rules: what does not fit raises OverflowError, where C++ cuts it off.
"""

from __future__ import annotations

from typing import ClassVar


class NetInt32:
    """`NetInt32(5)` is an int wherever one is needed."""

    _bits: ClassVar[int] = 32

    def __init__(self, value: int = 0) -> None:
        number = int(value)
        if not -(1 << (self._bits - 1)) <= number < 1 << (self._bits - 1):
            raise OverflowError(f"{number} does not fit in {self._bits} bits")
        self._value = number

    def __int__(self) -> int:
        return self._value

    __index__ = __int__

    def __eq__(self, other: object) -> bool:
        return isinstance(other, (int, NetInt32)) and self._value == int(other)

    def __hash__(self) -> int:
        return hash(self._value)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self._value})"


class NetInt16(NetInt32):
    """16 bits."""

    _bits = 16


class NetInt64(NetInt32):
    """64 bits."""

    _bits = 64


class UnionNetInt64:
    """`d` is a number, `c` its eight bytes, the lowest first; to change one changes the other."""

    def __init__(self) -> None:
        self._value = 0

    @property
    def d(self) -> int:
        """Return the number."""
        return self._value

    @d.setter
    def d(self, value: int) -> None:
        self._value = int(NetInt64(value))

    @property
    def c(self) -> bytes:
        """Return its bytes."""
        return self._value.to_bytes(8, "little", signed=True)

    @c.setter
    def c(self, value: bytes) -> None:
        self._value = int.from_bytes(bytes(value)[:8].ljust(8, b"\0"), "little", signed=True)
