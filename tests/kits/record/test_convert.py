"""Recordings in another form, and back."""

import json
from pathlib import Path

import numpy as np
import pytest
from support.recordings import START, STEP, payload_of, recorded

import yarpy
from yarpy import record
from yarpy.errors import UnknownName
from yarpy.kits.record.convert import convert
from yarpy.kits.record.mcap.writer import McapWriter


def kept(path: Path) -> list[tuple[str, int, str, bytes]]:
    with record.open(path) as found:
        return [(one.port, one.received_ns, one.envelope, bytes(one.payload)) for one in found]


def test_there_and_back(tmp_path: Path) -> None:
    """What text can hold comes back to the byte, with the times to the microsecond."""
    path = tmp_path / "x.mcap"
    with McapWriter(path) as writer:
        for n, value in enumerate(
            (
                [1, "two words"],
                yarpy.Vector([0.5]),
                yarpy.Image(np.ones((2, 4, 3), "u1")),
                [2.5, []],
            )
        ):
            writer.add(f"/p{n}", f"{n} 100.25", START + n * STEP, payload_of(value))
    with record.open(path) as found:
        done = convert(found, tmp_path / "cpp", form="dumper", times="tx+rx")
    assert (done.path, done.messages, done.left_out) == (tmp_path / "cpp", 4, 0)
    with record.open(tmp_path / "cpp") as found:
        convert(found, tmp_path / "back", compression="zstd")
    assert kept(tmp_path / "back.mcap") == kept(path)


def test_an_unfinished_and_damaged_file_becomes_whole(tmp_path: Path) -> None:
    path = recorded(tmp_path / "x.mcap")
    whole = kept(path)
    path.write_bytes(path.read_bytes()[:-200])
    with record.open(path) as found:
        assert not found.complete
        done = convert(found, tmp_path / "y")
    with record.open(done.path) as found:
        assert found.complete
    assert kept(done.path) == whole


def test_a_part_of_it(tmp_path: Path) -> None:
    path = recorded(tmp_path / "x.mcap")
    with record.open(path) as found:
        done = convert(found, tmp_path / "y.mcap", ports=["/b"], start=0.03, duration=0.05)
        with pytest.raises(UnknownName):
            convert(found, tmp_path / "z", ports=["/x"])
        with pytest.raises(FileExistsError):
            convert(found, tmp_path / "y")
    assert [one[2] for one in kept(done.path)] == ["3 3.5", "5 5.5", "7 7.5"]
    assert not (tmp_path / "z.mcap").exists()


def test_several_become_one_with_their_notes(tmp_path: Path) -> None:
    for n, name in enumerate(("a", "b")):
        with McapWriter(tmp_path / f"{name}.mcap", metadata={"host": name}) as writer:
            writer.add(f"/{name}", "", START + n, payload_of([n]))
            writer.note({"what": "mark", "text": name}, START + n)
            writer.add_metadata("yarpy", {"lost": json.dumps({"/a": n + 1})})
    with record.open(tmp_path / "a.mcap", tmp_path / "b.mcap") as found:
        convert(found, tmp_path / "c")
    with record.open(tmp_path / "c.mcap") as found:
        assert [note["text"] for note in found.notes()] == ["a", "b"] and len([*found]) == 2
        assert found.storages[0].facts == {"host": "b", "lost": '{"/a": 3}'}


def test_what_has_no_text_is_counted(tmp_path: Path) -> None:
    with McapWriter(tmp_path / "x.mcap") as writer:
        writer.add("/a", "", START, b"\xff\xff")
        writer.add("/a", "", START, payload_of([1]))
    with record.open(tmp_path / "x.mcap") as found:
        done = convert(found, tmp_path / "y", form="dumper")
    assert (done.messages, done.left_out) == (1, 1)
