"""Loans: the payloads in shared memory that readers in other programs are told of.

Rules: a payload is lent until its writer is done with it and every reader that was told of it has
given it back, or lives no more. A reader says so in the ledger of its connection, which it alone
writes; a pipe whose other end it holds tells whether it lives.
"""

from __future__ import annotations

import mmap
import os
from typing import Final

from yarpy.transports.descriptor import Descriptor
from yarpy.transports.shared.shared_array import Source

SLOTS: Final = 256  # of one arena
LEDGER: Final = 4 * SLOTS  # bytes: for each slot the generation that was given back last


class Loan:
    """A payload that readers are told of. kept: its writer may tell others. holder: what keeps it
    where it lies, in our memory or (foreign) elsewhere."""

    __slots__ = ("foreign", "generation", "holder", "kept", "readers", "slot")

    def __init__(self, slot: int, generation: int, foreign: bool, holder: object) -> None:
        self.slot = slot
        self.generation = generation
        self.foreign = foreign
        self.holder = holder
        self.kept = True
        self.readers: list[Borrower] = []


class Placed:
    """A payload that can be lent, for as long as this object lives. arena: what lends it. source:
    the memory that it lies in."""

    __slots__ = ("arena", "generation", "loan", "offset", "size", "slot", "source")

    def __init__(self, arena: Source, loan: Loan, source: Source, offset: int, size: int) -> None:
        self.arena = arena
        self.loan = loan
        self.slot = loan.slot
        self.generation = loan.generation
        self.source = source
        self.offset = offset
        self.size = size

    def __del__(self) -> None:
        self.loan.kept = False


class Borrower:
    """The payloads that the reader of one connection has given back. Of the two descriptors the
    pipe becomes ours. Raises OSError."""

    def __init__(self, ledger: int, pipe: Descriptor) -> None:
        self._pipe = pipe
        self._memory = mmap.mmap(ledger, LEDGER)
        self._given_back = memoryview(self._memory).cast("I")
        self.ended = False  # the connection has

    def has(self, loan: Loan) -> bool:
        """Return whether the reader may still look at that payload."""
        if self._given_back[loan.slot] == loan.generation:
            return False
        return not self.ended or self._lives()

    def _lives(self) -> bool:
        """Return whether the other end of the pipe is open."""
        try:
            if os.read(self._pipe.fileno(), 1):
                return True  # it should not say anything
        except BlockingIOError:
            return True
        except (OSError, ValueError):
            pass  # ValueError: it was closed already
        self.close()
        return False

    def close(self) -> None:
        """Give the descriptor back."""
        self._pipe.close()
