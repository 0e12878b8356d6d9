"""Messages cut into datagrams, as udp and mcast do it: CRC-32, a sequence number, a piece.

Rules: pure. Numbers start at 0 with every message; a message of which a piece is missing, late or
damaged, or that is longer than the limit, is dropped whole and counted: anybody can send a
datagram, so none ends a connection. Number -1 is somebody waking their own reader: ignored.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from typing import Final
from zlib import crc32

from yarpy.wire.framing import INDEX
from yarpy.wire.stream import Buffer

_HEAD: Final = struct.Struct("<Ii")
MAX_DATAGRAM: Final = 65499  # what C++ sends at most
_INDEX_HEAD: Final = 18


def split(buffers: Sequence[Buffer], size: int = MAX_DATAGRAM) -> Iterator[bytes]:
    """The datagrams of one message, each at most `size` bytes with its eight-byte head."""
    data = memoryview(buffers[0] if len(buffers) == 1 else b"".join(buffers)).cast("B")
    room = size - _HEAD.size
    for sequence, start in enumerate(range(0, len(data), room)):
        piece = data[start : start + room]
        yield _HEAD.pack(crc32(piece), sequence) + piece


class Assembler:
    """Puts datagrams together again. `lost` counts messages that began and could not be
    finished."""

    def __init__(self, limit: int) -> None:
        self.limit = limit
        self.lost = 0
        self._parts: list[bytes] = []
        self._size = 0
        self._total = 0
        self._expected = 0

    def add(self, datagram: bytes) -> bytes | None:
        """Take one datagram; returns the message's bytes when it is whole."""
        if len(datagram) < _HEAD.size:
            self._drop()
            return None
        crc, sequence = _HEAD.unpack_from(datagram)
        if sequence == -1:
            return None
        piece = datagram[_HEAD.size :]
        if crc32(piece) != crc:
            if sequence == 0 or self._parts:  # else its message is given up already
                self._drop()
            return None
        if sequence == 0:
            if self._parts:
                self._drop()
            self._total = announced(piece)
            if self._total > self.limit:
                self._drop()
                return None
        elif sequence != self._expected or not self._parts:
            if self._parts:
                self._drop()
            return None
        self._parts.append(piece)
        self._size += len(piece)
        self._expected = sequence + 1
        if self._size < self._total:
            return None
        whole = piece if len(self._parts) == 1 else b"".join(self._parts)
        self._reset()
        return whole

    def _drop(self) -> None:
        self.lost += 1
        self._reset()

    def _reset(self) -> None:
        self._parts = []
        self._size = self._expected = self._total = 0


def announced(piece: bytes) -> int:
    """How long the message that begins with `piece` says it is."""
    if not piece.startswith(INDEX) or len(piece) < _INDEX_HEAD:
        return len(piece)
    count, replies = piece[8], piece[9]
    start = _INDEX_HEAD + 4 * (count + replies)
    if len(piece) < start:
        return len(piece)
    total: int = start + sum(struct.unpack_from(f"<{count}i", piece, _INDEX_HEAD))
    return total
