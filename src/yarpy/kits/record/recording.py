"""Recordings that are read: files and folders as one series of messages.

    with record.open("walk.mcap") as recording:
        for recorded in recording:
            print(recorded.port, recorded.received, recorded.value)

Rules: a recording may consist of several files, which are read side by side on one time axis. What
can be read of a damaged or unfinished one is read; `damages` says what cannot.
"""

from __future__ import annotations

import heapq
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, Self

from yarpy.errors import DecodeError, MissingFile, UnknownName
from yarpy.kits.record.bag.reader import BagStorage, is_bag
from yarpy.kits.record.dumper.reader import DumperStorage
from yarpy.kits.record.envelope import SECOND
from yarpy.kits.record.lerobot.layout import is_dataset
from yarpy.kits.record.matlab.layout import CONFIGURATION, ENDING
from yarpy.kits.record.mcap.layout import Damaged
from yarpy.kits.record.mcap.storage import FOREVER, McapStorage
from yarpy.kits.record.recorded import PortFacts, Recorded

if TYPE_CHECKING:
    from numpy import float64
    from numpy.typing import NDArray


class Storage(Protocol):
    """A file or folder of a recording."""

    path: Path

    @property
    def size(self) -> int: ...
    @property
    def begin(self) -> int: ...
    @property
    def end(self) -> int: ...
    @property
    def complete(self) -> bool: ...
    @property
    def damages(self) -> list[Damaged]: ...
    @property
    def facts(self) -> dict[str, str]: ...
    @property
    def ports(self) -> dict[str, PortFacts]: ...
    def messages(
        self, ports: Collection[str] | None = None, begin: int = 0, end: int = FOREVER
    ) -> Iterator[Recorded]: ...
    def notes(self) -> list[dict[str, Any]]: ...
    def close(self) -> None: ...


class Recording:
    """One or more files or folders, read together. Times are in seconds since 1970."""

    def __init__(self, storages: Sequence[Storage]) -> None:
        self.storages = list(storages)

    def __repr__(self) -> str:
        files = " ".join(str(storage.path) for storage in self.storages)
        return f"<Recording {files}: {self.end - self.begin:.3f} s, {len(self.ports)} ports>"

    @property
    def ports(self) -> dict[str, PortFacts]:
        """Return the ports by their names: their types, and how many messages there are."""
        found: dict[str, PortFacts] = {}
        for storage in self.storages:
            for name, facts in storage.ports.items():
                known = found.setdefault(name, PortFacts(name))
                known.messages += facts.messages
                known.kinds += [kind for kind in facts.kinds if kind not in known.kinds]
                known.playable = known.playable and facts.playable
        return found

    @property
    def begin(self) -> float:
        """Return when the first message was received; 0 if there is none."""
        return min((storage.begin for storage in self.storages if storage.end), default=0) / SECOND

    @property
    def end(self) -> float:
        """Return when the last message was received; 0 if there is none."""
        return max((storage.end for storage in self.storages), default=0) / SECOND

    @property
    def complete(self) -> bool:
        """Return whether all of it was finished."""
        return all(storage.complete for storage in self.storages)

    @property
    def damages(self) -> list[str]:
        """Return what is wrong with it, as far as it was read: file, byte, and what is there."""
        return [
            f"{storage.path}: {damage}" for storage in self.storages for damage in storage.damages
        ]

    def messages(
        self,
        ports: Collection[str] | None = None,
        begin: float | None = None,
        end: float | None = None,
    ) -> Iterator[Recorded]:
        """Yield messages in the order in which they were received: those of `ports` (None: all)
        from `begin` until before `end`. Raises UnknownName for a port that is not in it."""
        if ports is not None:
            known = self.ports
            for name in ports:
                if name not in known:
                    raise UnknownName(f'"{name}" was not recorded: there are {" ".join(known)}')
        return self.between(
            ports,
            0 if begin is None else max(0, round(begin * SECOND)),
            FOREVER if end is None else max(0, round(end * SECOND)),
        )

    def between(
        self, ports: Collection[str] | None = None, begin: int = 0, end: int = FOREVER
    ) -> Iterator[Recorded]:
        """Yield messages as `messages` does, with times in nanoseconds."""
        if len(self.storages) == 1:
            return self.storages[0].messages(ports, begin, end)
        series = [storage.messages(ports, begin, end) for storage in self.storages]
        return heapq.merge(*series, key=lambda recorded: recorded.received_ns)

    def __iter__(self) -> Iterator[Recorded]:
        return self.between()

    def numbers(self, port: str) -> tuple[NDArray[float64], NDArray[float64]]:
        """Return what a port sent as numbers: the times of sending, of shape (n,), and the values,
        of shape (n, width). Raises UnknownName; DecodeError if its messages are no lists of
        numbers, all of one length."""
        import numpy as np

        times: list[float] = []
        rows: list[NDArray[float64]] = []
        for recorded in self.messages([port]):
            row = np.asarray(recorded.as_(np.ndarray), "f8").ravel()
            if rows and len(row) != len(rows[0]):
                raise DecodeError(
                    f'a message of "{port}" has {len(row)} numbers, the first has {len(rows[0])}'
                )
            times.append(recorded.sent_ns / SECOND)
            rows.append(row)
        width = len(rows[0]) if rows else 0
        return np.array(times, "f8"), np.array(rows, "f8").reshape(len(rows), width)

    def notes(self) -> list[dict[str, Any]]:
        """Return what the recorder noted: what came and went, was lost, was marked."""
        found = [note for storage in self.storages for note in storage.notes()]
        return sorted(found, key=lambda note: int(note["time_ns"]))

    def attachments(self) -> dict[str, bytes]:
        """Return the files that were given to it (`attach`), by their names. Raises DecodeError for
        one that has changed."""
        return {
            found.name: storage.attached(found)
            for storage in self.storages
            if isinstance(storage, McapStorage)
            for found in storage.attachments
        }

    def attached_sizes(self) -> dict[str, int]:
        """Return how many bytes these files have, by their names."""
        return {
            found.name: found.size
            for storage in self.storages
            if isinstance(storage, McapStorage)
            for found in storage.attachments
        }

    def attachment(self, name: str) -> bytes:
        """Return one of these files. Raises KeyError if there is none of that name, DecodeError if
        it has changed."""
        for storage in reversed(self.storages):
            if isinstance(storage, McapStorage):
                for found in storage.attachments:
                    if found.name == name:
                        return storage.attached(found)
        raise KeyError(name)

    def mark(self, text: str) -> float:
        """Return when a moment was marked with that text, in seconds from the beginning. Raises
        UnknownName."""
        marks = [note for note in self.notes() if note.get("what") == "mark"]
        for note in marks:
            if note.get("text") == text:
                return int(note["time_ns"]) / SECOND - self.begin
        known = ", ".join(f'"{note.get("text", "")}"' for note in marks[:20])
        raise UnknownName(f'nothing is marked "{text}": {known or "there is no mark at all"}')

    def close(self) -> None:
        """Close all files."""
        for storage in self.storages:
            storage.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()


def open_recording(*paths: str | Path) -> Recording:
    """Open files and folders as one recording, finished or not: MCAP files, folders of these,
    folders that C++ yarpdatadumper has written, bags of ROS (whose messages are not YARP's), files
    of robometry (`.mat`, or the `.json` that wrote some), data sets of LeRobot (3.0).

    Raises MissingFile; DecodeError for what is no recording, UnknownPlugin without a library.
    """
    storages: list[Storage] = []
    try:
        for path in paths:
            if path == "":
                raise MissingFile("a file without a name (an unset variable?): . is this folder")
            storages.extend(_storages(Path(path)))
    except BaseException:
        for storage in storages:
            storage.close()
        raise
    return Recording(storages)


def _storages(path: Path) -> Iterator[Storage]:
    if is_bag(path):
        yield BagStorage(path)
    elif is_dataset(path):
        from yarpy.kits.record.lerobot.reader import LeRobotStorage  # numpy

        yield LeRobotStorage(path)
    elif path.is_dir():
        files = sorted(one for one in path.glob("*.mcap") if one.is_file())
        yield from map(McapStorage, files)
        if not files:
            yield DumperStorage(path)
    elif path.suffix in (ENDING, CONFIGURATION):
        from yarpy.kits.record.matlab.reader import MatStorage, files_of  # numpy

        yield from map(MatStorage, files_of(path))
    else:
        yield McapStorage(path)
