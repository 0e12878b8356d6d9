"""A group in MPI: the numbers that C++ sends, who joins and leaves, and what ends it."""

from __future__ import annotations

import socket
import struct
import threading
from collections.abc import Iterator

import pytest
from support.mpi_hall import Failed, FakeLibrary, Hall
from support.wait import HANG, wait_until

from yarpy.errors import RemoteProtocolError
from yarpy.peers.mpi import group as mpi_group
from yarpy.peers.mpi.end import Line
from yarpy.peers.mpi.group import Group, Member, follow


@pytest.fixture
def hall() -> Hall:
    return Hall()


@pytest.fixture
def line() -> Iterator[Line]:
    near, far = socket.socketpair(socket.AF_UNIX)
    found = Line(near)
    yield found
    found.close()
    near.close()
    far.close()


class Follower:
    """A reader in a thread of its own."""

    def __init__(self, hall: Hall, place: str, name: str, limit: int = 1000) -> None:
        self.library = FakeLibrary(hall)
        self.member = Member(self.library)  # type: ignore[arg-type]
        self.came: list[bytes] = []
        self.error: Exception | None = None
        self.thread = threading.Thread(target=self.run, args=(place, name, limit), daemon=True)
        self.thread.start()

    def run(self, place: str, name: str, limit: int) -> None:
        try:
            self.member.connect(place)
            follow(self.member, name, limit, self.came.append, lambda: None)
        except Exception as error:
            self.error = error

    def ended(self) -> bool:
        self.thread.join(HANG)
        return not self.thread.is_alive()


def test_two_readers_come_and_go(hall: Hall, line: Line) -> None:
    library = FakeLibrary(hall)
    group = Group(library)  # type: ignore[arg-type]
    first = Follower(hall, "one", "/a<-/s")
    group.join("one", line)
    assert group.offer(b"to one")
    assert group.wait_sent(20)
    second = Follower(hall, "two", "/b<-/s")
    group.join("two", line)
    assert group.size == 2
    assert group.offer(b"to both")
    group.leave("/a<-/s", line)
    assert first.ended()
    assert group.offer(b"to two")
    group.leave("/b<-/s", line)
    assert second.ended()
    assert first.came == [b"to one", b"to both"]
    assert second.came == [b"to both", b"to two"]
    assert (first.error, second.error, library.lost) == (None, None, 0)
    assert group.broken  # of no more use
    with pytest.raises(BrokenPipeError):
        group.offer(b"to nobody")


def test_numbers_are_those_of_cpp(hall: Hall, line: Line) -> None:
    """What a member sees that only listens."""
    library = FakeLibrary(hall)
    group = Group(library)  # type: ignore[arg-type]
    member = Member(FakeLibrary(hall))  # type: ignore[arg-type]
    thread = threading.Thread(target=member.connect, args=("one",))
    thread.start()
    group.join("one", line)
    thread.join(HANG)
    seen: list[bytes] = []
    group.offer(b"hello")
    group.wait_sent(20)
    group.leave("/a<-/s", line)
    inbox = member._comm.inbox
    while not inbox.empty():
        seen.append(inbox.get())
    assert seen == [
        struct.pack("=i", 5),
        b"hello",
        struct.pack("=i", -2),
        struct.pack("=i", 7),
        b"/a<-/s\0",
    ]


@pytest.mark.parametrize(
    ("said", "why"),
    [
        ([1 << 30], "bytes are sent at once"),
        ([-3], "bytes are sent at once"),
        ([-2, -1], "is to leave"),
        ([-2, 1 << 30], "is to leave"),
    ],
)
def test_numbers_that_cannot_be(said: list[int], why: str, hall: Hall) -> None:
    sender = Member(FakeLibrary(hall))  # type: ignore[arg-type]
    reader = Follower(hall, "one", "/a<-/s")
    sender.accept("one")
    for number in said:
        sender.number(number)
    assert reader.ended()
    assert isinstance(reader.error, RemoteProtocolError)
    assert why in str(reader.error)


def test_mpi_fails(hall: Hall, line: Line) -> None:
    library = FakeLibrary(hall)
    group = Group(library)  # type: ignore[arg-type]
    reader = Follower(hall, "one", "/a<-/s")
    group.join("one", line)
    group._member._comm.failing = True
    group.offer(b"x")
    wait_until(lambda: group.broken, what="the group ends")
    assert library.lost == 1
    reader.member._comm.inbox.put(Failed("broken"))
    assert reader.ended()


def test_somebody_who_does_not_come(
    hall: Hall, line: Line, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mpi_group, "MEETING", 0.05)
    library = FakeLibrary(hall)
    group = Group(library)  # type: ignore[arg-type]
    with pytest.raises(TimeoutError):
        group.join("one", line)
    assert group.broken
    assert library.lost == 1
    Follower(hall, "one", "/a<-/s")  # wakes the thread that waits


def test_a_reader_that_takes_nothing(
    hall: Hall, line: Line, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mpi_group, "LEAVING", 0.05)
    library = FakeLibrary(hall)
    group = Group(library)  # type: ignore[arg-type]
    Follower(hall, "one", "/a<-/s")
    group.join("one", line)
    with group._lock:  # as MPI would
        assert group.offer(b"x")
        assert not group.offer(b"y")
        with pytest.raises(TimeoutError):
            group.leave("/a<-/s", line)
    assert (group.broken, library.lost) == (True, 1)
