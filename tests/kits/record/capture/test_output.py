"""The files of a recording."""

import shutil
from pathlib import Path

import pytest
from support.recordings import START, payload_of
from support.system import NO_UNLINK

from yarpy import record
from yarpy.kits.record.capture.disk_space import Split
from yarpy.kits.record.capture.output import Output
from yarpy.kits.record.capture.queue import QueuedMessage


def taken(n: int, size: int = 0) -> QueuedMessage:
    return QueuedMessage("/a", START + n, f"{n} 1", payload_of([n, bytes(size)]), size)


def numbers(path: Path) -> list[int]:
    with record.open(path) as found:
        return [one.value[0] for one in found]


def test_one_file(tmp_path: Path) -> None:
    output = Output(
        tmp_path / "deep" / "x", facts=lambda: {"host": "lab"}, ended=lambda: {"a": "b"}
    )
    output.add(taken(1))
    assert output.pending
    output.flush()
    assert output.path == tmp_path / "deep" / "x.mcap" and output.size and not output.pending
    output.close()
    with record.open(output.path) as found:
        assert found.storages[0].facts == {"host": "lab", "a": "b"}
        assert found.complete


def test_nothing_is_replaced(tmp_path: Path) -> None:
    (tmp_path / "x.mcap").write_text("mine")
    with pytest.raises(FileExistsError):
        Output(tmp_path / "x")
    assert (tmp_path / "x.mcap").read_text() == "mine"


def test_files_of_a_size_and_no_more_than_wanted(tmp_path: Path) -> None:
    output = Output(tmp_path / "x", split=Split(bytes=3000), most=2)
    for n in range(20):
        output.add(taken(n, 1000))
    output.close()
    assert [path.name for path in output.files] == [
        path.name for path in sorted(tmp_path.iterdir())
    ]
    assert len(output.files) == 2 and output.removed == 8
    assert [numbers(path) for path in output.files] == [[16, 17], [18, 19]]
    assert all(path.stat().st_size < 4000 for path in output.files)


def test_files_of_a_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    now = [100.0]
    monkeypatch.setattr("yarpy.kits.record.capture.output.time.monotonic", lambda: now[0])
    output = Output(tmp_path / "x", split=Split(seconds=10))
    for n in range(4):
        output.add(taken(n))
        now[0] += 6
    output.close()
    assert [numbers(path) for path in output.files] == [[0, 1], [2, 3]]
    assert output.files[0].name == "x-0001.mcap"


def test_a_new_file_on_request(tmp_path: Path) -> None:
    output = Output(tmp_path / "x")
    output.add(taken(1))
    output.split()
    output.add(taken(2))
    output.close()
    assert [path.name for path in output.files] == ["x.mcap", "x-0002.mcap"]
    assert [numbers(path) for path in output.files] == [[1], [2]]
    assert output.size == sum(path.stat().st_size for path in output.files)


@pytest.mark.skipif(bool(NO_UNLINK), reason=NO_UNLINK)
def test_a_folder_that_is_taken_away(tmp_path: Path) -> None:
    output = Output(tmp_path / "deep" / "x")
    output.add(taken(1))
    output.flush()
    assert not output.gone
    shutil.rmtree(tmp_path / "deep")
    assert output.gone
    output.leave()
    output.add(taken(2))
    output.close()
    assert [path.name for path in output.files] == ["x-0002.mcap"]
    assert numbers(output.path) == [2]


def test_the_folders_of_cpp_alone_or_beside_the_file(tmp_path: Path) -> None:
    for kind, names in (("dumper", {"x"}), ("both", {"x.mcap", "x"})):
        where = tmp_path / kind
        output = Output(where / "x", format=kind)  # type: ignore[arg-type]
        output.add(taken(1))
        if kind == "both":
            output.add(QueuedMessage("/odd", START, "", b"\1", 1))  # in the file alone
        output.note({"what": "connected", "port": "/b"}, START)
        assert output.pending
        output.flush()
        output.sync()
        assert output.size and not output.pending
        output.close()
        assert {file.name for file in where.iterdir()} == names
        assert (where / "x" / "a" / "data.log").read_text().startswith("1 1.000000 1 {")
        if kind == "both":
            with record.open(where / "x.mcap") as found:
                assert sorted(found.ports) == ["/a", "/odd"] and len([*found]) == 2
            (where / "x.mcap").unlink()
            with pytest.raises(FileExistsError):
                Output(where / "x", format="both")
            assert not (where / "x.mcap").exists()


def test_folders_in_a_ring(tmp_path: Path) -> None:
    for kind in ("dumper", "both"):
        where = tmp_path / kind
        output = Output(where / "x", split=Split(), most=2, format=kind)  # type: ignore[arg-type]
        for n in range(4):
            output.add(taken(n))
            output.split()
        output.close()
        kept = {"x-0004", "x-0005"}
        assert {file.stem for file in where.iterdir()} == kept and output.removed == 3


def test_files_of_an_older_recording_are_stepped_over(tmp_path: Path) -> None:
    for kind in ("mcap", "dumper", "both"):
        where = tmp_path / kind
        old = where / ("x-0002" if kind == "dumper" else "x-0002.mcap")
        old.mkdir(parents=True)
        if kind == "both":
            (where / "x-0003").mkdir()
        output = Output(where / "x", format=kind)  # type: ignore[arg-type]
        output.split()
        output.close()
        assert output.path.stem == ("x-0004" if kind == "both" else "x-0003")
        assert old.exists() and len(output.files) == 2
