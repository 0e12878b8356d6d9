"""Two recordings side by side on one time line: a port of the first is shown as /A/head/state:o,
one of the second as /B/head/state:o.

Rules: both begin together, or the second one `offset` seconds later than the first; nothing in the
files changes. A source of another offset looks into the same files, so that each page has its own.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from itertools import zip_longest
from pathlib import Path
from typing import Any, Final, Self

from yarpy.kits.record.mcap.layout import Damaged
from yarpy.kits.record.mcap.storage import FOREVER
from yarpy.kits.record.recorded import PortFacts, Recorded
from yarpy.kits.record.recording import Recording, Storage
from yarpy.kits.record.view.overview import SECOND
from yarpy.kits.record.view.source import SHOWN_NOTES, FileSource

LABELS: Final = ("/A", "/B")
FARTHEST: Final = 1e8  # seconds that one may begin after the other


class MovedStorage:
    """A file or folder whose ports have a label in front of their names, and all of whose times are
    `shift` nanoseconds later."""

    def __init__(self, storage: Storage, label: str, shift: int) -> None:
        self.storage = storage
        self.label = label
        self._shift = shift
        self.path: Path = storage.path

    @property
    def size(self) -> int:
        """Return its size in bytes."""
        return self.storage.size

    @property
    def begin(self) -> int:
        """Return when the first message came; 0 if there is none."""
        return self.storage.begin + self._shift if self.storage.end else 0

    @property
    def end(self) -> int:
        """Return when the last message came; 0 if there is none."""
        return self.storage.end + self._shift if self.storage.end else 0

    @property
    def complete(self) -> bool:
        """Return whether it was finished."""
        return self.storage.complete

    @property
    def damages(self) -> list[Damaged]:
        """Return what is wrong with it, as far as it was read."""
        return self.storage.damages

    @property
    def facts(self) -> dict[str, str]:
        """Return what was known when it was begun."""
        return self.storage.facts

    @property
    def ports(self) -> dict[str, PortFacts]:
        """Return its ports by their names here."""
        return {
            self.label + name: PortFacts(
                self.label + name, facts.kinds, facts.messages, facts.playable
            )
            for name, facts in self.storage.ports.items()
        }

    def messages(
        self, ports: Collection[str] | None = None, begin: int = 0, end: int = FOREVER
    ) -> Iterator[Recorded]:
        """Yield the messages of these ports (None: all) from `begin` until before `end`."""
        if ports is not None:
            ports = own_names(ports, self.label)
            if not ports:
                return
        first = max(0, begin - self._shift)
        last = end if end >= FOREVER else max(0, end - self._shift)
        for recorded in self.storage.messages(ports, first, last):
            yield moved(recorded, self.label, self._shift)

    def notes(self) -> list[dict[str, Any]]:
        """Return what was noted."""
        return [
            {
                **note,
                **({"port": self.label + str(note["port"])} if "port" in note else {}),
                "time_ns": int(note["time_ns"]) + self._shift,
            }
            for note in self.storage.notes()
        ]

    def close(self) -> None:
        """Close it."""
        self.storage.close()


def own_names(ports: Collection[str], label: str) -> list[str]:
    """Return the names that ports of that label have in their recording."""
    return [name[len(label) :] for name in ports if name.startswith(f"{label}/")]


def moved(recorded: Recorded, label: str, shift: int) -> Recorded:
    """Return a message, which nobody else has, with another name and other times."""
    recorded.port = label + recorded.port
    recorded.received_ns += shift
    recorded.sent_ns += shift
    return recorded


class BesideSource:
    """Two sources of files as one. offset: seconds from the beginning of the first recording to
    that of the second. It closes both. Raises ValueError for an offset beyond FARTHEST."""

    live = False

    def __init__(self, first: FileSource, second: FileSource, offset: float = 0.0) -> None:
        if not abs(offset) <= FARTHEST:
            raise ValueError(f"an offset of {offset} s: it is {FARTHEST:.0f} s at most")
        self._sources = (first, second)
        self.offset = offset
        begin = first.begin + round(offset * SECOND)
        lift = max(0, -begin)  # no time is before 1970
        self._shifts = (lift, begin - second.begin + lift)

    def at(self, offset: float) -> Self:
        """Return the same with another offset. Raises ValueError."""
        return type(self)(*self._sources, offset)

    @property
    def title(self) -> str:
        """Return the names of both."""
        return " beside ".join(source.title for source in self._sources)

    @property
    def begin(self) -> int:
        """Return when the first message of either came."""
        return min(source.begin + shift for source, shift in self._both())

    @property
    def end(self) -> int:
        """Return when the last message of either came."""
        return max(source.end + shift for source, shift in self._both())

    def _both(self) -> Iterator[tuple[FileSource, int]]:
        return zip(self._sources, self._shifts, strict=True)

    @property
    def kinds(self) -> dict[str, str]:
        """Return the ports of both, those of one name one after the other."""
        kinds = [source.kinds for source in self._sources]
        names = [name for pair in zip_longest(*kinds) for name in pair if name is not None]
        return {
            label + name: known[name]
            for name in dict.fromkeys(names)
            for label, known in zip(LABELS, kinds, strict=True)
            if name in known
        }

    def open(self) -> Recording:
        """Return the messages of both, to be read by one thread."""
        opened: list[Storage] = []
        for (source, shift), label in zip(self._both(), LABELS, strict=True):
            opened += [MovedStorage(one, label, shift) for one in source.open().storages]
        return Recording(opened)

    def before(self, recording: Recording, ports: Collection[str], time: int) -> list[Recorded]:
        """Return the last message of each port that is not after that time."""
        found = []
        for (source, shift), label in zip(self._both(), LABELS, strict=True):
            own = Recording(
                [
                    one.storage
                    for one in recording.storages
                    if isinstance(one, MovedStorage) and one.label == label
                ]
            )
            last = source.before(own, own_names(ports, label), time - shift)
            found += [moved(recorded, label, shift) for recorded in last]
        return found

    def told(self) -> dict[str, Any]:
        """Return what the time line of a page shows."""
        begin, told = self.begin, [source.told() for source in self._sources]
        rows: dict[str, dict[str, Any]] = {}
        notes = []
        for one, (source, shift), label in zip(told, self._both(), LABELS, strict=True):
            later = (source.begin + shift - begin) / SECOND
            for port in one["ports"]:
                name = label + port["name"]
                gaps = [[time + later for time in gap] for gap in port["gaps"]]
                rows[name] = {**port, "name": name, "gaps": gaps}
                rows[name] |= {"from": later, "length": one["length"]}
            for note in one["notes"]:
                text = str(note["text"])
                text = label + text if text.startswith("/") else text
                notes.append({**note, "t": note["t"] + later, "text": text})
        return {
            "title": self.title,
            "live": False,
            "begin": str(begin),
            "length": (self.end - begin) / SECOND,
            "ports": [rows[name] for name in self.kinds],
            "notes": sorted(notes, key=lambda note: float(note["t"]))[:SHOWN_NOTES],
            "seen": min(one["seen"] for one in told),
            "problem": "; ".join(one["problem"] for one in told if one["problem"]),
            "attached": [
                {**file, "name": f"{label}/{file['name']}"}
                for one, label in zip(told, LABELS, strict=True)
                for file in one["attached"]
            ],
            "beside": {
                "offset": self.offset,
                "recorded": (self._sources[1].begin - self._sources[0].begin) / SECOND,
            },
        }

    def attachment(self, name: str) -> bytes:
        """Return a file that was given to one of them. Raises KeyError, DecodeError."""
        for source, label in zip(self._sources, LABELS, strict=True):
            if name.startswith(f"{label}/"):
                return source.attachment(name[len(label) + 1 :])
        raise KeyError(name)

    def close(self) -> None:
        """Stop making the time lines."""
        for source in self._sources:
            source.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()
