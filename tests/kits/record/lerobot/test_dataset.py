"""A data set of LeRobot 3.0, read back by pyarrow."""

import json
import shutil
import sys
from pathlib import Path

import pytest
from support.peer import program
from support.recordings import START, episode, payload_of

import yarpy
from yarpy.errors import LocalProtocolError, UnknownPlugin
from yarpy.kits.record.lerobot.dataset import Plan, _Making, export
from yarpy.kits.record.mcap.writer import McapWriter

PLAN = Plan(["/arm", "/goal"], ["/goal"], fps=10, task="Reach", robot="icub")


def test_without_pyarrow(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(UnknownPlugin, match=r"pip install \"yarpy\[table\]\""):
        export([], tmp_path / "set", PLAN)
    assert not (tmp_path / "set").exists()


def test_what_is_no_plan() -> None:
    with pytest.raises(LocalProtocolError, match="--state"):
        Plan([])
    with pytest.raises(LocalProtocolError, match="no name of pictures"):
        Plan(["/arm"], images={"a/b": "/cam"})


def test_episodes(tmp_path: Path) -> None:
    parquet = pytest.importorskip(
        "pyarrow.parquet", reason="data sets need pyarrow: pip install 'yarpy[table]'"
    )
    paths = [episode(tmp_path / "one.mcap", 5), episode(tmp_path / "two.mcap", 3, 1000)]
    folder = tmp_path / "set"
    assert export(paths, folder, PLAN) == 8
    rows = parquet.read_table(folder / "data/chunk-000/file-000.parquet")
    assert rows.num_rows == 8
    assert str(rows["observation.state"].type).startswith("fixed_size_list<")
    assert rows["observation.state"].to_pylist()[1] == [10, -10, 10]
    assert rows["action"].to_pylist()[5:] == [1000, 1010, 1020]
    assert rows["timestamp"].to_pylist() == pytest.approx([0, 0.1, 0.2, 0.3, 0.4, 0, 0.1, 0.2])
    assert rows["frame_index"].to_pylist() == [0, 1, 2, 3, 4, 0, 1, 2]
    assert rows["episode_index"].to_pylist() == [0] * 5 + [1] * 3
    assert rows["index"].to_pylist() == [*range(8)] and set(rows["task_index"].to_pylist()) == {0}
    found = parquet.read_table(folder / "meta/episodes/chunk-000/file-000.parquet").to_pylist()
    assert [(one["dataset_from_index"], one["dataset_to_index"]) for one in found] == [
        (0, 5),
        (5, 8),
    ]
    assert [one["length"] for one in found] == [5, 3] and found[1]["tasks"] == ["Reach"]
    assert found[1]["stats/action/max"] == [1020] and found[0]["stats/action/count"] == [5]
    tasks = parquet.read_table(folder / "meta/tasks.parquet")
    assert tasks.to_pylist() == [{"task_index": 0, "task": "Reach"}]
    assert json.loads(tasks.schema.metadata[b"pandas"])["index_columns"] == ["task"]
    info = json.loads((folder / "meta/info.json").read_text(encoding="utf-8"))
    assert info["codebase_version"] == "v3.0" and info["robot_type"] == "icub"
    assert (info["total_episodes"], info["total_frames"], info["fps"]) == (2, 8, 10)
    assert info["splits"] == {"train": "0:2"} and info["video_path"] is None
    state = info["features"]["observation.state"]
    assert state == {"dtype": "float32", "shape": [3], "names": ["arm.0", "arm.1", "goal.0"]}
    stats = json.loads((folder / "meta/stats.json").read_text(encoding="utf-8"))
    assert stats["action"]["max"] == [1020] and stats["index"]["mean"] == [3.5]
    with pytest.raises(FileExistsError):
        export(paths, folder, PLAN)


def test_a_failed_run_leaves_nothing(tmp_path: Path) -> None:
    pytest.importorskip("pyarrow", reason="data sets need pyarrow: pip install 'yarpy[table]'")
    paths = [episode(tmp_path / "one.mcap", 2), tmp_path / "two.mcap"]
    with McapWriter(paths[1]) as writer:
        writer.add("/arm", "", START, payload_of(yarpy.Vector([1])))
        writer.add("/goal", "", START, payload_of([1]))
    with pytest.raises(LocalProtocolError, match=r"has 3 numbers, and 2 later"):
        export(paths, tmp_path / "set", PLAN)
    assert not (tmp_path / "set").exists()


def test_what_a_killed_run_has_left_is_in_nobodys_way(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("pyarrow", reason="data sets need pyarrow: pip install 'yarpy[table]'")
    paths = [episode(tmp_path / "one.mcap", 2)]

    def killed(*words: object, **more: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        patch.setattr(shutil, "rmtree", lambda *words, **more: None)
        patch.setattr(_Making, "describe", killed)
        export(paths, tmp_path / "set", PLAN)
    assert not (tmp_path / "set").exists(), "what is half is called otherwise"
    assert export(paths, tmp_path / "set", PLAN) == 2
    assert sorted(path.name for path in tmp_path.iterdir()) == ["one.mcap", "set"]


@pytest.mark.peer("ffmpeg")
def test_pictures(tmp_path: Path) -> None:
    parquet = pytest.importorskip(
        "pyarrow.parquet", reason="data sets need pyarrow: pip install 'yarpy[table]'"
    )
    program("ffmpeg")
    folder = tmp_path / "set"
    plan = Plan(["/arm"], images={"front": "/cam"}, fps=10)
    assert export([episode(tmp_path / "one.mcap", 5)], folder, plan) == 5
    video = folder / "videos/observation.images.front/chunk-000/file-000.mp4"
    assert video.read_bytes()[4:8] == b"ftyp"
    info = json.loads((folder / "meta/info.json").read_text(encoding="utf-8"))
    front = info["features"]["observation.images.front"]
    assert front["dtype"] == "video" and front["shape"] == [4, 6, 3]
    row = parquet.read_table(folder / "meta/episodes/chunk-000/file-000.parquet").to_pylist()[0]
    assert row["videos/observation.images.front/to_timestamp"] == 0.5
    stats = json.loads((folder / "meta/stats.json").read_text(encoding="utf-8"))
    assert stats["observation.images.front"]["max"] == [[[pytest.approx(40 / 255)]]] * 3
