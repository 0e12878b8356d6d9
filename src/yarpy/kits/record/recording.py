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

from yarpy.errors import DecodeError, UnknownName
from yarpy.kits.record.bag.reader import BagTape, is_bag
from yarpy.kits.record.dumper.reader import DumperTape
from yarpy.kits.record.envelope import SECOND
from yarpy.kits.record.mcap.layout import Damaged
from yarpy.kits.record.mcap.tape import FOREVER, McapTape
from yarpy.kits.record.recorded import PortFacts, Recorded

if TYPE_CHECKING:
    from numpy import float64
    from numpy.typing import NDArray


class Tape(Protocol):
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

    def __init__(self, tapes: Sequence[Tape]) -> None:
        self.tapes = list(tapes)

    def __repr__(self) -> str:
        files = " ".join(str(tape.path) for tape in self.tapes)
        return f"<Recording {files}: {self.end - self.begin:.3f} s, {len(self.ports)} ports>"

    @property
    def ports(self) -> dict[str, PortFacts]:
        """Return the ports by their names: their types, and how many messages there are."""
        found: dict[str, PortFacts] = {}
        for tape in self.tapes:
            for name, facts in tape.ports.items():
                known = found.setdefault(name, PortFacts(name))
                known.messages += facts.messages
                known.kinds += [kind for kind in facts.kinds if kind not in known.kinds]
                known.playable = known.playable and facts.playable
        return found

    @property
    def begin(self) -> float:
        """Return when the first message was received; 0 if there is none."""
        return min((tape.begin for tape in self.tapes if tape.end), default=0) / SECOND

    @property
    def end(self) -> float:
        """Return when the last message was received; 0 if there is none."""
        return max((tape.end for tape in self.tapes), default=0) / SECOND

    @property
    def complete(self) -> bool:
        """Return whether all of it was finished."""
        return all(tape.complete for tape in self.tapes)

    @property
    def damages(self) -> list[str]:
        """Return what is wrong with it, as far as it was read: file, byte, and what is there."""
        return [f"{tape.path}: {damage}" for tape in self.tapes for damage in tape.damages]

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
        if len(self.tapes) == 1:
            return self.tapes[0].messages(ports, begin, end)
        series = [tape.messages(ports, begin, end) for tape in self.tapes]
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
        found = [note for tape in self.tapes for note in tape.notes()]
        return sorted(found, key=lambda note: int(note["time_ns"]))

    def attachments(self) -> dict[str, bytes]:
        """Return the files that were given to it (`attach`), by their names. Raises DecodeError for
        one that has changed."""
        return {
            found.name: tape.attached(found)
            for tape in self.tapes
            if isinstance(tape, McapTape)
            for found in tape.attachments
        }

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
        for tape in self.tapes:
            tape.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()


def open_recording(*paths: str | Path) -> Recording:
    """Open files and folders as one recording, finished or not: MCAP files, folders of these,
    folders that C++ yarpdatadumper has written, bags of ROS (whose messages are not YARP's).

    Raises MissingFile; DecodeError for what is no recording, UnknownPlugin without a library.
    """
    tapes: list[Tape] = []
    try:
        for path in paths:
            tapes.extend(_tapes(Path(path)))
    except BaseException:
        for tape in tapes:
            tape.close()
        raise
    return Recording(tapes)


def _tapes(path: Path) -> Iterator[Tape]:
    if is_bag(path):
        yield BagTape(path)
    elif path.is_dir():
        files = sorted(path.glob("*.mcap"))
        yield from map(McapTape, files)
        if not files:
            yield DumperTape(path)
    else:
        yield McapTape(path)
