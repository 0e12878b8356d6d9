"""Arena: the memory that a port writes large payloads into, for its readers in other programs.

    one file in memory of a port    SIZE bytes; pages that were never used cost nothing
    one ledger of each connection   SLOTS numbers, written by its reader alone: the generation of
                                    the last payload in that slot that it has given back
    one pipe of each connection     whose end the reader holds for as long as it can see the memory

Rules: nothing of it has a name, so nothing is left behind by programs that are killed. The file is
sealed: it cannot be made shorter, which would kill whoever reads it, and readers cannot write it. A
payload stays until its writer is done with it and every reader that was told of it has given it
back, or lives no more, also when its connection has ended.
"""

from __future__ import annotations

import mmap
import os
import threading
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final
from weakref import WeakValueDictionary

from yarpy.errors import LocalProtocolError
from yarpy.log import logger
from yarpy.wire.stream import Buffer

log = logger("yarpy.transports")

SIZE: Final = 1 << 28
SLOTS: Final = 256
LEDGER: Final = 4 * SLOTS  # bytes
PAGE: Final = mmap.PAGESIZE
_LARGE: Final = 1 << 18  # bytes; numpy copies them while other threads run
_LAST: Final = 0xFFFFFFFF  # of the generations

# fcntl, which not every system has, has names for these.
F_ADD_SEALS: Final = 1033
F_GET_SEALS: Final = 1034
F_SEAL_SHRINK: Final = 2
F_SEAL_GROW: Final = 4
_F_SEAL_FUTURE_WRITE: Final = 16  # since Linux 5.1: only who has mapped it already writes


def available() -> bool:
    """Whether this system has such memory: Linux."""
    return hasattr(os, "memfd_create")


def sealed_memory(name: str, size: int) -> int:
    """The descriptor of a file in memory that keeps its size. Raises OSError."""
    import fcntl

    number = os.memfd_create(name, os.MFD_CLOEXEC | os.MFD_ALLOW_SEALING)
    try:
        os.ftruncate(number, size)
        fcntl.fcntl(number, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW)
    except BaseException:
        os.close(number)
        raise
    return number


@dataclass(slots=True, eq=False)
class _Region:
    """Where a payload lies. kept: its writer may tell others of it."""

    slot: int
    generation: int
    offset: int
    end: int
    kept: bool = True
    readers: list[Reader] = field(default_factory=list)


class Placed:
    """A payload in an arena, for as long as this object lives."""

    __slots__ = ("arena", "generation", "offset", "region", "size", "slot")

    def __init__(self, arena: Arena, region: _Region, size: int) -> None:
        self.arena = arena
        self.region = region
        self.slot = region.slot
        self.generation = region.generation
        self.offset = region.offset
        self.size = size

    def __del__(self) -> None:
        self.region.kept = False


class Reader:
    """What the reader of one connection has given back. `ledger` and `pipe` are descriptors of
    ours."""

    def __init__(self, ledger: int, pipe: int) -> None:
        self._pipe = pipe
        try:
            self._memory = mmap.mmap(ledger, LEDGER)
        finally:
            os.close(ledger)
        self._given_back = memoryview(self._memory).cast("I")
        self.ended = False  # the connection has

    def has(self, region: _Region) -> bool:
        """Whether it may still look at that payload."""
        if self._given_back[region.slot] == region.generation:
            return False
        return not self.ended or self._lives()

    def _lives(self) -> bool:
        """Whether the other end of the pipe is open."""
        if self._pipe < 0:
            return False
        try:
            if os.read(self._pipe, 1):
                return True  # it should not say anything
        except BlockingIOError:
            return True
        except OSError:
            pass
        self.close()
        return False

    def close(self) -> None:
        """Give the descriptor back."""
        number, self._pipe = self._pipe, -1
        if number >= 0:
            os.close(number)

    def __del__(self) -> None:
        self.close()


class Arena:
    """Memory of the port called `name`. Raises LocalProtocolError where there is none to be had."""

    def __init__(self, name: str, size: int = SIZE) -> None:
        self.name = name
        self.size = size
        try:
            self.number = sealed_memory("yarpy", size)
        except OSError as error:
            raise LocalProtocolError(
                f"this system shares no memory ({error.strerror}); use the carrier tcp"
            ) from error
        try:
            self._memory = mmap.mmap(self.number, size)
            _forbid_writing(self.number)
        except (OSError, ValueError) as error:
            os.close(self.number)
            raise LocalProtocolError(f"no memory to share ({error}); use tcp") from error
        self._view = memoryview(self._memory)
        self._lock = threading.Lock()  # of what is below
        self._regions: list[_Region] = []  # that are in use, the lowest first
        self._generation = 0
        self._backed = 0  # bytes that the system has given us
        self._full = False

    def place(self, blocks: Sequence[Buffer], size: int) -> Placed | None:
        """Copy a payload in; None if there is no room."""
        with self._lock:
            region = self._take(size)
        if region is None:
            return None
        placed = Placed(self, region, size)
        start = region.offset
        for block in blocks:
            stop = start + len(block)
            _copy(self._view[start:stop], block)
            start = stop
        return placed

    def lend(self, placed: Placed, reader: Reader) -> bool:
        """`reader` is about to be told of it; False if it was already."""
        readers = placed.region.readers
        if placed.arena is not self or reader in readers:
            return False
        readers.append(reader)
        return True

    @property
    def used(self) -> int:
        """How many payloads lie there."""
        with self._lock:
            self._give_back()
            return len(self._regions)

    def _take(self, size: int) -> _Region | None:
        """Room for a payload: the lowest, since that is in the processor's cache."""
        self._give_back()
        need = -(-size // PAGE) * PAGE
        start = place = 0
        for region in self._regions:
            if region.offset - start >= need:
                break
            start = region.end
            place += 1
        end = start + need
        if end > self.size or len(self._regions) == SLOTS or not self._back(end):
            self._tell(size)
            return None
        if self._full:
            self._full = False
            log.warning(
                "%s: its readers have given memory back, large messages fit again", self.name
            )
        slots = {region.slot for region in self._regions}
        slot = next(number for number in range(SLOTS) if number not in slots)
        self._generation = self._generation % _LAST + 1
        found = _Region(slot, self._generation, start, end)
        self._regions.insert(place, found)
        return found

    def _give_back(self) -> None:
        """Forget the payloads that nobody can look at any more."""
        if any(not region.kept for region in self._regions):
            self._regions = [
                region
                for region in self._regions
                if region.kept or any(reader.has(region) for reader in region.readers)
            ]

    def _back(self, end: int) -> bool:
        """Have the system give us memory up to there, so that writing it cannot fail."""
        if end > self._backed:
            try:
                os.posix_fallocate(self.number, self._backed, end - self._backed)
            except OSError:
                return False
            self._backed = end
        return True

    def _tell(self, size: int) -> None:
        """Say once, until there is room again, that there is none."""
        if self._full or size > self.size:
            return
        self._full = True
        log.warning(
            "%s: readers keep %d large messages, so that there is no room for one of %d bytes in "
            "shared memory: it is sent as a copy, as over tcp. A program that keeps pictures for "
            "long should copy them (array.copy())",
            self.name,
            len(self._regions),
            size,
        )

    def __del__(self) -> None:
        number = getattr(self, "number", -1)
        if number >= 0:
            os.close(number)


def _forbid_writing(number: int) -> None:
    """From now on nobody else can map it for writing, where the system can do that."""
    import fcntl

    try:
        fcntl.fcntl(number, F_ADD_SEALS, _F_SEAL_FUTURE_WRITE)
    except OSError:
        pass  # an older Linux: readers are programs of the same user


def _copy(room: memoryview, block: Buffer) -> None:
    if len(block) < _LARGE:
        room[:] = block
        return
    import numpy as np

    np.copyto(np.frombuffer(room, np.uint8), np.frombuffer(block, np.uint8))


_ARENAS: Final[WeakValueDictionary[str, Arena]] = WeakValueDictionary()
_OPENING: Final = threading.Lock()


def arena_of(name: str) -> Arena:
    """The arena of the port called `name`, which all its connections share. Raises
    LocalProtocolError."""
    with _OPENING:
        found = _ARENAS.get(name)
        if found is None:
            found = _ARENAS[name] = Arena(name)
        return found
