"""The messages of an MCAP file in the order in which they were received.

Rules: one chunk at a time is in memory, and those that overlap with it in time, up to `OPEN` bytes
of them; what overlaps beyond that comes in the order of the file. A damaged chunk is left out and
told in `damages`; the others are read. For one thread at a time.
"""

from __future__ import annotations

import heapq
import os
from array import array
from collections.abc import Container, Iterator
from pathlib import Path
from typing import Final, Self

from yarpy.errors import DecodeError, MissingFile
from yarpy.kits.record.mcap.attachment import Attachment
from yarpy.kits.record.mcap.index import (
    Index,
    Window,
    attachment_at,
    chunk_at,
    read_index,
    records_of,
)
from yarpy.kits.record.mcap.layout import MESSAGE, MESSAGE_HEAD, Channel, Damaged, Record
from yarpy.limit import RECORDED_CHUNK
from yarpy.platform.refusal import reason

OPEN: Final = RECORDED_CHUNK  # bytes of chunks that are read side by side
_DAMAGES: Final = 1000  # that are told
_FOREVER: Final = (1 << 64) - 1


class McapFile:
    """A file at `path`, finished or not. Raises MissingFile; DecodeError if it is no MCAP file.

    `index` says what is in it. `damages` grows while messages are read.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        try:
            self._handle = os.open(path, os.O_RDONLY | getattr(os, "O_BINARY", 0))
        except OSError as error:
            raise MissingFile(f"{path} cannot be read: {reason(error)}") from error
        try:
            self._window = Window(self._handle)
            self.index: Index = read_index(self._window)
        except DecodeError as error:
            os.close(self._handle)
            raise DecodeError(f"{path}: {error}") from error
        except BaseException:
            os.close(self._handle)
            raise
        self._closed = False

    @property
    def size(self) -> int:
        """Return the size of the file in bytes, as it was when it was opened."""
        return self._window.size

    def attached(self, found: Attachment) -> bytes:
        """Return what is in an attachment of `index`. Raises Damaged."""
        return attachment_at(self._window, found)

    @property
    def channels(self) -> dict[int, Channel]:
        """Return what each number of a channel stands for."""
        return self.index.channels

    @property
    def damages(self) -> list[Damaged]:
        """Return what was found that is not what was written."""
        return self.index.damages

    def records(
        self,
        channels: Container[int] | None = None,
        begin: int = 0,
        end: int = _FOREVER,
    ) -> Iterator[Record]:
        """Yield the messages of these channels (None: all) that were received from `begin` until
        before `end`, in nanoseconds since 1970. Raises UnknownPlugin where the chunks are
        compressed and the library is missing."""
        firsts, lasts = self.index.firsts, self.index.lasts
        wanted = [n for n in range(len(firsts)) if firsts[n] < end and lasts[n] >= begin]
        wanted.sort(key=firsts.__getitem__)
        side = _SideBySide()
        for number in wanted:
            yield from side.until(firsts[number])
            while side.held > OPEN:
                yield side.next()
            part = self._open(number, channels, begin, end)
            if part is not None:
                side.add(number, part)
        yield from side.until(_FOREVER)

    def _open(
        self, number: int, channels: Container[int] | None, begin: int, end: int
    ) -> _Part | None:
        """Return the wanted messages of a chunk; None if there are none."""
        index = self.index
        place, length = index.places[number], index.lengths[number]
        try:
            if index.bare[number]:
                data, start = memoryview(self._window.at(place, length)), place
            else:
                data, start = chunk_at(self._window, place, length)
        except Damaged as damage:
            self._tell(damage)
            return None
        part = _Part(data)
        try:
            for opcode, body, where in records_of(data, start):
                if opcode != MESSAGE:
                    if opcode in (3, 4):
                        index.describe(opcode, body, where)
                    continue
                if len(body) < MESSAGE_HEAD.size:
                    raise Damaged(where, f"a message of {len(body)} bytes")
                channel, _, received, _ = MESSAGE_HEAD.unpack_from(body)
                if begin <= received < end and (channels is None or channel in channels):
                    part.add(where - start, len(body), received)
        except Damaged as damage:
            self._tell(damage)
        part.sort()
        return part if part.left else None

    def _tell(self, damage: Damaged) -> None:
        known = self.index.damages
        if len(known) < _DAMAGES and all(damage.byte != one.byte for one in known):
            known.append(damage)

    def close(self) -> None:
        """Close the file; views of messages stay."""
        if not self._closed:
            self._closed = True
            os.close(self._handle)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()


class _Part:
    """The wanted messages of a chunk that were not read yet, 24 bytes for each."""

    def __init__(self, data: memoryview) -> None:
        self._data = data
        self._offsets = array("Q")
        self._sizes = array("Q")
        self._times = array("Q")
        self._at = 0

    @property
    def size(self) -> int:
        """Return how many bytes of memory it takes."""
        return len(self._data) + 24 * len(self._times)

    @property
    def left(self) -> int:
        """Return how many messages were not read."""
        return len(self._times) - self._at

    @property
    def time(self) -> int:
        """Return when the next message was received."""
        return self._times[self._at]

    def add(self, offset: int, size: int, received: int) -> None:
        """Add a message."""
        self._offsets.append(offset)
        self._sizes.append(size)
        self._times.append(received)

    def sort(self) -> None:
        """Put messages in the order of their receipt; those of the same time stay in theirs."""
        times = self._times
        if all(map(int.__le__, times, times[1:])):
            return
        import numpy as np

        order = np.argsort(np.frombuffer(times, "u8"), kind="stable")
        for name in ("_offsets", "_sizes", "_times"):
            sorted_ = np.frombuffer(getattr(self, name), "u8")[order]
            setattr(self, name, array("Q", sorted_.tobytes()))

    def next(self) -> Record:
        """Return the next message."""
        at = self._at
        self._at = at + 1
        offset, size = self._offsets[at], self._sizes[at]
        head = MESSAGE_HEAD.unpack_from(self._data, offset)
        return Record._make((*head, self._data[offset + MESSAGE_HEAD.size : offset + size]))

    def until(self, last: int) -> Iterator[Record]:
        """Yield the messages that were received no later than `last`."""
        times = self._times
        while self._at < len(times) and times[self._at] <= last:
            yield self.next()


class _SideBySide:
    """Chunks whose times overlap. `held`: the bytes of memory that they take."""

    def __init__(self) -> None:
        self._parts: list[tuple[int, int, _Part]] = []  # a heap: time, number of the chunk
        self.held = 0

    def add(self, number: int, part: _Part) -> None:
        """Read a chunk with messages beside the others."""
        self.held += part.size
        heapq.heappush(self._parts, (part.time, number, part))

    def next(self) -> Record:
        """Return the message that was received first."""
        _, number, part = self._parts[0]
        found = part.next()
        self._settle(number, part)
        return found

    def until(self, last: int) -> Iterator[Record]:
        """Yield the messages that were received no later than `last`."""
        parts = self._parts
        while parts and parts[0][0] <= last:
            if len(parts) == 1:
                _, number, part = parts[0]
                yield from part.until(last)
                self._settle(number, part)
            else:
                yield self.next()

    def _settle(self, number: int, part: _Part) -> None:
        """Messages of the first chunk were read."""
        if part.left:
            heapq.heapreplace(self._parts, (part.time, number, part))
        else:
            heapq.heappop(self._parts)
            self.held -= part.size
