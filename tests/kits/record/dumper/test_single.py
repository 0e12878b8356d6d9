"""One folder for all that comes."""

from pathlib import Path

import numpy as np
import pytest
from support.recordings import START, payload_of
from support.wait import wait_until

import yarpy
from yarpy import record
from yarpy.errors import LocalProtocolError
from yarpy.kits.record.dumper.single import SingleFolder, classical_folder


def test_two_ports_in_one_folder(tmp_path: Path) -> None:
    folder = SingleFolder(tmp_path / "x", times="tx+rx", every=2)
    head = "Type: Bottle;\nStamp: tx+rx;\n"
    assert (tmp_path / "x" / "info.log").read_text() == head
    folder.note({"what": "connected", "port": "/a"}, START)
    folder.note({"what": "mark"}, START)
    for n in range(5):
        folder.add("/a" if n % 2 else "/b", f"{n} {n}.5", START, payload_of([n]))
    assert folder.pending == 2
    folder.flush()
    folder.close()
    assert folder.pending == 0 and folder.size == (tmp_path / "x" / "data.log").stat().st_size
    lines = (tmp_path / "x" / "data.log").read_text().splitlines()
    assert lines == ["1 1.500000 1795000000.000000 1", "3 3.500000 1795000000.000000 3"]
    connected = "[1795000000.000000] /a [connected]\n"
    assert (tmp_path / "x" / "info.log").read_text() == head + connected


def test_what_is_there_is_written_anew_if_that_is_wanted(tmp_path: Path) -> None:
    picture = payload_of(yarpy.Image(np.zeros((2, 3), "u1")))
    for count in (3, 1):
        folder = SingleFolder(tmp_path / "x", "Image", overwrite=count == 1)
        for _ in range(count):
            folder.add("/a", "", START, picture)
        folder.close()
        (tmp_path / "x" / "notes.txt").write_text("mine")
    names = ["00000000.pgm", "data.log", "info.log", "notes.txt"]
    assert sorted(file.name for file in (tmp_path / "x").iterdir()) == names
    with pytest.raises(FileExistsError):
        SingleFolder(tmp_path / "x")
    with pytest.raises(LocalProtocolError, match="there are Bottle, Image"):
        SingleFolder(tmp_path / "y", "Video")


def test_no_picture_among_pictures(tmp_path: Path) -> None:
    with yarpy.NameServer() as server, yarpy.Port("/src", names=server.client) as port:
        recorder = record.Recorder(
            path=tmp_path / "x",
            name="/in",
            format=lambda path: SingleFolder(path, "Image"),
            names=server.client,
            tell=lambda line: None,
            now=lambda: 5_000_000_000,
        )
        with recorder:
            yarpy.connect("/src", "/in", names=server.client)
            port.wait_for_outputs()
            port.write([1])
            port.write(yarpy.Image(np.zeros((2, 3), "u1")))
            wait_until(lambda: (recorder.lost, recorder.messages) == (1, 1))
    (folder,) = recorder.files
    assert (folder / "data.log").read_text() == "-1 5.000000 00000000.pgm [mono]\n"


def test_names_of_folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert classical_folder("/a/b") == Path("a/b")
    Path("a/b").mkdir(parents=True)
    Path("a/b_00001").mkdir()
    assert classical_folder("/a/b") == Path("a/b_00002")
    assert classical_folder("/a/b", overwrite=True) == Path("a/b")
    assert classical_folder("../x") == Path("__/x")
