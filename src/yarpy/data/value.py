"""The element kinds of a Bottle as Python objects, and their tags on the wire.

Rules: plain `int`, `float`, `str`, `bytes` and `bool` stand for the common kinds. The odd
widths are subclasses, so a decoded message encodes to the bytes it came from; arithmetic on them
gives plain numbers again. Tags are those of YARP 3.x (4.0 renumbers the floats).
"""

from __future__ import annotations

from functools import lru_cache
from struct import Struct
from typing import Final, Self, TypeAlias

INT32: Final = 1
STRING: Final = 4
VOCAB32: Final = 9
FLOAT64: Final = 10
BLOB: Final = 12
INT64: Final = 17
INT8: Final = 32
INT16: Final = 64
FLOAT32: Final = 128
LIST: Final = 256
DICT: Final = 512

UNIT_MASK: Final = 0xFF
GROUP_MASK: Final = LIST | DICT

#: Lists nested deeper than this are refused on every path, in and out.
MAX_DEPTH: Final = 100

#: Data of at least this many bytes leaves as a block of its own instead of being copied.
BIG: Final = 4096

#: tag -> struct character and bytes of the kinds that always take the same room
FIXED: Final = {
    INT32: ("i", 4),
    VOCAB32: ("i", 4),
    FLOAT64: ("d", 8),
    INT64: ("q", 8),
    INT8: ("b", 1),
    INT16: ("h", 2),
    FLOAT32: ("f", 4),
}

Buffer: TypeAlias = bytes | bytearray | memoryview
Blocks: TypeAlias = tuple[bytes | memoryview, ...]

TRUE: Final = 0x31
"""The vocab that means true: the character '1', not the number."""

_FLOAT32 = Struct("<f")


class Int8(int):
    """An integer sent in one byte, -128 to 127; OverflowError beyond."""

    __slots__ = ()

    def __new__(cls, value: int = 0) -> Self:
        return super().__new__(cls, _fitting(value, 8))


class Int16(int):
    """An integer sent in two bytes, -32768 to 32767; OverflowError beyond."""

    __slots__ = ()

    def __new__(cls, value: int = 0) -> Self:
        return super().__new__(cls, _fitting(value, 16))


class Int64(int):
    """An integer sent in eight bytes even if four would do; OverflowError beyond 64 bits."""

    __slots__ = ()

    def __new__(cls, value: int = 0) -> Self:
        return super().__new__(cls, _fitting(value, 64))


class Float32(float):
    """A number sent in single precision. It holds the rounded value; too large becomes inf."""

    __slots__ = ()

    def __new__(cls, value: float = 0.0) -> Self:
        try:
            rounded: float = _FLOAT32.unpack(_FLOAT32.pack(value))[0]
        except OverflowError:
            rounded = float("inf") if value > 0 else float("-inf")
        return super().__new__(cls, rounded)


class Vocab(str):
    """A word of at most four bytes that travels as one 32-bit integer, `code`.

    `Vocab("set") == "set"`. Longer text is cut to four bytes, as C++ does. A code that is no text
    (its top bit is set) reads as the empty string and keeps its code.
    """

    __slots__ = ("code",)
    code: int

    def __new__(cls, text: str = "") -> Self:
        if isinstance(text, Vocab):
            return cls.from_code(text.code)
        return cls.from_code(vocab_code(text.encode("utf-8", "surrogateescape")))

    @classmethod
    def from_code(cls, code: int) -> Self:
        """The vocab of a 32-bit integer, signed as it is on the wire."""
        self = super().__new__(cls, _vocab_text(code))
        self.code = code
        return self

    def __repr__(self) -> str:
        return f"Vocab({str.__repr__(self)})"


def vocab_code(word: bytes) -> int:
    """The integer of a word; bytes beyond the fourth do not count.

    C++ adds the bytes up as signed characters, so a byte above 127 borrows from its neighbour:
    `é` does not come back as `é`, and both sides agree on that.
    """
    code = 0
    for shift, byte in zip((0, 8, 16, 24), word, strict=False):
        code += (byte - ((byte & 0x80) << 1)) << shift
    return (code + 0x80000000 & 0xFFFFFFFF) - 0x80000000


@lru_cache(maxsize=4096)
def vocab_of(code: int) -> Vocab | bool:
    """Return the Python value of a decoded vocab: booleans are the vocabs 0 and '1'."""
    if code == TRUE:
        return True
    if code == 0:
        return False
    return Vocab.from_code(code)


def _vocab_text(code: int) -> str:
    if code < 0:
        return ""
    word = code.to_bytes(4, "little").replace(b"\0", b"")
    return word.decode("utf-8", "surrogateescape")


def fits(value: int, bits: int) -> bool:
    """Return whether a signed integer of `bits` bits can hold `value`.

    (Not `value in range(...)`: for an instance of a subclass of int, as Int8 is, that walks through
    all numbers of the range.)"""
    return -(1 << (bits - 1)) <= value < 1 << (bits - 1)


def _fitting(value: int, bits: int) -> int:
    if not fits(value, bits):
        raise OverflowError(f"{value} does not fit in {bits} bits; use a wider kind")
    return value
