"""A data set of C++ yarpdataplayer: the folders below a folder, by the names of these folders.

Rules: each folder is a part of its own, also where several have the same port. The name of a part
is that of its folder; a folder in a folder has the name of that in front (`head_left`). Envelopes
are what C++ sends: the number of the message in its part, from 0, and its time.
"""

from __future__ import annotations

import heapq
from array import array
from bisect import bisect_left
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any, Literal

from yarpy.errors import MissingFile
from yarpy.kits.record.dumper.part import DATA, INFO
from yarpy.kits.record.dumper.reader import Part
from yarpy.kits.record.envelope import stamp_text
from yarpy.kits.record.mcap.layout import Damaged
from yarpy.kits.record.mcap.storage import FOREVER
from yarpy.kits.record.recorded import PortFacts, Recorded


class Dataset:
    """The parts below `path`: a Storage whose ports are parts.

    column: which column of times they are played by, if each line has two; 0: there are as many as
    info.log says, and the first one counts. Raises MissingFile if there is no part.
    """

    def __init__(self, path: str | Path, column: Literal[0, 1, 2] = 0) -> None:
        self.path = Path(path)
        self.damages: list[Damaged] = []
        self._late = column == 2  # by the times of receipt
        found = [info.parent for info in sorted(self.path.rglob(INFO))]
        self.parts: dict[str, Part] = {}
        self._times: dict[str, array[int]] = {}
        for folder in found:
            if (folder / DATA).is_file():
                part = Part(folder, self.damages.append, 2 if column else 0)
                self.parts[self._name(folder)] = part
        if not self.parts:
            raise MissingFile(f"{path} has no recording: no folder with {INFO} and {DATA}")
        self.parts = dict(sorted(self.parts.items()))
        for name, part in self.parts.items():
            self._times[name] = array("q", (times[self._late] for times in part.times()))

    def _name(self, folder: Path) -> str:
        """Return a name that no other part has."""
        words = folder.relative_to(self.path).parts
        name = "_".join(words[-2:]) or folder.name
        return "_".join(words) if name in self.parts else name

    @property
    def size(self) -> int:
        """Return the size of all lines in bytes."""
        return sum(part.size for part in self.parts.values())

    @property
    def begin(self) -> int:
        """Return the earliest time of a first message, in nanoseconds; 0 if there is none."""
        return min((times[0] for times in self._times.values() if times), default=0)

    @property
    def end(self) -> int:
        """Return the latest time of a message, in nanoseconds; 0 if there is none."""
        return max((max(times) for times in self._times.values() if times), default=0)

    @property
    def complete(self) -> bool:
        """Return whether nothing was cut off."""
        return all(part.complete for part in self.parts.values())

    @property
    def facts(self) -> dict[str, str]:
        """Return what is known of the recorder, which is nothing."""
        return {}

    @property
    def ports(self) -> dict[str, PortFacts]:
        """Return the parts by their names."""
        return {
            name: PortFacts(name, [part.kind], part.messages) for name, part in self.parts.items()
        }

    def frame(self, part: str, moment: int) -> int:
        """Return the number of the first message that is not before that time, in nanoseconds."""
        return bisect_left(self._times[part], moment)

    def moment(self, part: str, frame: int) -> int:
        """Return the time of a message, in nanoseconds. Raises IndexError."""
        if frame < 0:
            raise IndexError(frame)
        return self._times[part][frame]

    def messages(
        self, ports: Collection[str] | None = None, begin: int = 0, end: int = FOREVER
    ) -> Iterator[Recorded]:
        """Yield the messages of these parts (None: all) from `begin` until before `end`, in the
        order of their times. Raises UnknownPlugin where a library for pictures is missing."""
        series = [
            self._read(name, begin, end) for name in self.parts if ports is None or name in ports
        ]
        return heapq.merge(*series, key=lambda recorded: recorded.received_ns)

    def _read(self, name: str, begin: int, end: int) -> Iterator[Recorded]:
        late = self._late

        def wanted(sent: int, received: int) -> bool:
            return begin <= (received if late else sent) < end

        for number, one in self.parts[name].numbered(wanted):
            time = one.received_ns if late else one.sent_ns
            yield Recorded(name, time, time, stamp_text(number, max(0, time)), one.payload)

    def notes(self) -> list[dict[str, Any]]:
        """Return who came and went."""
        return [note for part in self.parts.values() for note in part.notes]

    def close(self) -> None:
        """Nothing stays open."""
