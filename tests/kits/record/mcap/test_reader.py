"""The messages of files: their order, and what is left of damaged ones."""

from pathlib import Path

import mcap.writer
import pytest
from support.recordings import START, STEP, payload_of, recorded

from yarpy.errors import DecodeError, MissingFile
from yarpy.kits.record.mcap import reader
from yarpy.kits.record.mcap.reader import McapFile
from yarpy.kits.record.mcap.writer import McapWriter


def sequences(file: McapFile, **options: object) -> list[int]:
    return [record.sequence for record in file.records(**options)]  # type: ignore[arg-type]


@pytest.mark.parametrize("compression", ["none", "lz4", "zstd"])
def test_messages_are_what_was_written(tmp_path: Path, compression: str) -> None:
    with McapFile(recorded(tmp_path / "x.mcap", compression=compression, plain=True)) as file:
        found = [*file.records()]
        assert [record.sequence for record in found] == [*range(10)]
        assert found[3].data == payload_of([3])
        assert (found[3].log_time, found[3].publish_time) == (START + 3 * STEP, 3_500_000_000)
        assert not file.damages


def test_some_of_them(tmp_path: Path) -> None:
    with McapFile(recorded(tmp_path / "x.mcap")) as file:
        assert sequences(file, channels={2}) == [1, 3, 5, 7, 9]
        begin, end = START + 2 * STEP, START + 7 * STEP
        assert sequences(file, begin=begin, end=end) == [2, 3, 4, 5, 6]
        assert sequences(file, channels=set()) == []
        assert sequences(file, begin=START + 100 * STEP) == []


@pytest.mark.parametrize("room", [1 << 20, 0])
def test_the_order_is_that_of_receipt(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, room: int
) -> None:
    """Within chunks, and between chunks that overlap: as long as there is room for them."""
    monkeypatch.setattr(reader, "OPEN", room)
    path = tmp_path / "x.mcap"
    times = [5, 1, 9, 0, 4, 8, 2, 6, 3, 7]
    with McapWriter(path) as writer:
        for n, time in enumerate(times):
            writer.add("/a", f"{time} 1", START + time, b"")
            if n in (2, 5):
                writer.flush()
    with McapFile(path) as file:
        found = sequences(file)
        assert found == [*range(10)] if room else sorted(found) == [*range(10)]


def test_a_damaged_chunk_is_left_out_and_told(tmp_path: Path) -> None:
    path = recorded(tmp_path / "x.mcap")
    with McapFile(path) as file:
        place = file.index.places[0]
    data = bytearray(path.read_bytes())
    data[place + 60] ^= 4
    path.write_bytes(data)
    with McapFile(path) as file:
        assert sequences(file) == [5, 6, 7, 8, 9]
        assert sequences(file) == [5, 6, 7, 8, 9]
        (damage,) = file.damages
        assert damage.byte == place and "its checksum is another one" in damage.why


def test_every_flipped_bit_is_survived(tmp_path: Path) -> None:
    """Nothing but right messages comes out, whatever has changed in the chunks."""
    path = recorded(tmp_path / "x.mcap")
    whole = path.read_bytes()
    with McapFile(path) as file:
        right = {(record.sequence, bytes(record.data)) for record in file.records()}
        first, last = file.index.places[0], file.index.places[1]
    for place in range(first, last, 7):
        data = bytearray(whole)
        data[place] ^= 1 << place % 8
        path.write_bytes(data)
        with McapFile(path) as file:
            found = {(record.sequence, bytes(record.data)) for record in file.records()}
            assert found <= right and len(found) >= 5


def test_messages_outside_of_chunks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "x.mcap"
    with open(path, "wb") as file:
        writer = mcap.writer.Writer(file, use_chunking=False)
        writer.start()
        channel = writer.register_channel("/a", "yarp", 0)
        for n in range(10):
            writer.add_message(channel, START + n, b"x" * n, START + n, n)
        writer.finish()
    for run in (1 << 20, 50):
        monkeypatch.setattr("yarpy.kits.record.mcap.index._RUN", run)
        with McapFile(path) as found:
            assert sequences(found) == [*range(10)]
            assert [len(record.data) for record in found.records()] == [*range(10)]


def test_what_cannot_be_opened(tmp_path: Path) -> None:
    with pytest.raises(MissingFile, match=r"gone\.mcap cannot be read: No such file"):
        McapFile(tmp_path / "gone.mcap")
    (tmp_path / "x.mcap").write_bytes(b"hello, world")
    with pytest.raises(DecodeError, match=r"x\.mcap: byte 0: not an MCAP file"):
        McapFile(tmp_path / "x.mcap")
