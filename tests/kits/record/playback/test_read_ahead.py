"""Reading ahead."""

import threading
from collections.abc import Iterator

import pytest
from support.wait import wait_until

from yarpy.errors import DecodeError
from yarpy.kits.record.playback.read_ahead import ReadAhead
from yarpy.kits.record.recorded import Recorded


def messages(count: int, size: int, read: list[int]) -> Iterator[Recorded]:
    for n in range(count):
        read.append(n)
        yield Recorded("/a", n, n, "", bytes(size))


@pytest.mark.parametrize("size", [0, 5000])
def test_all_come_in_their_order(size: int) -> None:
    ahead = ReadAhead(messages(500, size, []), most=10_000)
    assert [one.received_ns for one in ahead] == [*range(500)]
    ahead.close()


def test_no_more_is_read_than_there_is_room_for() -> None:
    read: list[int] = []
    ahead = ReadAhead(messages(100, 1000, read), most=10_000)
    wait_until(lambda: len(read) >= 8)
    assert next(ahead).received_ns == 0
    assert len(read) < 20
    assert len([*ahead]) == 99
    ahead.close()


def test_it_can_be_left() -> None:
    ahead = ReadAhead(messages(10_000, 1000, []), most=5000)
    next(ahead)
    ahead.close()
    assert not any(one.name == "yarpy read ahead" for one in threading.enumerate())


def test_errors_come_in_their_place() -> None:
    def broken() -> Iterator[Recorded]:
        yield from messages(3, 0, [])
        raise DecodeError("broken")

    ahead = ReadAhead(broken())
    assert [next(ahead).received_ns for _ in range(3)] == [0, 1, 2]
    with pytest.raises(DecodeError, match="broken"):
        next(ahead)
    ahead.close()
