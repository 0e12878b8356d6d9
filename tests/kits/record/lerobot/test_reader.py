"""Data sets of LeRobot as recordings: what was written is read, and what lies is told."""

import json
import os
import shutil
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
from support.peer import program
from support.recordings import episode

from yarpy import record
from yarpy.errors import DecodeError, UnknownName, UnknownPlugin
from yarpy.kits.record.convert import convert
from yarpy.kits.record.envelope import SECOND
from yarpy.kits.record.lerobot.dataset import Plan, export
from yarpy.kits.record.lerobot.reader import LeRobotStorage

arrow: Any = pytest.importorskip(
    "pyarrow", reason="data sets need pyarrow: pip install 'yarpy[table]'"
)
parquet: Any = pytest.importorskip("pyarrow.parquet")

STATE, ACTION = "/observation/state", "/action"
DATA = "data/chunk-000/file-000.parquet"
EPISODES = "meta/episodes/chunk-000/file-000.parquet"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Episodes of five and of three frames, at 10 a second."""
    paths = [episode(tmp_path / "one.mcap", 5), episode(tmp_path / "two.mcap", 3, 1000)]
    plan = Plan(["/arm", "/goal"], ["/goal"], fps=10, task="Reach", robot="icub")
    assert export(paths, tmp_path / "set", plan) == 8
    return tmp_path / "set"


def rewrite(path: Path, change: Callable[[dict[str, list[Any]]], object]) -> None:
    table = parquet.read_table(path)
    columns = table.to_pydict()
    change(columns)
    kept = {name: arrow.array(column) for name, column in columns.items()}
    parquet.write_table(arrow.table(kept), path)


def add(folder: Path, name: str, kind: str, shape: list[int], column: list[Any]) -> None:
    """Let a set have one more feature."""
    info = json.loads((folder / "meta/info.json").read_text(encoding="utf-8"))
    info["features"][name] = {"dtype": kind, "shape": shape, "names": None}
    (folder / "meta/info.json").write_text(json.dumps(info), encoding="utf-8")
    rewrite(folder / DATA, lambda columns: columns.update({name: column}))


def test_what_was_written(folder: Path) -> None:
    with record.open(folder) as found:
        assert {name: (one.kinds, one.messages) for name, one in found.ports.items()} == {
            STATE: (["yarp/vector"], 8),
            ACTION: (["yarp/vector"], 8),
            "/task": (["yarp/bottle"], 2),
        }
        assert found.complete and (found.begin, found.end) == (1.0, 1.7)
        times, states = found.numbers(STATE)
        assert times.tolist() == pytest.approx([1 + n / 10 for n in range(8)])
        assert states[:5].tolist() == [[10 * n, -10 * n, 10 * n] for n in range(5)]
        assert states[5:].tolist() == [[1000 + 10 * n, -10 * n, 1000 + 10 * n] for n in range(3)]
        assert found.numbers(ACTION)[1].ravel().tolist() == states[:, 2].tolist()
        assert [(one.received, one.value) for one in found.messages(["/task"])] == [
            (1.0, ["Reach"]),
            (1.5, ["Reach"]),
        ]
        assert found.mark("episode 1") == pytest.approx(0.5)
        assert [one.stamp.count for one in found.messages([STATE])] == [*range(8)]
        with pytest.raises(UnknownName):
            found.messages(["/x"])
        assert found.damages == []


def test_a_part(folder: Path) -> None:
    storage = LeRobotStorage(folder)
    for first in range(9):
        for last in range(first, 9):
            begin, end = (SECOND + n * SECOND // 10 for n in (first, last))
            found = [*storage.messages([STATE], begin, end)]
            assert [one.received_ns for one in found] == [
                SECOND + n * SECOND // 10 for n in range(first, last)
            ]
            assert [one.value[1] for one in found] == [
                -10.0 * (n if n < 5 else n - 5) for n in range(first, last)
            ]


def test_a_set_that_says_it_goes_on_for_ever(folder: Path) -> None:
    rewrite(folder / EPISODES, lambda columns: columns.update(dataset_to_index=[5, 10**15]))
    with record.open(folder) as found:
        assert len([*found.messages([STATE])]) == 8
        assert "ends before frame 8" in found.damages[0]


def test_there_and_back(folder: Path, tmp_path: Path) -> None:
    """The set as a recording, and that as a set again."""
    with record.open(folder) as found:
        assert convert(found, tmp_path / "x").messages == 18
    with record.open(tmp_path / "x.mcap") as found:
        assert found.mark("episode 1") == pytest.approx(0.5)
    plan = Plan([STATE], [ACTION], fps=10, task="Reach")
    assert export([tmp_path / "x.mcap"], tmp_path / "again", plan) == 8
    one, two = (parquet.read_table(path / DATA) for path in (folder, tmp_path / "again"))
    for name in ("observation.state", "action"):
        assert one[name].to_pylist() == two[name].to_pylist()


def test_what_other_sets_have(folder: Path) -> None:
    """Flags, texts, rows and columns, and a list that is not of a fixed size."""
    more = {
        "next.done": ("bool", [1], [n == 7 for n in range(8)]),
        "language": ("string", [1], [f"say {n}" for n in range(8)]),
        "touch": ("float64", [2, 2], [[[n, 1], [2, 3]] for n in range(8)]),
        "gaze": ("float32", [2], [[n, 0.5] for n in range(8)]),
    }
    said = json.loads((folder / "meta/info.json").read_text(encoding="utf-8"))
    for name, (kind, shape, _) in more.items():
        said["features"][name] = {"dtype": kind, "shape": shape, "names": None}
    (folder / "meta/info.json").write_text(json.dumps(said), encoding="utf-8")
    rewrite(folder / DATA, lambda columns: columns.update({k: v[2] for k, v in more.items()}))
    with record.open(folder) as found:
        *_, done = found.messages(["/next/done"])
        assert done.value.tolist() == [1.0]
        assert [one.value for one in found.messages(["/language"])][3] == ["say 3"]
        touch = [one.value for one in found.messages(["/touch"])][4]
        assert np.asarray(touch).tolist() == [[4, 1], [2, 3]]
        assert [one.value.tolist() for one in found.messages(["/gaze"])][2] == [2, 0.5]
        assert found.ports["/touch"].kinds == ["yarp/matrix"] and found.damages == []


def test_pictures_that_are_in_the_rows(folder: Path) -> None:
    cv2 = pytest.importorskip("cv2", reason="PNG needs OpenCV: pip install 'yarpy[vision]'")
    said = json.loads((folder / "meta/info.json").read_text(encoding="utf-8"))
    said["features"]["eye"] = {"dtype": "image", "shape": [4, 6, 3], "names": None}
    (folder / "meta/info.json").write_text(json.dumps(said), encoding="utf-8")
    files = [cv2.imencode(".png", np.full((4, 6, 3), n, "u1"))[1].tobytes() for n in range(7)]
    rows = [{"bytes": data, "path": None} for data in (*files, b"none")]
    rewrite(folder / DATA, lambda columns: columns.update(eye=rows))
    with record.open(folder) as found:
        assert found.ports["/eye"].kinds == ["yarp/image"]
        assert len([*found.messages([STATE])]) == 8
        assert [one.value.array.mean() for one in found.messages(["/eye"])] == [*range(7)]
        assert "eye is no picture" in found.damages[0]


@pytest.mark.peer("ffmpeg")
def test_pictures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program("ffmpeg")
    paths = [episode(tmp_path / "one.mcap", 5), episode(tmp_path / "two.mcap", 3)]
    plan = Plan(["/arm"], images={"front": "/cam"}, fps=10)
    folder = tmp_path / "set"
    assert export(paths, folder, plan) == 8
    port = "/observation/images/front"
    with record.open(folder) as found:
        assert found.ports[port].kinds == ["yarp/image"]
        levels = [one.value.array.mean() for one in found.messages([port])]
        assert levels == pytest.approx([0, 10, 20, 30, 40, 0, 10, 20], abs=4)
        later = [one.value.array.mean() for one in found.messages([port], begin=1.25, end=1.65)]
        assert later == pytest.approx([30, 40, 0, 10], abs=4)
        assert [one.port for one in found.messages(begin=1.65)] == [STATE, port]
    video = folder / "videos/observation.images.front/chunk-000/file-001.mp4"
    video.write_bytes(video.read_bytes()[:500])
    with record.open(folder) as found:
        assert len([*found.messages([port])]) == 5
        assert len([*found.messages([STATE])]) == 8
        assert "file-001.mp4 has 0 of 3 pictures" in found.damages[0] and len(found.damages) == 1
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with record.open(folder) as found:
        assert len([*found.messages([STATE])]) == 8
        with pytest.raises(UnknownPlugin, match="install the program ffmpeg"):
            next(found.messages([port]))


def shorten(columns: dict[str, list[Any]]) -> None:
    for name in columns:
        columns[name] = columns[name][:6]


def turn(columns: dict[str, list[Any]]) -> None:
    columns["index"].reverse()


def narrow(columns: dict[str, list[Any]]) -> None:
    columns["observation.state"] = [row[:2] for row in columns["observation.state"]]


def hole(columns: dict[str, list[Any]]) -> None:
    columns["observation.state"][2] = None


def words(columns: dict[str, list[Any]]) -> None:
    columns["observation.state"] = ["x"] * 8


@pytest.mark.parametrize(
    ("change", "left", "said"),
    [
        (shorten, 6, "ends before frame 6"),
        (turn, 0, "no frames in their order"),
        (narrow, 0, "from frame 0 on: cannot reshape"),
        (hole, 0, "is not in every row"),
        (words, 0, "is no numbers"),
        (lambda columns: columns.pop("observation.state"), 0, "observation.state"),
    ],
    ids=["shorten", "turn", "narrow", "hole", "words", "pop"],
)
def test_rows_that_are_none(folder: Path, change: Any, left: int, said: str) -> None:
    rewrite(folder / DATA, change)
    with record.open(folder) as found:
        assert len([*found.messages([STATE])]) == left
        assert said in found.damages[0] and DATA in found.damages[0]


def test_a_file_that_is_gone(folder: Path) -> None:
    (folder / DATA).unlink()
    with record.open(folder) as found:
        assert [one.port for one in found] == ["/task", "/task"]
        assert "cannot be read" in found.damages[0]


@pytest.mark.parametrize(
    "change",
    [
        lambda columns: columns.update(dataset_from_index=[0, 4]),
        lambda columns: columns.update(dataset_to_index=[5, 1]),
        lambda columns: columns.update({"data/file_index": [None, 0]}),
        lambda columns: columns.pop("tasks"),
        lambda columns: [columns.update({name: columns[name][:0]}) for name in columns],
    ],
    ids=["from", "to", "none", "tasks", "empty"],
)
def test_episodes_that_are_none(folder: Path, change: Any) -> None:
    rewrite(folder / EPISODES, change)
    with pytest.raises(DecodeError, match=r"meta.episodes"):
        record.open(folder)


@pytest.mark.parametrize("name", [DATA, EPISODES])
@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_a_pipe_is_not_waited_for(folder: Path, name: str) -> None:
    (folder / name).unlink()
    os.mkfifo(folder / name)
    with pytest.raises(DecodeError, match="no such file"), record.open(folder) as found:
        assert [one.port for one in found] == ["/task", "/task"]
        raise DecodeError(found.damages[0])


@pytest.mark.parametrize(
    ("kind", "column"),
    [
        ("float32", [{"x": 1.0}] * 8),
        ("float32", [[{"x": 1.0}]] * 8),
        ("image", [1.0] * 8),
        ("image", ["x"] * 8),
    ],
    ids=["struct", "structs", "number", "text"],
)
def test_a_column_of_another_kind(folder: Path, kind: str, column: list[Any]) -> None:
    add(folder, "other", kind, [1], column)
    with record.open(folder) as found:
        assert not [*found.messages(["/other"])]
        assert DATA in found.damages[0]


def test_a_text_that_takes_no_room_in_the_file(folder: Path) -> None:
    """Two gigabytes of one text in 2000 rows are one megabyte in memory, and one row at a time."""
    text = "x" * (1 << 20)
    add(folder, "other", "string", [1], [text] * 8)
    table = parquet.read_table(folder / DATA)
    rewrite(folder / EPISODES, lambda columns: columns.update(dataset_to_index=[5, 2000]))
    more = {name: table[name].take([0] * 2000) for name in table.column_names if name != "other"}
    more["index"] = arrow.array(range(2000))
    more["other"] = arrow.DictionaryArray.from_arrays([0] * 2000, [text])
    parquet.write_table(arrow.table(more), folder / DATA)
    before = arrow.default_memory_pool().max_memory()
    with record.open(folder) as found:
        assert next(iter(found.messages(["/other"]))).value == [text]
    assert arrow.default_memory_pool().max_memory() < before + (1 << 27)


def test_a_long_task(folder: Path) -> None:
    rewrite(folder / EPISODES, lambda columns: columns.update(tasks=[["x" * (1 << 21)]] * 2))
    with pytest.raises(DecodeError, match="a task of 2097152 characters"):
        record.open(folder)


def test_without_pyarrow(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "pyarrow", None)
    with pytest.raises(UnknownPlugin, match=r"yarpy\[table\]"):
        record.open(folder)


@pytest.mark.parametrize("name", [DATA, EPISODES, "meta/info.json"])
def test_flipped_bits(folder: Path, name: str) -> None:
    """Each is told, or was of no weight: nothing else comes of it."""
    random, path = Random(27), folder / name
    whole = path.read_bytes()
    for _ in range(100):
        data = bytearray(whole)
        data[random.randrange(len(data))] ^= 1 << random.randrange(8)
        path.write_bytes(data)
        try:
            with record.open(folder) as found:
                for one in found:
                    assert one.size < 1000
        except DecodeError:
            pass
