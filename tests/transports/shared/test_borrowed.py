"""Borrowed: what is looked at, when it is given back, and descriptors that are refused."""

from __future__ import annotations

import gc
import mmap
import os
import pickle
from pathlib import Path

import numpy as np
import pytest

from yarpy.errors import RemoteProtocolError
from yarpy.transports.descriptor import owned
from yarpy.transports.shared.arena import PAGE, Arena
from yarpy.transports.shared.borrowed import OTHERS, Borrowed, Shown
from yarpy.transports.shared.loan import LEDGER
from yarpy.transports.shared.sealed import available, sealed_memory

pytestmark = pytest.mark.skipif(not available(), reason="this system has no such memory")


def sealed(name: str, size: int) -> int:
    """The descriptor of a file that keeps its size, to be given away."""
    file = sealed_memory(name, size)
    return os.dup(file.fileno())


class Seen:
    """An arena as its reader sees it, with what the reader says of it."""

    def __init__(self) -> None:
        self.arena = Arena("/out", 4 * PAGE)
        ledger = sealed("test", LEDGER)
        self.memory = mmap.mmap(ledger, LEDGER)
        self.ledger = memoryview(self.memory).cast("I")
        self.pipe, theirs = os.pipe()
        os.set_blocking(self.pipe, False)
        self.borrowed: Borrowed | None = Borrowed(os.dup(self.arena.number), ledger, theirs)

    @property
    def held(self) -> bool:
        """Whether the reader still has its end of the pipe."""
        try:
            return bool(os.read(self.pipe, 1))
        except BlockingIOError:
            return True


def test_a_payload_is_given_back_with_its_last_view() -> None:
    shown = Seen()
    placed = shown.arena.place([bytes(range(100))], 100)
    assert placed is not None
    assert shown.borrowed is not None
    view = shown.borrowed.take(0, 3, 7, placed.offset, 100)
    assert view == bytes(range(100))
    assert (view.readonly, view.format, view.ndim) == (True, "B", 1)
    array = np.frombuffer(view[10:20], np.uint8)
    shape = np.ndarray((2, 5), np.uint8, view[10:20])
    del view
    gc.collect()
    assert shown.ledger[3] == 0
    assert not array.flags.writeable
    with pytest.raises(ValueError):
        array.flags.writeable = True
    del array
    assert shown.ledger[3] == 0
    del shape
    assert shown.ledger[3] == 7
    os.close(shown.pipe)


def test_no_copy_is_made() -> None:
    shown = Seen()
    placed = shown.arena.place([bytes(100)], 100)
    assert placed is not None
    assert shown.borrowed is not None
    view = shown.borrowed.take(0, 0, 1, placed.offset, 100)
    shown.arena.view[placed.offset + 5] = 42  # as only a sender that breaks the rules does
    assert view[5] == 42
    os.close(shown.pipe)


def test_views_outlive_the_connection() -> None:
    shown = Seen()
    placed = shown.arena.place([b"still here"], 10)
    assert placed is not None
    assert shown.borrowed is not None
    view = shown.borrowed.take(0, 0, 1, placed.offset, 10)
    shown.borrowed = None
    gc.collect()
    assert shown.held
    assert bytes(view) == b"still here"
    del view
    gc.collect()
    assert not shown.held
    os.close(shown.pipe)


@pytest.mark.parametrize(
    ("slot", "offset", "size"),
    [(256, 0, 1), (0, 4 * PAGE, 1), (0, 0, 4 * PAGE + 1), (0, 1 << 63, 8), (0, 8, (1 << 64) - 4)],
)
def test_places_outside(slot: int, offset: int, size: int) -> None:
    shown = Seen()
    assert shown.borrowed is not None
    with pytest.raises(RemoteProtocolError):
        shown.borrowed.take(0, slot, 1, offset, size)
    os.close(shown.pipe)


@pytest.mark.parametrize("number", [1, OTHERS, OTHERS + 1, 0xFEFF])
def test_memory_that_was_never_shown(number: int) -> None:
    shown = Seen()
    assert shown.borrowed is not None
    with pytest.raises(RemoteProtocolError, match="never shown"):
        shown.borrowed.take(number, 0, 1, 0, 1)
    os.close(shown.pipe)


def test_memory_of_a_third_program() -> None:
    """Its pipe is held for as long as anybody looks at it, under whatever number."""
    shown, third = Seen(), Arena("/third", PAGE)
    placed = third.place([b"third"], 5)
    assert placed is not None
    ours, theirs = os.pipe2(os.O_NONBLOCK)
    assert shown.borrowed is not None
    shown.borrowed.show(2, Shown(*owned([os.dup(third.number), theirs])))
    view = shown.borrowed.take(2, 9, 4, placed.offset, 5)
    with pytest.raises(RemoteProtocolError):
        shown.borrowed.take(2, 9, 4, PAGE, 1)
    shown.borrowed = None
    gc.collect()
    assert view == b"third"
    with pytest.raises(BlockingIOError):
        os.read(ours, 1)
    del view
    gc.collect()
    assert shown.ledger[9] == 4
    assert os.read(ours, 1) == b""
    os.close(ours)
    os.close(shown.pipe)


def identity(descriptor: int) -> object:
    """Of the file that is open there; None if none is."""
    try:
        found = os.fstat(descriptor)
    except OSError:
        return None
    return found.st_dev, found.st_ino


def refused(file: int, ledger: int, pipe: int, match: str) -> None:
    """They are refused, and closed."""
    before = {number: identity(number) for number in (file, ledger, pipe)}
    with pytest.raises(RemoteProtocolError, match=match):
        Borrowed(file, ledger, pipe)
    gc.collect()
    for number, file_ in before.items():  # another thread may have opened something there
        assert identity(number) is None or identity(number) != file_


def ends() -> tuple[int, int]:
    ours, theirs = os.pipe()
    os.close(ours)
    return theirs, sealed("test", LEDGER)


def test_a_file_that_can_become_shorter_is_refused() -> None:
    """Reading behind the end of a file kills a process."""
    pipe, ledger = ends()
    unsealed = os.memfd_create("test", os.MFD_ALLOW_SEALING)
    os.ftruncate(unsealed, PAGE)
    refused(unsealed, ledger, pipe, "not shared memory")


def test_an_ordinary_file_is_refused(tmp_path: Path) -> None:
    pipe, ledger = ends()
    (tmp_path / "file").write_bytes(bytes(PAGE))
    refused(os.open(tmp_path / "file", os.O_RDWR), ledger, pipe, "not shared memory")


@pytest.mark.skipif(not hasattr(os, "MFD_HUGETLB"), reason="no huge pages")
def test_huge_pages_are_refused() -> None:
    """They may not be there when they are read, which kills a process, too."""
    pipe, ledger = ends()
    try:
        huge = os.memfd_create("test", os.MFD_ALLOW_SEALING | os.MFD_HUGETLB)
    except OSError:
        os.close(pipe)
        os.close(ledger)
        pytest.skip("this system has no huge pages")
    import fcntl

    fcntl.fcntl(huge, 1033, 2)
    refused(huge, ledger, pipe, "not shared memory")


@pytest.mark.parametrize("size", [0, LEDGER - 1])
def test_a_short_ledger_is_refused(size: int) -> None:
    pipe, ledger = ends()
    os.close(ledger)
    refused(sealed("a", PAGE), sealed("b", size), pipe, "not shared memory")


def test_something_else_than_a_pipe_is_refused() -> None:
    pipe, ledger = ends()
    os.close(pipe)
    refused(sealed("a", PAGE), ledger, os.open("/dev/null", os.O_WRONLY), "no pipe")


@pytest.mark.parametrize("place", [0, 1, 2])
def test_a_directory_is_refused(place: int, tmp_path: Path) -> None:
    pipe, ledger = ends()
    numbers = [sealed("a", PAGE), ledger, pipe]
    os.close(numbers[place])
    numbers[place] = os.open(tmp_path, os.O_RDONLY)
    refused(*numbers, "a directory")


def test_a_file_without_bytes_is_refused() -> None:
    pipe, ledger = ends()
    refused(sealed("a", 0), ledger, pipe, "cannot be looked at")


def test_a_file_beyond_all_measure_is_refused() -> None:
    pipe, ledger = ends()
    refused(sealed("a", 1 << 40), ledger, pipe, "at most")


def test_a_forked_process_gives_nothing_back() -> None:
    """It has a copy of every view, and its end, or one less, means nothing."""
    seen = Seen()
    placed = seen.arena.place([b"parent"], 6)
    assert placed is not None
    assert seen.borrowed is not None
    view = seen.borrowed.take(0, 3, 7, placed.offset, 6)
    child = os.fork()
    if not child:
        code = 1
        try:
            code = 0 if view == b"parent" else 2
            del view
            gc.collect()
        finally:
            os._exit(code)
    assert os.waitpid(child, 0)[1] == 0
    assert seen.ledger[3] == 0
    del view
    assert seen.ledger[3] == 7
    os.close(seen.pipe)


def test_a_copy_of_a_view_is_an_ordinary_array() -> None:
    shown = Seen()
    placed = shown.arena.place([b"0123456789"], 10)
    assert placed is not None
    assert shown.borrowed is not None
    array = np.frombuffer(shown.borrowed.take(0, 0, 1, placed.offset, 10), np.uint8)
    copies = [array.copy(), pickle.loads(pickle.dumps(array))]
    del array
    assert shown.ledger[0] == 1
    assert [bytes(copy) for copy in copies] == [b"0123456789"] * 2
    os.close(shown.pipe)
