"""A data set of LeRobot that is read: each feature is a port, `observation.state` is
`/observation/state`, and its frames are messages.

Rules: a set has no time of day: it begins one second after 1970, and its episodes follow each
other without a gap, each with a mark, `episode 3`, and with its task as a text of the port `/task`.
Some rows and some pictures are in memory at a time. What is wrong is told, and the rest read.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Container, Generator, Iterator, Sequence
from contextlib import ExitStack, closing
from pathlib import Path
from typing import Any, Final, NamedTuple, TypeAlias

import numpy as np

from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.data.sig.matrix import Matrix
from yarpy.data.sig.vector import Vector
from yarpy.errors import DecodeError, MissingFile, UnknownPlugin
from yarpy.kits.record.dumper.picture import read_picture
from yarpy.kits.record.envelope import SECOND, stamp_text
from yarpy.kits.record.lerobot.layout import INFO, NEEDS, Feature, parse_info, place
from yarpy.kits.record.lerobot.pictures import pictures
from yarpy.kits.record.mcap.layout import Damaged
from yarpy.kits.record.mcap.storage import FOREVER
from yarpy.kits.record.recorded import PortFacts, Recorded
from yarpy.limit import (
    LEROBOT_EPISODES,
    LEROBOT_ROW_GROUP,
    RECORDED_NOTES,
    RECORDED_TEXT,
    limits,
)
from yarpy.platform.refusal import reason

TASK: Final = "/task"
_BATCH: Final = 1024  # rows at a time
_LONGEST: Final = 16  # bytes of a value that is no text
_TASKS: Final = "tasks"
_EPISODE: Final = (
    "episode_index", "dataset_from_index", "dataset_to_index", "data/chunk_index",
    "data/file_index",
)  # fmt: skip
_VIDEO: Final = ("chunk_index", "file_index", "from_timestamp")
_KINDS: Final = {"video": "yarp/image", "image": "yarp/image", "string": "yarp/bottle"}

Values: TypeAlias = Sequence[tuple[str, Any]]  # of a frame, with their ports


class Episode(NamedTuple):
    """The frames from `first` until before `end`; `videos` are files by features, and the moment of
    each, in seconds, in which it begins."""

    number: int
    first: int
    end: int
    task: str
    data: tuple[int, int]
    videos: dict[str, tuple[int, int, float]]


class LeRobotStorage:
    """The data set in the folder `path`. Raises MissingFile; DecodeError if it is none of version
    3, UnknownPlugin without pyarrow."""

    size: int

    def __init__(self, path: str | Path) -> None:
        try:
            import pyarrow.parquet
        except ImportError:
            raise UnknownPlugin(NEEDS) from None
        self._arrow: Any = pyarrow
        self._errors = (
            pyarrow.ArrowException, OSError, ValueError, KeyError, TypeError, AttributeError,
            OverflowError, MemoryError,
        )  # fmt: skip
        self.path = Path(path)
        self.complete = True
        self.damages: list[Damaged] = []
        try:
            with (self.path / INFO).open("rb") as file:
                self._info = parse_info(file.read(RECORDED_TEXT))
            files = [one for one in self.path.rglob("*") if one.is_file()]
            self.size = sum(one.stat().st_size for one in files)
        except OSError as error:
            raise MissingFile(f"{path} cannot be read: {reason(error)}") from error
        except DecodeError as error:
            raise DecodeError(f"{self.path / INFO}: {error}") from error
        self._features = {feature.port: feature for feature in self._info.features}
        self._episodes = [*self._read_episodes()]
        self._starts: dict[tuple[int, int], int] = {}  # the first frame of each file
        for episode in self._episodes:
            self._starts.setdefault(episode.data, episode.first)
        self.facts: dict[str, str] = {
            "yarp_robot_name": self._info.robot,
            "elements_names": json.dumps(
                {one.port: one.names for one in self._info.features if one.kind not in _KINDS}
            ),
        }

    # -- what there is -----------------------------------------------------------------------------

    def _read_episodes(self) -> Iterator[Episode]:
        """Yield the episodes in their order. Raises DecodeError."""
        keys = [one.name for one in self._info.features if one.kind == "video"]
        columns = [*_EPISODE, *(f"videos/{key}/{word}" for key in keys for word in _VIDEO)]
        end = number = 0
        for path in sorted(self.path.glob("meta/episodes/chunk-*/file-*.parquet")):
            for batch in self._batches(path, [*columns, _TASKS], _BATCH):
                if missing := {*columns, _TASKS} - {*batch.schema.names}:
                    raise DecodeError(f"{path} has no {min(missing)}")
                tasks, rest, types = batch.column(_TASKS), batch.select(columns), self._arrow.types
                if not all(types.is_integer(t) or types.is_floating(t) for t in rest.schema.types):
                    raise DecodeError(f"{path}: what counts episodes is no number")
                for at, row in enumerate(rest.to_pylist()):
                    try:
                        found = _episode(row, keys, _first(tasks[at].values))
                    except self._errors as error:
                        raise DecodeError(f"{path}: an episode: {error!r:.200}") from error
                    number += 1
                    if found.first != end or found.end < end or number > LEROBOT_EPISODES:
                        raise DecodeError(
                            f"{path}: episode {found.number} is said to be the frames from "
                            f"{found.first} until {found.end}, after {number - 1} episodes of {end}"
                        )
                    end = found.end
                    yield found
        if not end:
            raise DecodeError(f"{self.path} has no frame in meta/episodes")

    def _time(self, frame: int) -> int:
        return SECOND + round(frame * SECOND / self._info.fps)

    @property
    def begin(self) -> int:
        """Return the time of the first frame, in nanoseconds."""
        return self._time(0)

    @property
    def end(self) -> int:
        """Return the time of the last frame, in nanoseconds."""
        return self._time(max(0, self._episodes[-1].end - 1))

    @property
    def ports(self) -> dict[str, PortFacts]:
        """Return the features as ports, by their names."""
        frames = self._episodes[-1].end
        found = {
            port: PortFacts(port, [_kind(one)], frames) for port, one in self._features.items()
        }
        told = sum(bool(episode.task) for episode in self._episodes)
        if told:
            found.setdefault(TASK, PortFacts(TASK, ["yarp/bottle"], told))
        return found

    def notes(self) -> list[dict[str, Any]]:
        """Return a mark for each episode."""
        return [
            {"what": "mark", "text": f"episode {one.number}", "time_ns": self._time(one.first)}
            for one in self._episodes[:RECORDED_NOTES]
        ]

    def close(self) -> None:
        """Nothing stays open."""

    # -- messages ----------------------------------------------------------------------------------

    def messages(
        self, ports: Container[str] | None = None, begin: int = 0, end: int = FOREVER
    ) -> Iterator[Recorded]:
        """Yield the messages of these ports (None: all) from `begin` until before `end`. Raises
        UnknownPlugin where there are videos and no program ffmpeg."""
        wanted = [one for port, one in self._features.items() if ports is None or port in ports]
        videos = [one for one in wanted if one.kind == "video"]
        listed = [one for one in wanted if one.kind != "video"]
        tasks = TASK not in self._features and (ports is None or TASK in ports)
        rows: Iterator[Values] = iter(())
        file = None
        for episode in self._episodes:
            first, last = (self._frame(moment, episode) for moment in (begin, end))
            if first >= last:
                continue
            if tasks and episode.task and first == episode.first:
                yield self._message(TASK, first, Bottle([episode.task]))
            if listed and file != episode.data:  # a file has the rows of several episodes
                file = episode.data
                rows = self._guarded(self._values(file, listed, first))
            with ExitStack() as stack:
                series = [rows]
                for one in videos:
                    shown = self._guarded(self._pictures(episode, one, first, last))
                    series.append(stack.enter_context(closing(shown)))
                for frame in range(first, last):
                    found = [item for values in series for item in next(values, ())]
                    if not found:  # all that there is, whatever the set says
                        break
                    for port, value in found:
                        yield self._message(port, frame, value)

    def _frame(self, moment: int, episode: Episode) -> int:
        """Return the first frame of an episode that is not before a moment."""
        if moment > self._time(episode.end):
            return episode.end
        frame = max(episode.first, int((moment - SECOND) * self._info.fps / SECOND) - 1)
        while frame < episode.end and self._time(frame) < moment:
            frame += 1
        return min(frame, episode.end)

    def _message(self, port: str, frame: int, value: Any) -> Recorded:
        time = self._time(frame)
        payload = b"".join(map(bytes, codec.encode(value)))
        return Recorded(port, time, time, stamp_text(frame, time), payload)

    def _guarded(self, series: Iterator[Values]) -> Generator[Values]:
        """Yield what a series has until it is damaged, which is told."""
        try:
            yield from series
        except DecodeError as error:
            self.damages.append(Damaged(0, str(error)))

    def _pictures(
        self, episode: Episode, feature: Feature, first: int, last: int
    ) -> Iterator[Values]:
        """Yield the pictures of these frames. Raises DecodeError, UnknownPlugin."""
        chunk, file, start = episode.videos[feature.name]
        path = self.path / "videos" / feature.name / f"{place(chunk, file)}.mp4"
        start += (first - episode.first) / self._info.fps
        for picture in pictures(path, start, last - first, self._info.fps, 1 in feature.shape):
            yield [(feature.port, picture)]

    def _values(
        self, file: tuple[int, int], features: Sequence[Feature], first: int
    ) -> Iterator[Values]:
        """Yield what these features are from a frame on to the end of their file. Raises
        DecodeError."""
        path = self.path / "data" / f"{place(*file)}.parquet"
        rows = max(1, min(_BATCH, limits().elements // max(1, sum(one.size for one in features))))
        columns = [*(one.name for one in features), "index"]
        for batch in self._batches(path, columns, rows, first - self._starts[file]):
            try:
                numbers = batch.column("index").to_numpy()
                if not np.array_equal(numbers, np.arange(first, first + len(numbers))):
                    raise DecodeError("its rows are no frames in their order")
                arrays = [self._column(batch.column(one.name), one) for one in features]
                for row in range(len(numbers)):
                    yield [
                        (one.port, _value(one, array[row]))
                        for one, array in zip(features, arrays, strict=True)
                    ]
            except self._errors as error:
                raise DecodeError(f"{path}, from frame {first} on: {error}") from error
            first += len(numbers)
        raise DecodeError(f"{path} ends before frame {first}")

    def _column(self, column: Any, feature: Feature) -> Any:
        """Return a column, indexed by rows."""
        if column.null_count:
            raise DecodeError(f"{feature.name} is not in every row")
        if feature.kind == "string":
            return column
        if feature.kind == "image":
            return column.field("bytes")
        rows = len(column)
        while self._arrow.types.is_nested(column.type):
            column = column.flatten()
        array = column.to_numpy(zero_copy_only=False)
        if array.dtype.kind not in "biuf":
            raise DecodeError(f"{feature.name} is no numbers")
        return array.reshape(rows, *(feature.shape if len(feature.shape) == 2 else [feature.size]))

    def _batches(self, path: Path, columns: list[str], rows: int, skip: int = 0) -> Iterator[Any]:
        """Yield so many rows of a file at a time, behind those that are skipped. Raises
        DecodeError."""
        try:
            if not path.is_file():  # opening a pipe would wait for whoever writes to it
                raise DecodeError("there is no such file")
            read = self._arrow.parquet.ParquetFile
            with read(path) as file:
                said, texts = file.metadata, _texts(file.schema)
            # Texts stay what they are in the file: a long one may be told of a million rows.
            with read(path, metadata=said, read_dictionary=texts) as file:
                groups: list[int] = []
                for number in range(said.num_row_groups):
                    group = said.row_group(number)
                    if group.total_byte_size > LEROBOT_ROW_GROUP:
                        raise DecodeError(f"{group.total_byte_size} bytes belong together")
                    if groups or skip < group.num_rows:
                        groups.append(number)
                    else:
                        skip -= group.num_rows
                for batch in file.iter_batches(rows, groups, columns) if groups else ():
                    batch.validate(full=True)  # an index of a text leads out of the memory, else
                    left = min(skip, batch.num_rows)
                    skip -= left
                    yield batch.slice(left)
        except self._errors as error:
            raise DecodeError(f"{path} cannot be read: {error}") from error


def _texts(schema: Any) -> list[str]:
    """Return the parts of a table that are texts or bytes. Raises DecodeError."""
    leaves = [schema.column(number) for number in range(len(schema))]
    for leaf in leaves:
        if leaf.length > _LONGEST:
            raise DecodeError(f"{leaf.path[:200]} has values of {leaf.length} bytes")
    return [leaf.path for leaf in leaves if leaf.physical_type == "BYTE_ARRAY"]


def _first(tasks: Any) -> str:
    """Return what was to be done in an episode. Raises DecodeError."""
    text = str(tasks[0].as_py() or "") if tasks else ""
    if len(text) > RECORDED_TEXT:
        raise DecodeError(f"a task of {len(text)} characters")
    return sys.intern(text)  # the same one, of many episodes


def _episode(row: dict[str, Any], keys: Sequence[str], task: str) -> Episode:
    """Return a row of `meta/episodes`. Raises KeyError, TypeError, ValueError."""
    videos = {}
    for key in keys:
        chunk, file, start = (row[f"videos/{key}/{word}"] for word in _VIDEO)
        videos[key] = int(chunk), int(file), float(start)
    number, first, end, chunk, file = (int(row[word]) for word in _EPISODE)
    return Episode(number, first, end, task, (chunk, file), videos)


def _kind(feature: Feature) -> str:
    usual = "yarp/matrix" if len(feature.shape) == 2 else "yarp/vector"
    return _KINDS.get(feature.kind, usual)


def _value(feature: Feature, item: Any) -> Any:
    """Return what a port would have sent. Raises DecodeError."""
    if feature.kind == "string":
        return Bottle([item.as_py()])
    if feature.kind == "image":
        return read_picture(item.as_py(), feature.name, "")
    return Matrix(item) if len(feature.shape) == 2 else Vector(item)
