"""A data set of LeRobot, as `layout.py` says, from recordings: each of them is an episode.

Rules: a data set that is there is not touched. Ports of numbers make one vector, in their order.
The numbers of one episode are in memory at a time, of its pictures a few; each has its own videos.
It is made under another name, and gets its own when it is whole: what a run that failed has written
goes at once, of one that was killed when it is tried again.
"""

from __future__ import annotations

import errno
import json
import os
import shutil
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from yarpy.data.sig.image import Image
from yarpy.errors import LocalProtocolError, UnknownPlugin
from yarpy.kits.record.lerobot import statistics
from yarpy.kits.record.lerobot.frames import count, frames, stretch
from yarpy.kits.record.lerobot.layout import (
    CHUNK,
    DATA_PATH,
    INDEXES,
    NEEDS,
    VERSION,
    VIDEO_PATH,
    place,
)
from yarpy.kits.record.lerobot.video import CODEC, FORMAT, GROUP, QUALITY, Video
from yarpy.kits.record.recorded import Recorded
from yarpy.kits.record.recording import open_recording


@dataclass(frozen=True)
class Plan:
    """The ports that a data set is made of. states, actions: ports of numbers; images: ports of
    pictures, by the names that they get. fps: frames a second. task: what the robot does, as a
    sentence."""

    states: Sequence[str]
    actions: Sequence[str] = ()
    images: Mapping[str, str] = field(default_factory=dict)
    fps: int = 30
    task: str = ""
    robot: str = ""

    def __post_init__(self) -> None:
        if not self.states:
            raise LocalProtocolError("a data set needs a state of the robot: --state /PORT")
        for name in self.images:
            if not name or "/" in name or "." in name:
                raise LocalProtocolError(f'"{name}" is no name of pictures: --image /PORT=left')

    @property
    def ports(self) -> list[str]:
        """Return all ports."""
        return [*dict.fromkeys((*self.states, *self.actions, *self.images.values()))]

    @property
    def vectors(self) -> dict[str, Sequence[str]]:
        """Return the features that are numbers, with their ports."""
        found = {"observation.state": self.states}
        return {**found, "action": self.actions} if self.actions else found


def export(paths: Sequence[str | Path], folder: Path, plan: Plan) -> int:
    """Write recordings as the data set `folder`; return how many frames it has. Raises
    FileExistsError, UnknownPlugin without pyarrow or ffmpeg, LocalProtocolError for what is no
    episode, and as reading does."""
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError:
        raise UnknownPlugin(NEEDS) from None
    if folder.exists():
        raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(folder))
    unfinished = folder.with_name(f".{folder.name}.unfinished")
    shutil.rmtree(unfinished, ignore_errors=True)
    unfinished.mkdir(parents=True)
    try:
        with ExitStack() as stack:
            made = _Making(unfinished, plan, pyarrow, stack)
            for path in paths:
                made.episode(path)
        made.describe()
        unfinished.rename(folder)
    except BaseException:
        shutil.rmtree(unfinished, ignore_errors=True)
        raise
    return made.frames


class _Making:
    """A data set that is being made."""

    def __init__(self, folder: Path, plan: Plan, arrow: Any, stack: ExitStack) -> None:
        self._folder = folder
        self._plan = plan
        self._arrow = arrow
        self._stack = stack
        self._writer: Any = None
        self._episodes: list[dict[str, Any]] = []
        self._statistics: list[dict[str, statistics.Statistics]] = []
        self._names: dict[str, list[str]] = {}
        self._shapes: dict[str, tuple[int, ...]] = {}
        self.frames = 0

    def episode(self, path: str | Path) -> None:
        """Append a recording."""
        plan, number = self._plan, len(self._episodes)
        rows: dict[str, list[Any]] = {name: [] for name in plan.vectors}
        seen: dict[str, list[Any]] = {name: [] for name in plan.images}
        with open_recording(path) as recording, ExitStack() as stack:
            begin, end = stretch(recording, plan.ports)
            total = count(begin, end, plan.fps)
            videos: dict[str, Video] = {}
            for at, last in enumerate(frames(recording, plan.ports, plan.fps, begin, end)):
                for name, ports in plan.vectors.items():
                    rows[name].append(self._vector(name, ports, last))
                for name, port in plan.images.items():
                    picture = last[port].as_(Image).converted("rgb").array
                    if name not in videos:
                        videos[name] = self._video(name, picture, number)
                        stack.callback(videos[name].close)
                    videos[name].add(picture)
                    if at % statistics.every(total) == 0:
                        seen[name].append(statistics.small(picture))
            for video in videos.values():
                video.finish()
        found = self._write(rows, number, total)
        for name, pictures in seen.items():
            found[_key(name)] = statistics.of_pictures(pictures)
        self._statistics.append(found)
        self._episodes.append(self._row(number, total, found))
        self.frames += total

    def _vector(self, name: str, ports: Sequence[str], last: Mapping[str, Recorded]) -> Any:
        import numpy as np

        parts = [np.asarray(last[port].as_(np.ndarray), "f4").ravel() for port in ports]
        names = [
            f"{port.strip('/').replace('/', '_')}.{number}"
            for port, part in zip(ports, parts, strict=True)
            for number in range(len(part))
        ]
        if self._names.setdefault(name, names) != names:
            raise LocalProtocolError(
                f"{name} has {len(self._names[name])} numbers, and {len(names)} later: a "
                "data set has as many in each frame"
            )
        return np.concatenate(parts)

    def _video(self, name: str, picture: Any, number: int) -> Video:
        if self._shapes.setdefault(name, picture.shape) != picture.shape:
            raise LocalProtocolError(
                f"the pictures {name} of an episode have another size than those before"
            )
        height, width, _ = picture.shape
        path = self._folder / "videos" / _key(name) / f"{_place(number)}.mp4"
        return Video(path, width, height, self._plan.fps)

    def _write(
        self, rows: Mapping[str, list[Any]], number: int, total: int
    ) -> dict[str, statistics.Statistics]:
        """Write the rows of an episode; return the statistics of its numbers."""
        import numpy as np

        arrow, at = self._arrow, np.arange(total)
        scalars = {
            "timestamp": (at / self._plan.fps).astype("f4"),
            "frame_index": at,
            "episode_index": np.full(total, number),
            "index": at + self.frames,
            "task_index": np.zeros(total, "i8"),
        }
        columns: dict[str, Any] = {}
        found = {}
        for name, listed in rows.items():
            array = np.stack(listed)
            flat = arrow.array(array.ravel(), arrow.float32())
            width = array.shape[1]  # one number is no list for those who read it
            columns[name] = flat
            if width > 1:
                columns[name] = arrow.FixedSizeListArray.from_arrays(flat, width)
            found[name] = statistics.of_numbers(array)
        for name, array in scalars.items():
            columns[name] = arrow.array(array)
            found[name] = statistics.of_numbers(array[:, None])
        table = arrow.table(columns)
        if self._writer is None:
            path = self._folder / "data" / f"{_place(0)}.parquet"
            path.parent.mkdir(parents=True)
            self._writer = arrow.parquet.ParquetWriter(path, table.schema)
            self._stack.callback(self._writer.close)
        self._writer.write_table(table)
        return found

    def _row(
        self, number: int, total: int, found: Mapping[str, statistics.Statistics]
    ) -> dict[str, Any]:
        """Return what is told of an episode."""
        row: dict[str, Any] = {
            "episode_index": number,
            "tasks": [self._plan.task],
            "length": total,
            "data/chunk_index": 0,
            "data/file_index": 0,
            "dataset_from_index": self.frames,
            "dataset_to_index": self.frames + total,
        }
        for name in self._plan.images:
            row |= {
                f"videos/{_key(name)}/chunk_index": number // CHUNK,
                f"videos/{_key(name)}/file_index": number % CHUNK,
                f"videos/{_key(name)}/from_timestamp": 0.0,
                f"videos/{_key(name)}/to_timestamp": total / self._plan.fps,
            }
        row |= {"meta/episodes/chunk_index": 0, "meta/episodes/file_index": 0}
        for name, all_ in found.items():
            row |= {f"stats/{name}/{word}": value.tolist() for word, value in all_.items()}
        return row

    def describe(self) -> None:
        """Write what is told of the whole."""
        arrow, meta = self._arrow, self._folder / "meta"
        episodes = meta / "episodes" / f"{_place(0)}.parquet"
        episodes.parent.mkdir(parents=True)
        arrow.parquet.write_table(arrow.Table.from_pylist(self._episodes), episodes)
        tasks = arrow.table({"task_index": [0], "task": [self._plan.task]})
        # The sentence is the index of a DataFrame of pandas, which reads so from its metadata.
        told = {
            "index_columns": ["task"],
            "column_indexes": [],
            "columns": [
                _column("task_index", "int64", "int64"),
                _column("task", "unicode", "object"),
            ],
            "pandas_version": "2.0.0",
        }
        tasks = tasks.replace_schema_metadata({"pandas": json.dumps(told)})
        arrow.parquet.write_table(tasks, meta / "tasks.parquet")
        whole = {
            name: statistics.together([one[name] for one in self._statistics])
            for name in self._statistics[0]
        }
        listed = {name: {w: v.tolist() for w, v in all_.items()} for name, all_ in whole.items()}
        for name, found in (("stats", listed), ("info", self._info())):
            text = json.dumps(found, indent=4, ensure_ascii=False)
            (meta / f"{name}.json").write_text(text, encoding="utf-8")

    def _info(self) -> dict[str, Any]:
        features: dict[str, Any] = {
            name: {"dtype": "float32", "shape": [len(names)], "names": names}
            for name, names in self._names.items()
        }
        for name, (height, width, channels) in self._shapes.items():
            features[_key(name)] = {
                "dtype": "video",
                "shape": [height, width, channels],
                "names": ["height", "width", "channels"],
                "info": {
                    "is_depth_map": False,
                    "video.height": height,
                    "video.width": width,
                    "video.codec": CODEC,
                    "video.pix_fmt": FORMAT,
                    "video.fps": self._plan.fps,
                    "video.channels": channels,
                    "video.g": GROUP,
                    "video.crf": QUALITY,
                    "has_audio": False,
                },
            }
        features["timestamp"] = {"dtype": "float32", "shape": [1], "names": None}
        features |= {name: {"dtype": "int64", "shape": [1], "names": None} for name in INDEXES}
        return {
            "codebase_version": VERSION,
            "robot_type": self._plan.robot or None,
            "total_episodes": len(self._episodes),
            "total_frames": self.frames,
            "total_tasks": 1,
            "chunks_size": CHUNK,
            "data_files_size_in_mb": 100,
            "video_files_size_in_mb": 200,
            "fps": self._plan.fps,
            "splits": {"train": f"0:{len(self._episodes)}"},
            "data_path": DATA_PATH,
            "video_path": VIDEO_PATH if self._shapes else None,
            "features": features,
        }


def _key(name: str) -> str:
    return f"observation.images.{name}"


def _place(number: int) -> str:
    return place(number // CHUNK, number % CHUNK)


def _column(name: str, kind: str, numpy: str) -> dict[str, Any]:
    return {
        "name": name,
        "field_name": name,
        "pandas_type": kind,
        "numpy_type": numpy,
        "metadata": None,
    }
