"""The data that a page shows: files, or the last minutes of ports.

Rules: many threads ask a source at once, so each opens what it reads for itself. Of files the time
line is made in the background, while the page is there already; `seen` tells how far it is.
"""

from __future__ import annotations

import threading
from collections.abc import Collection, Iterator, Sequence
from contextlib import AbstractContextManager, suppress
from pathlib import Path
from typing import Any, Final, Protocol, Self

from yarpy.errors import YarpError
from yarpy.kits.record.bag.foreign import with_foreign
from yarpy.kits.record.kind import BOTTLE
from yarpy.kits.record.mcap.storage import FOREVER
from yarpy.kits.record.recorded import Recorded
from yarpy.kits.record.recording import Recording, open_recording
from yarpy.kits.record.view.overview import SECOND, Overview

SHOWN_NOTES: Final = 1000
_NEARLY: Final = 0.999  # of the time line, as it is told: who is told 1 asks no more


class Source(Protocol):
    """A stretch of time with the messages of ports; times are nanoseconds since 1970."""

    live: bool

    def at(self, offset: float) -> Source:
        """Return it with what stands beside it beginning so many seconds later. Raises
        ValueError."""

    @property
    def title(self) -> str:
        """Return what people call it."""

    @property
    def begin(self) -> int:
        """Return when it begins."""

    @property
    def end(self) -> int:
        """Return when it ends, so far."""

    @property
    def kinds(self) -> dict[str, str]:
        """Return its ports, and of which kind the messages of each are."""

    def open(self) -> AbstractContextManager[Recording]:
        """Return the messages, to be read by one thread."""

    def before(self, recording: Recording, ports: Collection[str], time: int) -> list[Recorded]:
        """Return the last message of each port that is not after that time."""

    def told(self) -> dict[str, Any]:
        """Return what the time line of a page shows."""

    def attachment(self, name: str) -> bytes:
        """Return a file that was given to the recording. Raises KeyError, DecodeError."""

    def close(self) -> None:
        """Stop what is done in the background."""


def timeline(
    source: Source, overview: Overview, counts: dict[str, int], notes: Sequence[dict[str, Any]]
) -> dict[str, Any]:
    """Return what the time line of a page shows; times in seconds from the beginning."""
    begin = overview.begin
    ports = [
        {"name": name, "kind": kind, "messages": counts.get(name, 0), **overview.told(name)}
        for name, kind in source.kinds.items()
    ]
    said = [
        {
            "t": (int(note["time_ns"]) - begin) / SECOND,
            "what": str(note.get("what", ""))[:100],
            "text": str(note.get("text") or note.get("port") or "")[:500],
        }
        for note in notes[:SHOWN_NOTES]
    ]
    return {
        "title": source.title,
        "live": source.live,
        "begin": str(begin),  # more digits than numbers of JavaScript have
        "length": (overview.end - begin) / SECOND,
        "ports": ports,
        "notes": said,
    }


class FileSource:
    """Files and folders, as `record.open` takes them. Raises as that does."""

    live = False

    def __init__(self, paths: Sequence[str | Path]) -> None:
        self._paths = [*paths]
        with self.open() as recording:
            storages = [storage for storage in recording.storages if storage.end]
            begin = min((storage.begin for storage in storages), default=0)
            self._overview = Overview(begin, max((storage.end for storage in storages), default=0))
            known = {name: facts for name, facts in recording.ports.items() if facts.playable}
            self.kinds = {
                name: facts.kinds[0] if facts.kinds else BOTTLE for name, facts in known.items()
            }
            self._counts = {name: facts.messages for name, facts in known.items()}
            self._notes = recording.notes()
        with open_recording(*self._paths) as recording:
            self._attached = recording.attached_sizes()
        self.seen = 0.0  # how much of the time line is there, 1 for all
        self.problem = ""
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._look, name="yarpy view", daemon=True)
        self._thread.start()

    def at(self, offset: float) -> Self:
        """Return it: nothing stands beside it."""
        return self

    @property
    def title(self) -> str:
        """Return the names of the files."""
        return " ".join(Path(path).name for path in self._paths)

    @property
    def begin(self) -> int:
        """Return when the first message came."""
        return self._overview.begin

    @property
    def end(self) -> int:
        """Return when the last message came."""
        return self._overview.end

    def open(self) -> Recording:
        """Return the messages, to be read by one thread."""
        return with_foreign(open_recording(*self._paths))

    def _look(self) -> None:
        """Count the messages of all ports."""
        overview = self._overview
        try:
            with self.open() as recording:
                for recorded in recording.between([*self.kinds]):
                    overview.add(recorded.port, recorded.received_ns)
                    share = (recorded.received_ns - self.begin) / (self.end - self.begin)
                    self.seen = min(share, _NEARLY)
                    if self._closing.is_set():
                        return
                self.problem = "; ".join(recording.damages[:10])
        except (YarpError, OSError) as error:
            self.problem = str(error)
        self.seen = 1.0

    def before(self, recording: Recording, ports: Collection[str], time: int) -> list[Recorded]:
        """Return the last message of each port that is not after that time."""
        found = []
        for port in ports:
            last: Recorded | None = None
            for place in self._overview.filled(port, time):
                begin = max(0, self._overview.start(place))
                for recorded in recording.between([port], begin, time + 1):
                    last = recorded
                if last is not None:
                    found.append(last)
                    break
        return found

    def told(self) -> dict[str, Any]:
        """Return what the time line of a page shows."""
        seen = self.seen  # before the rest, which is all there if it is 1
        found = timeline(self, self._overview, self._counts, self._notes)
        attached = [{"name": name, "size": size} for name, size in self._attached.items()]
        return {
            **found,
            "seen": round(seen, 3),
            "problem": self.problem,
            "attached": attached[:SHOWN_NOTES],
        }

    def attachment(self, name: str) -> bytes:
        """Return a file that was given to the recording. Raises KeyError, DecodeError."""
        with open_recording(*self._paths) as recording:
            return recording.attachment(name)

    def close(self) -> None:
        """Stop making the time line."""
        self._closing.set()
        self._thread.join()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()


def rows_of(
    recording: Recording, port: str, begin: int = 0, end: int = FOREVER
) -> Iterator[Recorded]:
    """Yield the messages of a port; what cannot be read any further ends them."""
    with suppress(YarpError, OSError):
        yield from recording.between([port], begin, end)
