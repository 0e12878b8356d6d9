"""Where things are in files: finished, unfinished, damaged, and of other programs."""

import os
from pathlib import Path

import mcap.writer
import pytest
from support.recordings import START, fill, recorded

from yarpy.errors import DecodeError
from yarpy.kits.record.mcap import index
from yarpy.kits.record.mcap.index import Index, Window, read_index
from yarpy.kits.record.mcap.layout import Schema
from yarpy.kits.record.mcap.writer import McapWriter


def index_of(path: Path) -> Index:
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_BINARY", 0))
    try:
        return read_index(Window(handle))
    finally:
        os.close(handle)


def facts(index: Index) -> object:
    channels = {n: c.topic for n, c in index.channels.items()}
    return channels, index.counts, [*index.places], [*index.lengths], index.begin, index.end


@pytest.mark.parametrize("compression", ["none", "zstd"])
def test_a_walk_finds_what_the_summary_says(tmp_path: Path, compression: str) -> None:
    whole = recorded(tmp_path / "whole.mcap", compression=compression)
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(whole.read_bytes()[:-1])
    finished, unfinished = index_of(whole), index_of(cut)
    assert finished.complete and not unfinished.complete
    assert facts(finished) == facts(unfinished)
    assert finished.counts == {1: 5, 2: 5} and len(finished.places) == 2


def test_a_file_that_is_being_written(tmp_path: Path) -> None:
    path = tmp_path / "x.mcap"
    with McapWriter(path, metadata={"host": "lab"}) as writer:
        assert index_of(path).counts == {}
        fill(writer, 4)
        writer.flush()
        found = index_of(path)
        assert found.counts == {1: 2, 2: 2} and not found.complete and not found.damages
        assert found.metadata == {"yarpy": {"host": "lab"}}


def test_every_length_of_a_file_is_read(tmp_path: Path) -> None:
    """Whatever a kill leaves: chunks that are whole are found, and a cut is named."""
    data = recorded(tmp_path / "x.mcap").read_bytes()
    whole = index_of(tmp_path / "x.mcap")
    ends = [place + length for place, length in zip(whole.places, whole.lengths, strict=True)]
    cut = tmp_path / "cut.mcap"
    for size in range(8, len(data), 3):
        cut.write_bytes(data[:size])
        found = index_of(cut)
        assert len(found.places) == sum(size >= end for end in ends)
        assert all(8 <= damage.byte <= size for damage in found.damages)


def test_what_is_no_recording(tmp_path: Path) -> None:
    for data in (b"", b"\x89MCAP", b"Type: Bottle;\n"):
        (tmp_path / "x").write_bytes(data)
        with pytest.raises(DecodeError, match="byte 0: not an MCAP file"):
            index_of(tmp_path / "x")


def test_a_summary_that_lies_is_not_believed(tmp_path: Path) -> None:
    path = recorded(tmp_path / "x.mcap")
    data = bytearray(path.read_bytes())
    data[-60] ^= 1
    path.write_bytes(data)
    found = index_of(path)
    assert [str(damage) for damage in found.damages] == [
        f"byte {found.damages[0].byte}: the summary has changed: its checksum is another one"
    ]
    assert found.counts == {1: 5, 2: 5} and not found.complete


def test_no_record_begins_so(tmp_path: Path) -> None:
    path = recorded(tmp_path / "x.mcap")
    data = path.read_bytes()[:-1]
    place = index_of(path).places[1]
    path.write_bytes(data[:place] + b"\x40" + data[place + 1 :])
    found = index_of(path)
    assert str(found.damages[0]) == f"byte {place}: no record begins with 64"
    assert len(found.places) == 1


def test_files_of_other_programs(tmp_path: Path) -> None:
    """Without chunks, without lists of messages, with attachments and private records."""
    for chunked, kinds in ((False, "ALL"), (True, "NONE"), (True, "ALL")):
        path = tmp_path / f"{chunked}{kinds}.mcap"
        with open(path, "wb") as file:
            writer = mcap.writer.Writer(
                file, use_chunking=chunked, index_types=mcap.writer.IndexType[kinds]
            )
            writer.start()
            schema = writer.register_schema("Point", "jsonschema", b"{}")
            channel = writer.register_channel("/point", "json", schema, {"a": "b"})
            writer.add_attachment(0, 0, "notes", "text/plain", b"hello")
            for n in range(5):
                writer.add_message(channel, START + n, b"{}", START + n)
            writer.finish()
        found = index_of(path)
        assert found.counts == {1: 5} and (found.begin, found.end) == (START, START + 4)
        schema = Schema("Point", "jsonschema", b"{}")
        assert found.channels[1] == ("/point", "json", schema, {"a": "b"})
        assert not found.damages


def test_the_number_of_chunks_has_a_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = recorded(tmp_path / "x.mcap")
    monkeypatch.setattr(index, "RECORDED_CHUNKS", 1)
    found = index_of(path)
    assert "more than 1 chunks" in str(found.damages[-1]) and len(found.places) == 1


def test_channels_that_come_later(tmp_path: Path) -> None:
    """In a chunk that begins with messages of channels that are known."""
    path = tmp_path / "x.mcap"
    with McapWriter(path) as writer:
        fill(writer, 2)
        writer.flush()
        fill(writer, 8, ("/a", "/b", "/c", "/d"))
        writer.flush()
        found = index_of(path)
    assert {found.channels[n].topic: count for n, count in found.counts.items()} == {
        "/a": 3,
        "/b": 3,
        "/c": 2,
        "/d": 2,
    }
