"""Loans: until when a reader counts, by its ledger and by its pipe."""

from __future__ import annotations

import gc
import mmap
import os
from collections.abc import Iterator

import pytest

from yarpy.transports.descriptor import owned
from yarpy.transports.shared.loan import LEDGER, SLOTS, Borrower, Loan, Placed
from yarpy.transports.shared.sealed import available, sealed_memory

pytestmark = pytest.mark.skipif(not available(), reason="this system has no such memory")


class Memory:
    """Memory that a payload lies in."""

    address = 0
    descriptors = ()


class Reader:
    """What the reader of a connection has: the ledger that it writes, and its end of the pipe."""

    def __init__(self) -> None:
        file = sealed_memory("test", LEDGER)
        self.ledger = memoryview(mmap.mmap(file.fileno(), LEDGER)).cast("I")
        ours, self.pipe = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)
        self.borrower = Borrower(file.fileno(), *owned([ours]))

    def die(self) -> None:
        if self.pipe >= 0:
            os.close(self.pipe)
            self.pipe = -1


@pytest.fixture
def reader() -> Iterator[Reader]:
    reader = Reader()
    yield reader
    reader.die()


def test_a_reader_has_it_until_its_ledger_says_that_generation(reader: Reader) -> None:
    loan = Loan(SLOTS - 1, 7, False, None)
    assert reader.borrower.has(loan)
    reader.ledger[SLOTS - 1] = 6  # one before it in that slot
    assert reader.borrower.has(loan)
    reader.ledger[SLOTS - 1] = 7
    assert not reader.borrower.has(loan)
    assert reader.borrower.has(Loan(0, 7, False, None))  # the same generation elsewhere


def test_the_end_of_the_connection_is_not_that_of_the_reader(reader: Reader) -> None:
    loan = Loan(3, 1, False, None)
    reader.borrower.ended = True
    assert reader.borrower.has(loan)
    os.write(reader.pipe, b"!")  # which it should not
    assert reader.borrower.has(loan)
    reader.die()
    assert not reader.borrower.has(loan)
    assert not reader.borrower.has(loan)  # its descriptor is given back already


def test_while_the_connection_lives_nobody_looks_at_the_pipe(reader: Reader) -> None:
    reader.die()
    assert reader.borrower.has(Loan(3, 1, False, None))


def test_a_writer_is_done_when_nothing_of_it_is_left() -> None:
    loan, memory = Loan(2, 9, False, None), Memory()
    placed = Placed(memory, loan, memory, 64, 10)
    assert (placed.slot, placed.generation, placed.offset, placed.size) == (2, 9, 64, 10)
    assert loan.kept
    del placed
    gc.collect()
    assert not loan.kept
