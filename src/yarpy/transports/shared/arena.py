"""Arena: the memory that a port writes large payloads into, for its readers in other programs.

    one file in memory of a port    SIZE bytes; pages that were never used cost nothing
    one ledger of each connection   SLOTS numbers, written by its reader alone: the generation of
                                    the last payload in that slot that it has given back
    one pipe of each connection     whose end the reader holds for as long as it can see the memory

Rules: nothing of it has a name, so nothing is left behind by programs that are killed. The file is
sealed: it cannot be made shorter, which would kill whoever reads it, and readers cannot write it. A
payload stays until its writer is done with it and every reader that was told of it has given it
back, or lives no more, also when its connection has ended. What lies in shared memory already,
received or filled in there, is lent as it lies.
"""

from __future__ import annotations

import mmap
import os
import sys
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final
from weakref import WeakValueDictionary

from yarpy import fork
from yarpy.data.python.loaded import loaded
from yarpy.errors import LocalProtocolError
from yarpy.log import logger
from yarpy.transports.shared.cgroup import free_memory
from yarpy.transports.shared.loan import SLOTS, Borrower, Loan, Placed
from yarpy.transports.shared.sealed import forbid_writing, sealed_memory
from yarpy.transports.shared.shared_array import (
    HEADROOM,
    Source,
    address_of,
    place_of,
    shared_array_type,
)
from yarpy.wire.stream import Buffer

log = logger("yarpy.transports")

SIZE: Final = 1 << 28
PAGE: Final = mmap.PAGESIZE
CALM: Final = 10.0  # seconds with room until the log says that there is room again
_LARGE: Final = 1 << 18  # bytes; numpy copies them while other threads run
_LAST: Final = 0xFFFFFFFF  # of the generations


@dataclass(slots=True, eq=False)
class _Span:
    """Room in the file. used: something lies there, or is about to."""

    offset: int
    end: int
    used: bool = True


class _Mapped:
    """The memory of an arena, as its extents know it. They do not know the arena, which ends with
    its port."""

    def __init__(self, memory: mmap.mmap) -> None:
        self.view = memoryview(memory)
        lock: Any = threading.RLock()  # of all that an arena notes
        self.lock = lock
        # By this thread: a signal handler has come above a frame that takes notes. It goes without.
        self.held: Callable[[], bool] = lock._is_owned
        self.freed = False  # some room is


class Extent:
    """Room in an arena, for as long as this object lives. A program that fills it itself leaves
    HEADROOM in front of its array."""

    __slots__ = ("_head", "_mapped", "_span", "offset")

    def __init__(self, mapped: _Mapped, span: _Span) -> None:
        self._mapped = mapped
        self._span = span
        self.offset = span.offset
        self._head: bytes | None = None

    def begin(self, head: bytes) -> bool:
        """Put that in front of the array; False if it has been sent with something else there."""
        mapped = self._mapped
        with mapped.lock:
            if self._head is None:
                self._head = head
                stop = self.offset + HEADROOM
                mapped.view[stop - len(head) : stop] = head
            return self._head == head

    def __del__(self) -> None:
        self._span.used = False  # in whatever thread: no lock is taken
        self._mapped.freed = True


class Arena:
    """Memory of the port called `name`. Raises LocalProtocolError where there is none to be had."""

    def __init__(self, name: str, size: int = SIZE) -> None:
        self.name = name
        self.size = size
        try:
            self._file = sealed_memory("yarpy", size)
        except OSError as error:
            raise LocalProtocolError(
                f"this system shares no memory ({error.strerror}); use the carrier tcp"
            ) from error
        try:
            self._memory = mmap.mmap(self.number, size)
            forbid_writing(self.number)
        except (OSError, ValueError) as error:
            raise LocalProtocolError(f"no memory to share ({error}); use tcp") from error
        self._mapped = _Mapped(self._memory)
        self.view = self._mapped.view
        self._lock = self._mapped.lock  # of what is below
        self._spans: list[_Span] = []  # that are in use, the lowest first
        self._loans: list[Loan] = []
        self._relayed = 0  # of these lie in other memory
        self._slots = [*range(SLOTS - 1, -1, -1)]  # that are free
        self._generation = 0
        self._backed = 0  # bytes that the system has given us
        self._full = self._scarce = False
        self._lacked = 0.0  # when there was no room, last

    @property
    def number(self) -> int:
        """Return the descriptor of its file."""
        return self._file.fileno()

    @property
    def descriptors(self) -> tuple[int, ...]:
        """Return the descriptors by which others see it. No pipe: we keep what lies there, and
        after us nobody writes."""
        return (self.number,)

    @cached_property
    def address(self) -> int:
        """The address where it is mapped."""
        return address_of(self._memory)

    def place(self, blocks: Sequence[Buffer], size: int) -> Placed | None:
        """Take a payload in, copied unless it lies in shared memory; None if there is no room."""
        if self._mapped.held():
            return None
        found = place_of(blocks)
        if found is not None:
            source, offset, holder = found
            with self._lock:
                loan = self._lend(source, holder)
            if loan is not None:
                return Placed(self, loan, source, offset, size)
        with self._lock:
            extent = self._take(size)
            loan = None if extent is None else self._lend(self, extent)
            if extent is None or loan is None:
                self._tell(size)
                return None
            self._say_room()
        placed = Placed(self, loan, self, extent.offset, size)
        start = extent.offset
        for block in blocks:
            stop = start + len(block)
            _copy(self.view[start:stop], block)
            start = stop
        return placed

    def prepare(self, size: int) -> Any:
        """Room for a program to fill, as an array of bytes that has HEADROOM in front; None if
        there is none."""
        if self._mapped.held():
            return None
        with self._lock:
            extent = self._take(HEADROOM + size)
        if extent is None:
            return None
        shared = shared_array_type()(HEADROOM + size, "u1", self._memory, extent.offset)
        shared.source, shared.offset, shared.room = self, extent.offset, extent
        return shared

    def lend(self, placed: Placed, reader: Borrower) -> bool:
        """`reader` is about to be told of it; False if it was already."""
        readers = placed.loan.readers
        if placed.arena is not self or reader in readers:
            return False
        readers.append(reader)
        return True

    def recall(self, placed: Placed, reader: Borrower) -> None:
        """`reader` was not told of it."""
        placed.loan.readers.remove(reader)

    @property
    def used(self) -> int:
        """The number of payloads that are lent, or about to be."""
        self.tidy()
        return len(self._loans)

    def tidy(self) -> None:
        """Give back what nobody can look at any more."""
        if not self._mapped.held():
            with self._lock:
                self._give_back()

    def _lend(self, source: Source, holder: object) -> Loan | None:
        """A slot for a payload, None if all are taken."""
        if not self._slots:
            self._give_back()
            if not self._slots:
                return None
        self._generation = self._generation % _LAST + 1
        loan = Loan(self._slots.pop(), self._generation, source is not self, holder)
        self._loans.append(loan)
        if loan.foreign:
            self._relayed += 1
            _ARENAS.relaying.add(self)
        return loan

    def _take(self, size: int) -> Extent | None:
        """Room for a payload: the lowest, since that is in the processor's cache."""
        self._give_back()
        need = -(-size // PAGE) * PAGE
        start = place = 0
        for span in self._spans:
            if span.offset - start >= need:
                break
            start = span.end
            place += 1
        end = start + need
        if end > self.size or not self._back(end):
            return None
        span = _Span(start, end)
        self._spans.insert(place, span)
        return Extent(self._mapped, span)

    def _give_back(self) -> None:
        """Forget the payloads that nobody can look at any more."""
        for loan in [loan for loan in self._loans if not loan.kept]:
            for reader in loan.readers:
                if reader.has(loan):
                    break
            else:
                self._loans.remove(loan)
                self._slots.append(loan.slot)
                loan.holder = None
                if loan.foreign:
                    self._relayed -= 1
                    if not self._relayed:
                        _ARENAS.relaying.discard(self)
        if self._mapped.freed:
            self._mapped.freed = False
            self._spans = [span for span in self._spans if span.used]

    def _back(self, end: int) -> bool:
        """Have the system give us memory up to there, so that writing it cannot fail."""
        if sys.platform != "linux":
            raise NotImplementedError
        if end > self._backed:
            # The system would kill a program rather than say no, and programs need memory, too.
            self._scarce = end - self._backed > free_memory() / 4
            if self._scarce:
                return False
            try:
                os.posix_fallocate(self.number, self._backed, end - self._backed)
            except OSError:
                self._scarce = True
                return False
            self._backed = end
        return True

    def _tell(self, size: int) -> None:
        """Say once, until there is room again, that there is none."""
        if size > self.size:
            return
        self._lacked = time.monotonic()
        if self._full:
            return
        self._full = True
        why = f"readers keep {len(self._loans)} large messages"
        if self._scarce:
            why += ", and this computer or container has hardly any memory left"
        log.warning(
            "%s: %s, so that there is no room for one of %d bytes in shared memory: it is sent as "
            "a copy, as over tcp. A program that keeps pictures for long should copy them "
            "(array.copy())",
            self.name,
            why,
            size,
        )

    def _say_room(self) -> None:
        # A reader that stays behind makes room for one message after the other.
        if self._full and time.monotonic() - self._lacked > CALM:
            self._full = False
            log.warning(
                "%s: its readers have given memory back, large messages fit again", self.name
            )


def _copy(room: memoryview, block: Buffer) -> None:
    if len(block) < _LARGE:
        room[:] = block
        return
    np = loaded("numpy")
    if np is None:  # its import may take longer than the writer has
        room[:] = block
    else:  # other threads go on meanwhile
        np.copyto(np.frombuffer(room, np.uint8), np.frombuffer(block, np.uint8))


class _Arenas:
    """Those of this process: by the names of their ports, and those that have lent what lies in
    other memory. Readers may look at that when the port itself is not needed any more."""

    def __init__(self) -> None:
        self.start_over()

    def start_over(self) -> None:
        """In a forked process: what the parent writes to is the parent's alone."""
        self.relaying: set[Arena] = set()
        self._named: WeakValueDictionary[str, Arena] = WeakValueDictionary()
        self._opening = threading.RLock()  # one arena for each name

    def of(self, name: str) -> Arena:
        """See `arena_of`."""
        with self._opening:
            found = self._named.get(name)
            if found is None:
                found = self._named[name] = Arena(name)
            return found


_ARENAS: Final = _Arenas()
fork.after_in_child(_ARENAS.start_over)


def arena_of(name: str) -> Arena:
    """The arena of the port called `name`, which all its connections share. Raises
    LocalProtocolError."""
    return _ARENAS.of(name)


def tidy() -> None:
    """Give back to other programs what our readers have done with. To be called now and then: it is
    not told to us."""
    if _ARENAS.relaying:
        for arena in tuple(_ARENAS.relaying):
            arena.tidy()
