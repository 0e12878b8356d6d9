"""Files as a page sees them."""

import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from support.recordings import START, STEP, recorded
from support.wait import HANG, wait_until

from yarpy.errors import MissingFile
from yarpy.kits.record.mcap.writer import McapWriter
from yarpy.kits.record.recorded import Recorded
from yarpy.kits.record.recording import Recording
from yarpy.kits.record.view.source import FileSource


def test_the_time_line(tmp_path: Path) -> None:
    path = recorded(tmp_path / "x.mcap", 100)
    with FileSource([path]) as source:
        assert source.kinds == {"/a": "yarp/bottle", "/b": "yarp/bottle"} and not source.live
        assert (source.begin, source.end) == (START, START + 99 * STEP)
        wait_until(lambda: source.told()["seen"] == 1)
        told = source.told()
        assert told["title"] == "x.mcap" and told["begin"] == str(START)
        assert [(one["name"], one["messages"]) for one in told["ports"]] == [("/a", 50), ("/b", 50)]
        assert [sum(one["bins"]) for one in told["ports"]] == [50, 50] and told["problem"] == ""
        with source.open() as recording:
            found = source.before(recording, ["/a", "/b"], START + 13 * STEP)
            assert {one.port: one.value for one in found} == {"/a": [12], "/b": [13]}
            assert source.before(recording, ["/b", "/c"], START) == []


def test_marks_and_damage(tmp_path: Path) -> None:
    path = tmp_path / "x.mcap"
    with McapWriter(path) as writer:
        writer.add("/a", "", START, b"\0" * 40)
        writer.note({"what": "mark", "text": "here"}, START + 5 * STEP)
        writer.flush()
        writer.add("/a", "", START + 10 * STEP, b"\0" * 4000)
    data = bytearray(path.read_bytes())
    place = data.index(b"\0" * 4000)
    data[place + 100] = 1
    path.write_bytes(data)
    with FileSource([path]) as source:
        wait_until(lambda: source.told()["seen"] == 1)
        told = source.told()
        assert told["notes"] == [{"t": 0.05, "what": "mark", "text": "here"}]
        assert "x.mcap" in told["problem"]


def test_it_is_not_all_there_before_its_damage_is_known(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nor while messages of the last moment are missing: a page asks no more then."""
    path = recorded(tmp_path / "x.mcap", 100)
    between = Recording.between
    looked, go = threading.Event(), threading.Event()

    def slow(recording: Recording, *words: Any) -> Iterator[Recorded]:
        yield from between(recording, *words)
        looked.set()
        assert go.wait(HANG)

    monkeypatch.setattr(Recording, "between", slow)
    with FileSource([path]) as source:
        assert looked.wait(HANG)
        assert source.told()["seen"] < 1
        go.set()
        wait_until(lambda: source.told()["seen"] == 1)


def test_no_file(tmp_path: Path) -> None:
    with pytest.raises(MissingFile):
        FileSource([tmp_path / "none.mcap"])
