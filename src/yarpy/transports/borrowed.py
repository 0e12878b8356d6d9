"""Borrowed: memory of another program that large payloads are looked at in.

Rules: what comes from there is not trusted: a file that could become shorter under us, which the
system answers by killing who reads it, is refused, and so is a place outside of it. A payload is
given back when the last view of it is gone, in whatever thread that happens: by a number in the
ledger, which takes no lock and no system call.
"""

from __future__ import annotations

import mmap
import os
import stat
from functools import cache
from typing import Any, Final

from yarpy.errors import RemoteProtocolError
from yarpy.transports.arena import F_GET_SEALS, F_SEAL_SHRINK, LEDGER, SLOTS, sealed_memory

LARGEST: Final = 1 << 32  # bytes of a file that we map
_ALIEN: Final = "the peer hands over {}, not shared memory that it cannot take away again"


class Borrowed:
    """What the sender of one connection shows us, by three descriptors, which become ours: its
    file, the ledger, and a pipe to be held for as long as we look. Raises RemoteProtocolError."""

    def __init__(self, file: int, ledger: int, pipe: int) -> None:
        self._pipe = pipe
        try:
            if not stat.S_ISFIFO(os.fstat(pipe).st_mode):
                raise RemoteProtocolError(_ALIEN.format("no pipe"))
            self.size = _checked(file)
            if _checked(ledger) < LEDGER:
                raise RemoteProtocolError(_ALIEN.format("a ledger that is too short"))
            try:
                self._memory = mmap.mmap(file, self.size, prot=mmap.PROT_READ)
                self._ledger = mmap.mmap(ledger, LEDGER)
            except (OSError, ValueError) as error:
                raise RemoteProtocolError(f"memory that cannot be looked at ({error})") from error
        finally:
            os.close(file)
            os.close(ledger)
        self._given_back = memoryview(self._ledger).cast("I")

    def take(self, slot: int, generation: int, offset: int, size: int) -> memoryview:
        """A payload, read-only; it keeps this object alive. Raises RemoteProtocolError."""
        if slot >= SLOTS or size > self.size or offset > self.size - size:
            raise RemoteProtocolError(
                f"a payload of {size} bytes at {offset} of memory that has {self.size}"
            )
        lease = _lease()(size, "u1", self._memory, offset)
        lease.terms = self, slot, generation
        return memoryview(lease)

    def give_back(self, slot: int, generation: int) -> None:
        """Nobody looks at that payload any more."""
        self._given_back[slot] = generation

    def __del__(self) -> None:
        os.close(self._pipe)


def _checked(number: int) -> int:
    """The size of a file that keeps it. Raises RemoteProtocolError."""
    import fcntl

    try:
        seals = fcntl.fcntl(number, F_GET_SEALS)
    except OSError:
        raise RemoteProtocolError(_ALIEN.format("a file of another kind")) from None
    found = os.fstat(number)
    # Files of huge pages have seals as well, but need not have the memory.
    if not seals & F_SEAL_SHRINK or found.st_dev != _device():
        raise RemoteProtocolError(_ALIEN.format("a file that may become shorter"))
    if found.st_size > LARGEST:
        raise RemoteProtocolError(f"a file of {found.st_size} bytes; at most {LARGEST} are mapped")
    return found.st_size


@cache
def _device() -> int:
    """Where ordinary files in memory lie."""
    number = sealed_memory("yarpy", 0)
    try:
        return os.fstat(number).st_dev
    finally:
        os.close(number)


@cache
def _lease() -> Any:
    """The class of what views are taken of: an array, since these can be over a part of a file."""
    import numpy as np

    class Lease(np.ndarray[Any, np.dtype[np.uint8]]):
        """Gives back what it was over once it is gone."""

        terms: tuple[Borrowed, int, int] | None = None

        def __del__(self) -> None:
            if self.terms is not None:
                memory, slot, generation = self.terms
                memory.give_back(slot, generation)

    return Lease
