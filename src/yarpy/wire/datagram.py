"""Messages cut into datagrams, as udp and mcast do it: CRC-32, a sequence number, a piece.

Rules: pure. Numbers start at 0 with every message; a message of which a piece is missing, late or
damaged, or that is longer than the limit, is dropped whole and counted: anybody can send a
datagram, so none ends a connection. Number -1 is a program waking its own reader: ignored.
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
_NEW: Final = 1 << 31  # above the number of any piece


def split(buffers: Sequence[Buffer], size: int = MAX_DATAGRAM) -> Iterator[bytes]:
    """The datagrams of one message, each at most `size` bytes with its eight-byte head."""
    data = memoryview(buffers[0] if len(buffers) == 1 else b"".join(buffers)).cast("B")
    room = size - _HEAD.size
    for sequence, start in enumerate(range(0, len(data), room)):
        piece = data[start : start + room]
        yield _HEAD.pack(crc32(piece), sequence) + piece


class Assembler:
    """Puts datagrams together again. `lost` counts messages of which something came and could not
    be used; a message that was on its way when we joined is not among them."""

    def __init__(self, limit: int) -> None:
        self.limit = limit
        self.lost = 0
        # One buffer, so that a million tiny pieces take no more memory than their bytes.
        self._data: bytearray | None = None  # what has come of a message; None: none is begun
        self._total = 0
        # The piece that comes next. While none is begun, lower numbers are of a message whose
        # beginning did not come; this number and higher ones, of a message that was given up
        # already.
        self._expected = 0
        self._late = 0  # the missing piece that made us give a message up; 0: none

    @property
    def idle(self) -> bool:
        """Return whether no part of an unfinished message is held."""
        return self._data is None

    def add(self, datagram: bytes) -> bytes | bytearray | None:
        """Take one datagram; returns the message's bytes when it is whole."""
        if len(datagram) < _HEAD.size:
            self._give_up(0)
            return None
        crc, sequence = _HEAD.unpack_from(datagram)
        if sequence == -1:
            return None
        piece = memoryview(datagram)[_HEAD.size :]
        if sequence == 0 and self._data is not None:
            self._give_up(0)  # its end was lost
        if crc32(piece) != crc:
            if sequence == 0 or self._data is not None:
                self._give_up(sequence + 1)
            return None
        if sequence == 0:
            self._data = bytearray()
            self._total = announced(piece)
            if self._total > self.limit:
                self._give_up(1)
                return None
        elif self._data is None or sequence != self._expected:
            self._skip(sequence)
            return None
        self._data += piece
        self._expected = sequence + 1
        if len(self._data) < self._total:
            return None
        whole, self._data = self._data, None
        self._expected = _NEW
        return whole

    def _skip(self, sequence: int) -> None:
        """A piece that does not continue the message begun."""
        if self._data is not None:
            late = self._expected
            self._give_up(late)
            self._late = late
        elif sequence == self._late:
            self._late = 0  # overtaken on the way
            return
        if sequence < self._expected:
            self.lost += 1
        self._expected = sequence + 1

    def _give_up(self, expected: int) -> None:
        self.lost += 1
        self._data = None
        self._expected = expected
        self._late = 0


def announced(piece: Buffer) -> int:
    """Return the length of the message that begins with `piece`, as it says itself."""
    if bytes(piece[: len(INDEX)]) != INDEX or len(piece) < _INDEX_HEAD:
        return len(piece)
    count, replies = piece[8], piece[9]
    start = _INDEX_HEAD + 4 * (count + replies)
    if len(piece) < start:
        return len(piece)
    total: int = start + sum(struct.unpack_from(f"<{count}i", piece, _INDEX_HEAD))
    return total
