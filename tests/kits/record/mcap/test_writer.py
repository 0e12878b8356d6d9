"""MCAP files, as the library of their inventors reads them."""

import errno
import io
from pathlib import Path

import mcap.reader
import pytest
from support.recordings import START, STEP, fill, payload_of, recorded

from yarpy.errors import LocalProtocolError
from yarpy.kits.record.mcap import writer as module
from yarpy.kits.record.mcap.pieces import COMPRESSIONS
from yarpy.kits.record.mcap.reader import McapFile
from yarpy.kits.record.mcap.writer import McapWriter
from yarpy.platform import file_bytes


@pytest.mark.parametrize("compression", COMPRESSIONS)
def test_the_library_reads_and_checks_it(tmp_path: Path, compression: str) -> None:
    path = tmp_path / "x.mcap"
    with McapWriter(path, compression, {"host": "lab"}, plain=True) as writer:
        fill(writer)
        writer.flush()
        writer.add("/c", "free text", START, b"\xff\0")
        writer.note({"what": "mark"}, START)
    with open(path, "rb") as file:
        reader = mcap.reader.make_reader(file, validate_crcs=True)
        summary = reader.get_summary()
        assert summary is not None and summary.statistics is not None
        assert summary.statistics.message_count == 12
        assert summary.statistics.message_end_time == START + 9 * STEP
        found = [(c.topic, m) for _, c, m in reader.iter_messages(log_time_order=False)]
        topic, message = found[3]
        assert (topic, message.sequence, message.data) == ("/b", 3, payload_of([3]))
        assert (message.publish_time, message.log_time) == (3_500_000_000, START + 3 * STEP)
        assert found[10][1].data == b"\x09\0\0\0free text\xff\0"
        assert found[11] == ("yarpy.record", found[11][1])
        assert found[11][1].data == b'{"what": "mark"}'
        (metadata,) = reader.iter_metadata()
        assert (metadata.name, metadata.metadata) == ("yarpy", {"host": "lab"})
        kinds = {summary.schemas[c.schema_id].name for c in summary.channels.values()}
        assert kinds == {"yarp/bottle", "yarpy.Note"}
        only = [m.sequence for _, _, m in reader.iter_messages(["/b"])]
        assert only == [1, 3, 5, 7, 9]


def test_nothing_is_replaced(tmp_path: Path) -> None:
    path = recorded(tmp_path / "x.mcap")
    with pytest.raises(FileExistsError):
        McapWriter(path)


def test_what_was_flushed_is_in_the_file(tmp_path: Path) -> None:
    path = tmp_path / "x.mcap"
    with McapWriter(path) as writer:
        fill(writer, 4)
        assert writer.pending > 0
        writer.flush()
        writer.sync()
        assert writer.pending == 0 and writer.size == path.stat().st_size
        with McapFile(path) as file:
            assert [record.sequence for record in file.records()] == [0, 1, 2, 3]


def test_chunks_end_by_their_size(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "CHUNK_SIZE", 100)
    with McapWriter(tmp_path / "x.mcap") as writer:
        fill(writer, 20)
    with McapFile(tmp_path / "x.mcap") as file:
        assert len(file.index.places) > 5
        assert len([*file.records()]) == 20


def test_what_is_too_large(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "LARGEST", 10)
    with McapWriter(tmp_path / "x.mcap") as writer:
        writer.add("/a", "", START, bytes(10))
        with pytest.raises(LocalProtocolError, match="11 bytes; a file takes 10"):
            writer.add("/a", "", START, bytes(11))
        writer.add("/a", "", START, bytes(10))
    with McapFile(tmp_path / "x.mcap") as file:
        assert [bytes(record.data) for record in file.records()] == [bytes(10)] * 2


def test_a_message_of_many_pieces_is_written_whole(tmp_path: Path) -> None:
    """More pieces than one system call takes, large and small ones."""
    sizes = [5000 if n % 2 else 3 for n in range(3000)]
    with McapWriter(tmp_path / "x.mcap") as writer:
        for n, size in enumerate(sizes):
            writer.add("/a", "", START + n, bytes([n % 256]) * size)
    with McapFile(tmp_path / "x.mcap") as file:
        for n, record in enumerate(file.records()):
            assert record.data == bytes([n % 256]) * sizes[n]
        assert n == len(sizes) - 1


def test_a_write_that_fails_is_taken_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "x.mcap"
    with McapWriter(path) as writer:
        fill(writer, 4)
        writer.flush()
        size = path.stat().st_size
        fill(writer, 4)
        real = file_bytes.write
        calls = []

        def full(file: io.FileIO, views: list[memoryview]) -> int:
            calls.append(real(file, [views[0][:20]]))
            if len(calls) > 1:
                raise OSError(errno.ENOSPC, "No space left on device")
            return calls[0]

        monkeypatch.setattr(file_bytes, "write", full)
        with pytest.raises(OSError, match="No space"):
            writer.flush()
        monkeypatch.undo()
        assert path.stat().st_size == size and writer.messages == 4
    with McapFile(path) as file:
        assert file.index.complete and file.index.counts == {1: 2, 2: 2}
        assert len([*file.records()]) == 4


def test_a_compression_that_nobody_knows(tmp_path: Path) -> None:
    with pytest.raises(LocalProtocolError, match='no compression "rar": it is one of none, lz4'):
        McapWriter(tmp_path / "x.mcap", "rar")


def test_a_full_disk_at_the_beginning(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> int:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(file_bytes, "write", full)
    with pytest.raises(OSError, match=r"No space left on device: '.*x\.mcap'"):
        McapWriter(tmp_path / "x.mcap")
    assert not [*tmp_path.iterdir()]
