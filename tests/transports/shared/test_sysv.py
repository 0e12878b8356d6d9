"""Segments of System V and mutexes in files: found by another, left by none, of nobody else."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.system import NO_ROOT
from support.wait import HANG, wait_until

from yarpy.errors import LocalProtocolError
from yarpy.transports.shared import sysv
from yarpy.transports.shared.sysv import MUTEX, Mutex, Segment, available, require

pytestmark = pytest.mark.skipif(not available(), reason="no memory of System V here")

HEADER = 28


def keys() -> set[int]:
    """Of all segments of this computer that have one."""
    lines = Path("/proc/sysvipc/shm").read_text(encoding="utf-8").splitlines()[1:]
    return {int(line.split()[0]) for line in lines} - {0}


@pytest.fixture
def key() -> Iterator[int]:
    """A number that nobody uses; what is left under it in the end is an error."""
    number = (os.getpid() << 8) & 0x7FFFFFFF
    while number in keys():
        number += 1
    yield number
    assert number not in keys()


def test_both_see_the_same(key: int) -> None:
    first = Segment.create(key, 100, HEADER)
    second = Segment.attach(key, HEADER)
    assert (first.size, second.size, first.attached) == (100, 100, 2)
    first.bytes[40:43] = b"abc"
    first.numbers[1] = -5
    assert bytes(second.bytes[40:43]) == b"abc"
    assert second.numbers[1] == -5
    first.forget()
    with pytest.raises(FileNotFoundError):
        Segment.attach(key, HEADER)
    del second
    assert first.attached == 1
    assert first.numbers[1] == -5


def test_a_view_keeps_it(key: int) -> None:
    segment = Segment.create(key, 5000, HEADER)
    segment.forget()
    view = segment.bytes[4000:]
    del segment
    view[0] = 7
    assert view[0] == 7


def test_what_a_dead_program_left_gives_way(key: int) -> None:
    old = Segment.create(key, 100, HEADER)
    old.numbers[1] = 100 - HEADER  # as in the rings of C++
    del old
    new = Segment.create(key, 200, HEADER)
    assert (new.size, new.numbers[1]) == (200, 0)
    new.forget()


@pytest.mark.parametrize("why", ["in use", "something else"])
def test_what_is_not_left_behind_stays(key: int, why: str) -> None:
    old: Segment | None = Segment.create(key, 100, HEADER)
    assert old is not None
    if why == "in use":
        old.numbers[1] = 100 - HEADER
    else:
        old = None
    with pytest.raises(FileExistsError):
        Segment.create(key, 200, HEADER)
    Segment.attach(key, HEADER).forget()


def test_too_small(key: int) -> None:
    small = Segment.create(key, 10, 0)
    with pytest.raises(OSError):
        Segment.attach(key, HEADER)
    small.forget()


def test_no_room(key: int) -> None:
    with pytest.raises(OSError, match="shared memory of"):
        Segment.create(key, 1 << 60, HEADER)


@pytest.mark.skipif(bool(NO_ROOT), reason=NO_ROOT)
def test_of_somebody_else(key: int, tmp_path: Path) -> None:
    segment = Segment.create(key, 100, HEADER)
    path = tmp_path / "mutex"
    Mutex(str(path), True)
    try:
        os.seteuid(65534)
        with pytest.raises(PermissionError):
            Segment.attach(key, HEADER)
    finally:
        os.seteuid(0)
    os.chown(path, 65534, -1)
    with pytest.raises(PermissionError, match="another user"):
        Mutex(str(path), False)
    segment.forget()


def test_a_mutex_is_held_by_one(tmp_path: Path) -> None:
    path = tmp_path / "mutex"
    here = Mutex(str(path), True)
    there = Mutex(str(path), False)
    assert path.stat().st_size == MUTEX
    assert path.stat().st_mode & 0o777 == 0o600
    assert here.try_acquire()
    assert not there.try_acquire()
    assert there.held
    here.release()
    assert there.try_acquire()
    there.release()
    here.forget()
    there.forget()
    assert list(tmp_path.iterdir()) == []


def test_who_waits_is_woken_by_a_release(tmp_path: Path) -> None:
    here = Mutex(str(tmp_path / "mutex"), True)
    there = Mutex(str(tmp_path / "mutex"), False)
    here.hold()
    woken: list[float] = []

    def wait() -> None:
        here.wait(60.0)
        woken.append(time.monotonic())

    thread = threading.Thread(target=wait)
    thread.start()
    there.release()
    thread.join(30)
    assert woken
    here.wait(60.0)  # nobody holds it: at once
    here.hold()
    here.wait(0.01)  # in vain


def test_a_thread_of_ours_can_be_woken(tmp_path: Path) -> None:
    mutex = Mutex(str(tmp_path / "mutex"), True)
    mutex.hold()
    thread = threading.Thread(target=mutex.wait, args=(60.0,))
    thread.start()

    def woken() -> bool:
        mutex.wake()
        return not thread.is_alive()

    wait_until(woken, what="it wakes up")
    assert mutex.held


def test_what_a_dead_program_left_is_made_again(tmp_path: Path) -> None:
    path = tmp_path / "mutex"
    assert Mutex(str(path), True).try_acquire()
    assert Mutex(str(path), True).try_acquire()


@pytest.mark.parametrize("what", ["short", "link", "open to others", "directory"])
def test_files_that_are_no_mutex(what: str, tmp_path: Path) -> None:
    path = tmp_path / "mutex"
    Mutex(str(path), True)
    if what == "short":
        os.truncate(path, MUTEX - 1)
    elif what == "link":
        path.rename(tmp_path / "other")
        path.symlink_to(tmp_path / "other")
    elif what == "open to others":
        path.chmod(0o666)
    else:
        path.unlink()
        path.mkdir()
    with pytest.raises(OSError):
        Mutex(str(path), False)


def test_a_file_that_becomes_shorter_is_an_error(tmp_path: Path) -> None:
    """The processor would end the program that touches what is not there any more."""
    path = tmp_path / "mutex"
    mutex = Mutex(str(path), True)
    os.truncate(path, 0)
    for action in (mutex.try_acquire, mutex.release, mutex.hold, lambda: mutex.held):
        with pytest.raises(OSError, match="was changed"):
            action()
    mutex.wait(HANG)  # the system says no: at once
    mutex.wake()


def test_a_kind_of_mutex_that_does_more_is_an_error(tmp_path: Path) -> None:
    path = tmp_path / "mutex"
    mutex = Mutex(str(path), True)
    with path.open("r+b") as file:
        file.seek(16)
        file.write(b"\xf1")  # robust, of the priority kind, recursive
    with pytest.raises(OSError, match="was changed"):
        mutex.try_acquire()


def test_other_systems(monkeypatch: pytest.MonkeyPatch) -> None:
    require()
    monkeypatch.setattr(sysv, "MUTEX", 0)
    assert not available()
    with pytest.raises(LocalProtocolError, match="use memory, unix_stream or tcp"):
        require()
