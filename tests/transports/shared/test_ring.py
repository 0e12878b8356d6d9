"""A ring of bytes as C++ has it: around its end, into larger memory, and with numbers that lie."""

from __future__ import annotations

import os
import random
import struct
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from yarpy.errors import RemoteProtocolError
from yarpy.transports.shared import ring as shmem_ring
from yarpy.transports.shared.ring import FIRST_SIZE, HEADER, Ring, name_of
from yarpy.transports.shared.sysv import Segment, available

pytestmark = pytest.mark.skipif(not available(), reason="no memory of System V here")


@pytest.fixture(autouse=True)
def directory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    return tmp_path


def keys() -> set[int]:
    lines = Path("/proc/sysvipc/shm").read_text(encoding="utf-8").splitlines()[1:]
    return {int(line.split()[0]) for line in lines}


@pytest.fixture
def number() -> Iterator[int]:
    """As a port number, but of none; what is left under it in the end is an error."""
    number = 65536 - os.getpid() % 30000  # some bits that no other test of this process has
    yield number
    assert not [key for key in keys() if key and key & 0xFFFF == number & 0xFFFF]


def alive() -> None:
    """The other side is there."""


@pytest.fixture
def pair(number: int) -> Iterator[tuple[Ring, Ring]]:
    writer = Ring(number, True, alive)
    reader = Ring(number, False, alive)
    writer.forget()
    yield writer, reader
    reader.close()
    writer.close()


def take(reader: Ring, room: int = 1 << 22) -> bytes:
    view = memoryview(bytearray(room))
    count = reader.read_into(view)
    assert count >= 0
    return bytes(view[:count])


def test_names_are_those_of_cpp(number: int, directory: Path) -> None:
    ring = Ring(number, True, alive)
    assert sorted(path.name for path in directory.iterdir()) == [
        f"SHMEM_ACCESS_MUTEX_{number}",
        f"SHMEM_WAITDATA_MUTEX_{number}",
    ]
    assert number in keys()
    assert not ring.found
    reader = Ring(number, False, alive)
    assert ring.found
    ring.forget()
    assert list(directory.iterdir()) == []
    assert number not in keys()
    ring.write([b"still there"], 11)
    assert take(reader) == b"still there"


def test_header_is_that_of_cpp(number: int) -> None:
    """The bytes that were found in the memory of a C++ port after a message of 75 bytes."""
    writer = Ring(number, True, alive)
    memory = Segment.attach(number, HEADER)
    assert bytes(memory.bytes[:HEADER]) == struct.pack("<4x6i", 4096, 0, 0, 0, 0, 0)
    assert memory.size == 4124
    reader = Ring(number, False, alive)
    writer.write([bytes(70), b"last!"], 75)
    assert bytes(memory.bytes[:HEADER]) == struct.pack("<4x6i", 4096, 0, 75, 0, 75, 0)
    assert len(take(reader)) == 75
    assert bytes(memory.bytes[:HEADER]) == struct.pack("<4x6i", 4096, 0, 75, 75, 0, 0)
    reader.wait(0.001)
    assert memory.numbers[6] == 1
    reader.close()
    writer.close()
    assert memory.bytes[1] == 1


def test_nothing_to_read(pair: tuple[Ring, Ring]) -> None:
    assert pair[1].read_into(memoryview(bytearray(8))) == -1


def test_any_bytes_in_any_pieces(pair: tuple[Ring, Ring]) -> None:
    """Around the end, and into larger memory while some is unread."""
    writer, reader = pair
    chance = random.Random(7)
    sent, came = bytearray(), bytearray()
    for _ in range(600):
        if chance.random() < 0.5:
            size = chance.choice([0, 1, 7, 500, 4095, chance.randrange(60000)])
            data = chance.randbytes(size)
            cut = chance.randint(0, size)
            writer.write([data[:cut], memoryview(data)[cut:]], size)
            sent += data
        elif reader.filled or len(came) < len(sent):
            came += take(reader, chance.choice([1, 10, 3000, 100000]))
    while len(came) < len(sent):
        came += take(reader)
    assert came == sent


def test_a_closed_ring_is_read_to_its_end(pair: tuple[Ring, Ring]) -> None:
    writer, reader = pair
    writer.write([b"last"], 4)
    writer.close()
    assert reader.closed
    assert take(reader) == b"last"
    assert reader.read_into(memoryview(bytearray(8))) == 0
    reader.wait(60.0)  # there is nothing to wait for


def test_a_writer_whose_reader_has_closed(pair: tuple[Ring, Ring]) -> None:
    writer, reader = pair
    reader.close()
    with pytest.raises(BrokenPipeError):
        writer.write([b"x"], 1)


def test_a_writer_that_closes_after_a_move(pair: tuple[Ring, Ring]) -> None:
    writer, reader = pair
    writer.write([bytes(10000)], 10000)
    writer.close()
    assert reader.read_into(memoryview(bytearray(8))) == 0


def test_moves_of_a_writer_that_has_died(number: int) -> None:
    writer = Ring(number, True, alive)
    reader = Ring(number, False, alive)
    writer.forget()
    for power in range(1, 4):
        writer.write([bytes(10000 << power)], 10000 << power)
    assert [key for key in keys() if key >> 16 and key & 0xFFFF == number & 0xFFFF]
    reader.close()  # and nothing by the writer: see `number`


def test_a_reader_is_woken(pair: tuple[Ring, Ring]) -> None:
    writer, reader = pair
    thread = threading.Thread(target=reader.wait, args=(60.0,))
    thread.start()
    while not writer._segment.numbers[6]:
        pass
    writer.write([b"x"], 1)
    thread.join(30)
    assert not thread.is_alive()


LIES = {
    "size": {1: 1 << 30},
    "no size": {1: 0},
    "negative size": {1: -1, 5: 1},
    "tail": {4: FIRST_SIZE},
    "negative tail": {4: -1},
    "head": {3: FIRST_SIZE},
    "more than there is": {5: FIRST_SIZE + 1},
    "less than nothing": {5: -1},
}


@pytest.mark.parametrize("lie", LIES.values(), ids=LIES.keys())
def test_numbers_that_lie(lie: dict[int, int], pair: tuple[Ring, Ring]) -> None:
    writer, reader = pair
    writer.write([b"abc"], 3)
    for index, value in lie.items():
        writer._segment.numbers[index] = value
    with pytest.raises(RemoteProtocolError, match="cannot be right"):
        take(reader)
    with pytest.raises(RemoteProtocolError, match="cannot be right"):
        writer.write([b"abc"], 3)


def test_a_move_that_leads_nowhere(pair: tuple[Ring, Ring]) -> None:
    writer, reader = pair
    writer._segment.bytes[0] = 1
    with pytest.raises(FileNotFoundError):
        take(reader)


def test_moves_without_end(pair: tuple[Ring, Ring], monkeypatch: pytest.MonkeyPatch) -> None:
    writer, reader = pair
    monkeypatch.setattr(shmem_ring, "MAX_MOVES", 3)
    for power in range(3):
        writer.write([bytes(10000 << 3 * power)], 10000 << 3 * power)
        assert take(reader)
    with pytest.raises(OSError, match="use memory, unix_stream or tcp"):
        writer.write([bytes(10 << 20)], 10 << 20)
    reader._segment.bytes[0] = 1
    with pytest.raises(RemoteProtocolError, match="without end"):
        take(reader)


def test_a_holder_that_has_died(number: int) -> None:
    def gone() -> None:
        raise ConnectionResetError("gone")

    writer = Ring(number, True, gone)
    assert writer._access.try_acquire()
    with pytest.raises(ConnectionResetError):
        writer.write([b"x"], 1)
    writer.close()


def test_a_holder_that_keeps_it(pair: tuple[Ring, Ring], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shmem_ring, "_HELD", 0.1)
    writer, reader = pair
    assert writer._access.try_acquire()
    with pytest.raises(ConnectionAbortedError):
        reader.wait(1.0)
    writer._access.release()


def test_the_directory_is_that_of_cpp(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TMPDIR", "/somewhere")
    assert name_of("ACCESS", 7) == "/somewhere/SHMEM_ACCESS_MUTEX_7"
    monkeypatch.delenv("TMPDIR")
    assert name_of("WAITDATA", 7) == "/tmp/SHMEM_WAITDATA_MUTEX_7"


def test_nothing_is_left_where_a_ring_cannot_be_made(number: int, directory: Path) -> None:
    (directory / f"SHMEM_WAITDATA_MUTEX_{number}").mkdir()
    with pytest.raises(OSError):
        Ring(number, True, alive)
    assert [path.name for path in directory.iterdir()] == [f"SHMEM_WAITDATA_MUTEX_{number}"]
    assert number not in keys()
