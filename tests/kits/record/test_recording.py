"""Recordings of one and of several files."""

import os
from pathlib import Path

import pytest
from support.recordings import START, STEP, payload_of, recorded

import yarpy
from yarpy import record
from yarpy.errors import DecodeError, MissingFile, UnknownName
from yarpy.kits.record.mcap.writer import McapWriter


@pytest.fixture
def two(tmp_path: Path) -> Path:
    """A folder with two files: one has what comes between the messages of the other."""
    recorded(tmp_path / "one.mcap")
    with McapWriter(tmp_path / "two.mcap") as writer:
        for n in range(10):
            writer.add("/c", "", START + n * STEP + STEP // 2, payload_of([100 + n]))
            writer.add("/a", f"{n} 5", START + (20 + n) * STEP, payload_of([200 + n]))
        writer.note({"what": "mark"}, START)
    return tmp_path


def test_several_files_on_one_time_axis(two: Path) -> None:
    with record.open(two) as found:
        assert [one.as_(int) for one in found][:5] == [0, 100, 1, 101, 2]
        assert found.ports["/a"].messages == 15 and [*found.ports] == ["/a", "/b", "/c"]
        assert (found.begin, found.complete, found.damages) == (START / 1e9, True, [])
        assert found.end == (START + 29 * STEP) / 1e9
        assert [note["what"] for note in found.notes()] == ["mark"]
        assert repr(found).startswith(f"<Recording {two / 'one.mcap'} ") and repr(found).endswith(
            " s, 3 ports>"
        )
    with record.open(two / "two.mcap", two / "one.mcap") as found:
        assert len([*found]) == 30


def test_some_ports_and_some_time(two: Path) -> None:
    with record.open(two) as found:
        begin = found.begin
        some = found.messages(["/c", "/b"], begin + 0.02, begin + 0.05)
        assert [one.as_(int) for one in some] == [102, 3, 103, 104]
        with pytest.raises(UnknownName, match='"/x" was not recorded: there are /a /b /c'):
            found.messages(["/x"])


def test_numbers(tmp_path: Path) -> None:
    path = tmp_path / "x.mcap"
    with McapWriter(path) as writer:
        for n in range(3):
            writer.add("/joints", f"{n} {n}.25", START + n, payload_of(yarpy.Vector([n, -n])))
        writer.add("/mixed", "", START, payload_of([1.5]))
        writer.add("/mixed", "", START, payload_of([1, 2]))
        writer.add("/words", "", START, payload_of("hello"))
    with record.open(path) as found:
        times, values = found.numbers("/joints")
        assert times.tolist() == [0.25, 1.25, 2.25]
        assert values.tolist() == [[0, 0], [1, -1], [2, -2]]
        with pytest.raises(DecodeError, match="2 numbers, the first has 1"):
            found.numbers("/mixed")
        with pytest.raises(DecodeError):
            found.numbers("/words")


def test_nothing_to_read(tmp_path: Path) -> None:
    with McapWriter(tmp_path / "x.mcap"):
        pass
    with record.open(tmp_path / "x.mcap") as found:
        assert (found.begin, found.end, [*found], found.ports) == (0, 0, [], {})
    (tmp_path / "empty").mkdir()
    with pytest.raises(MissingFile, match="has no recording"):
        record.open(tmp_path / "empty")
    with pytest.raises(MissingFile):
        record.open(tmp_path / "x.mcap", tmp_path / "gone")
    if hasattr(os, "mkfifo"):  # opening one would wait for whoever writes to it
        os.mkfifo(tmp_path / "empty/pipe.mcap")
        with pytest.raises(MissingFile, match="has no recording"):
            record.open(tmp_path / "empty")
    with pytest.raises(MissingFile, match="an unset variable"):
        record.open("")
