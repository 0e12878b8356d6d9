"""Memory for what is put into Zenoh in one piece, used again: fresh memory of the size of a picture
costs several times as much as copying does.

Rules: Zenoh has copied what `put` was given when that returns; then it is given back here. Any
thread may call anything.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from yarpy.wire.stream import Buffer

LARGE: Final = 1 << 16  # bytes from which on memory is kept for the next
POOLED: Final = 2  # pieces of different sizes: of a message in pieces, the first and the last


class Spare:
    """The memory of one publisher."""

    def __init__(self) -> None:
        self._free: dict[int, bytearray] = {}  # by size

    def join(self, pieces: Sequence[Buffer]) -> bytes | bytearray:
        """Return these bytes in one piece, which may be given back."""
        size = sum(map(len, pieces))
        if size < LARGE:
            return b"".join(pieces)
        data = self._free.pop(size, None) or bytearray(size)
        with memoryview(data) as view:
            end = 0
            for piece in pieces:
                begin, end = end, end + len(piece)
                view[begin:end] = piece
        return data

    def give_back(self, data: bytes | bytearray) -> None:
        """Nobody looks at it any more."""
        if type(data) is bytearray:
            if len(self._free) >= POOLED:
                self._free.clear()
            self._free[len(data)] = data
