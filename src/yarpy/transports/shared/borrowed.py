"""Borrowed: memory of other programs that large payloads are looked at in.

Rules: what comes from there is not trusted: a file that could become shorter under us, which the
system answers by killing who reads it, is refused, and so is a place outside of it. A payload is
given back when the last view of it is gone, in whatever thread that happens: by a number in the
ledger, which takes no lock and no system call. A sender may show us memory that it has received
from others; then we hold their pipe, too, so that they know. A forked process gives nothing back.
"""

from __future__ import annotations

import mmap
import os
import stat
import sys
from collections.abc import Sequence
from functools import cache, cached_property, partial
from typing import Final

from yarpy.errors import RemoteProtocolError
from yarpy.transports.descriptor import Descriptor, owned
from yarpy.transports.shared.loan import LEDGER, SLOTS
from yarpy.transports.shared.sealed import F_GET_SEALS, F_SEAL_SHRINK, sealed_memory
from yarpy.transports.shared.shared_array import LENDERS, address_of, shared_array_type

LARGEST: Final = 1 << 32  # bytes of a file that we map
OTHERS: Final = 8  # files of other programs that one sender shows us at a time
_ALIEN: Final = "the peer hands over {}, not shared memory that it cannot take away again"


class Shown:
    """A file of another program that is mapped here, and a pipe, if there is one, that is held for
    as long. Both become ours. Raises RemoteProtocolError."""

    def __init__(self, file: Descriptor, *pipe: Descriptor) -> None:
        self._files = (file, *pipe)
        if any(not stat.S_ISFIFO(os.fstat(each.fileno()).st_mode) for each in pipe):
            raise RemoteProtocolError(_ALIEN.format("no pipe"))
        self.size = _checked(file)
        try:
            self.memory = mmap.mmap(file.fileno(), self.size, access=mmap.ACCESS_READ)
        except (OSError, ValueError) as error:
            raise RemoteProtocolError(f"memory that cannot be looked at ({error})") from error

    @cached_property
    def address(self) -> int:
        """The address where it is mapped."""
        return address_of(self.memory)

    @property
    def descriptors(self) -> tuple[int, ...]:
        """Return the descriptors by which others can see it."""
        return tuple(file.fileno() for file in self._files)


class Borrowed:
    """The memory that the sender of one connection shows us, by three descriptors, which become
    ours: its file, the ledger, and a pipe to be held for as long as we look. Raises
    RemoteProtocolError."""

    def __init__(self, file: int, ledger: int, pipe: int) -> None:
        shown, book, held = adopted([file, ledger, pipe])
        self._shown: list[Shown | None] = [Shown(shown, held), *[None] * OTHERS]
        if _checked(book) < LEDGER:
            raise RemoteProtocolError(_ALIEN.format("a ledger that is too short"))
        try:
            self._ledger = mmap.mmap(ledger, LEDGER)
        except (OSError, ValueError) as error:
            raise RemoteProtocolError(f"memory that cannot be looked at ({error})") from error
        self._given_back = memoryview(self._ledger).cast("I")
        LENDERS.add(self)

    def show(self, number: int, shown: Shown) -> None:
        """From now on `number`, up to OTHERS, is that memory of another program."""
        self._shown[number] = shown

    def take(self, number: int, slot: int, generation: int, offset: int, size: int) -> memoryview:
        """A payload, read-only; it keeps this object alive. Raises RemoteProtocolError."""
        shown = self._shown[number] if number <= OTHERS else None
        if shown is None:
            raise RemoteProtocolError(f"memory number {number}, which was never shown")
        if slot >= SLOTS or size > shown.size or offset > shown.size - size:
            raise RemoteProtocolError(
                f"a payload of {size} bytes at {offset} of memory that has {shown.size}"
            )
        shared = shared_array_type()(size, "u1", shown.memory, offset)
        shared.source, shared.offset = shown, offset
        view, ended = memoryview(shared), partial(self.give_back, slot, generation)
        shared.ended = ended  # last: what is taken and not returned is given back, and gone
        return view

    def give_back(self, slot: int, generation: int) -> None:
        """Nobody looks at that payload any more."""
        self._given_back[slot] = generation

    def disown(self) -> None:
        """From now on nothing is given back."""
        self._given_back = memoryview(bytearray(LEDGER)).cast("I")


def adopted(numbers: Sequence[int]) -> list[Descriptor]:
    """Return descriptors that a peer has handed over, which are ours now. Raises
    RemoteProtocolError; then they are closed."""
    try:
        return owned(numbers)
    except OSError:
        raise RemoteProtocolError(_ALIEN.format("a directory")) from None


def _checked(file: Descriptor) -> int:
    """The size of a file that keeps it. Raises RemoteProtocolError."""
    if sys.platform != "linux":
        raise NotImplementedError
    import fcntl

    try:
        seals = fcntl.fcntl(file, F_GET_SEALS)
    except OSError:
        raise RemoteProtocolError(_ALIEN.format("a file of another kind")) from None
    found = os.fstat(file.fileno())
    # Files of huge pages have seals as well, but need not have the memory.
    if not seals & F_SEAL_SHRINK or found.st_dev != _device():
        raise RemoteProtocolError(_ALIEN.format("a file that may become shorter"))
    if found.st_size > LARGEST:
        raise RemoteProtocolError(f"a file of {found.st_size} bytes; at most {LARGEST} are mapped")
    return found.st_size


@cache
def _device() -> int:
    """Return the device on which ordinary files in memory lie."""
    file = sealed_memory("yarpy", 0)
    return os.fstat(file.fileno()).st_dev
