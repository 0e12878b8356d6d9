"""A data set of LeRobot, version 3.0: where its files are, and what it says of itself.

    meta/info.json   meta/stats.json   meta/tasks.parquet   meta/episodes/chunk-000/file-000.parquet
    data/chunk-000/file-000.parquet    videos/observation.images.NAME/chunk-000/file-000.mp4

Rules: what a stranger's set says is checked here: no name leads out of its folder.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from math import prod
from pathlib import Path
from typing import Any, Final

from yarpy.errors import DecodeError
from yarpy.limit import limits

VERSION: Final = "v3.0"
CHUNK: Final = 1000  # files of a folder
INFO: Final = "meta/info.json"
INDEXES: Final = ("frame_index", "episode_index", "index", "task_index")
NEEDS: Final = 'a data set needs pyarrow: pip install "yarpy[table]"'
_FILE: Final = "chunk-{chunk_index:03d}/file-{file_index:03d}"
DATA_PATH: Final = f"data/{_FILE}.parquet"
VIDEO_PATH: Final = f"videos/{{video_key}}/{_FILE}.mp4"
_NAME: Final = re.compile(r"[A-Za-z0-9_-][A-Za-z0-9_.-]{0,199}", re.ASCII)
_SLOWEST: Final = 0.001  # frames a second
_FASTEST: Final = 1_000_000


def is_dataset(path: Path) -> bool:
    """Return whether there is a data set of LeRobot."""
    return (path / INFO).is_file()


def place(chunk: int, file: int) -> str:
    """Return where a file is, without its ending.

    >>> place(0, 12)
    'chunk-000/file-012'
    """
    return _FILE.format(chunk_index=chunk, file_index=file)


@dataclass(frozen=True)
class Feature:
    """A part of each frame: `shape` of its numbers, what these are called, `kind` as the set calls
    it (float32, video, ...)."""

    name: str
    kind: str
    shape: tuple[int, ...]
    names: tuple[str, ...] = ()

    @property
    def port(self) -> str:
        """Return what its port is called."""
        return f"/{self.name.replace('.', '/')}"

    @property
    def size(self) -> int:
        """Return how many numbers it has."""
        return prod(self.shape)


@dataclass(frozen=True)
class Info:
    """A data set: frames a second, the robot, and the features that are no numbering."""

    fps: float
    robot: str
    features: tuple[Feature, ...]


def parse_info(text: bytes) -> Info:
    """Return what `meta/info.json` says. Raises DecodeError."""
    try:
        said = json.loads(text)
        version, fps = str(said["codebase_version"]), float(said["fps"])
        if not version.startswith("v3."):
            raise DecodeError(f"version {version[:20]}: LeRobot's own tools make version 3.0 of it")
        if not _SLOWEST <= fps <= _FASTEST:
            raise DecodeError(f"{fps} frames a second")
        for key, usual in (("data_path", DATA_PATH), ("video_path", VIDEO_PATH)):
            if said.get(key) not in (None, usual):
                raise DecodeError(f"{key} is {str(said[key])[:200]!r}, and only {usual} is read")
        found = [
            _feature(name, what)
            for name, what in said["features"].items()
            if name not in (*INDEXES, "timestamp")
        ]
    except DecodeError:  # a ValueError, too
        raise
    except (
        ValueError,
        KeyError,
        TypeError,
        AttributeError,
        OverflowError,
        RecursionError,
    ) as error:
        raise DecodeError(f"it says nothing that can be read: {error!r:.200}") from error
    if len({feature.port for feature in found}) < len(found):
        raise DecodeError("two of its features are one port")
    return Info(fps, str(said.get("robot_type") or ""), tuple(found))


def _feature(name: str, what: dict[str, Any]) -> Feature:
    if not _NAME.fullmatch(name):
        raise DecodeError(f"{name[:200]!r} is no name of a feature")
    shape = tuple(map(int, what["shape"]))
    if any(size < 0 for size in shape) or prod(shape) > limits().elements:
        raise DecodeError(f"{name}: shape {str(shape)[:200]} of a feature")
    names = what.get("names")
    if isinstance(names, dict):  # by groups: {"motors": ["hip", "knee"]}
        names = [one for group in names.values() for one in group]
    return Feature(name, str(what["dtype"]), shape, tuple(map(str, names or ())))
