"""Recordings written anew: as an MCAP file or as the folders of C++, all of them or a part.

Rules: messages keep their bytes, envelopes and times, as far as the new form has them; notes, and
what is not of YARP, are kept in MCAP files. An unfinished or damaged recording becomes a whole one
with what could be read.
"""

from __future__ import annotations

import fnmatch
import heapq
import itertools
import json
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from yarpy.errors import LocalProtocolError, UnknownName
from yarpy.kits.record.bag.reader import BagStorage
from yarpy.kits.record.bag.writer import BagWriter
from yarpy.kits.record.dumper.part import Times
from yarpy.kits.record.dumper.writer import DumperWriter
from yarpy.kits.record.envelope import SECOND
from yarpy.kits.record.mcap.layout import Damaged, Other
from yarpy.kits.record.mcap.storage import FOREVER, McapStorage
from yarpy.kits.record.mcap.writer import McapWriter
from yarpy.kits.record.recording import Recording
from yarpy.kits.record.sink import ENDING, named

if TYPE_CHECKING:
    from yarpy.kits.record.matlab.writer import MatWriter


@dataclass
class Converted:
    """The outcome: `path`, how many `messages`, and those that the new form does not take."""

    path: Path
    messages: int = 0
    left_out: int = 0


def convert(
    recording: Recording,
    path: str | Path,
    *,
    form: Literal["mcap", "dumper", "bag1", "bag2", "robometry"] = "mcap",
    compression: str = "none",
    times: Times = "",
    ports: Collection[str] | None = None,
    start: float = 0.0,
    duration: float | None = None,
    rates: Mapping[str, float] | None = None,
) -> Converted:
    """Write a recording into the new file or folder `path`.

    form: dumper writes the folders of C++ yarpdatadumper, with these `times` (see `DumperWriter`);
    bag1 a bag of ROS 1, bag2 one of ROS 2: what came from ROS as it was; robometry a `.mat` and its
    `.json`, with what is numbers.
    start, duration: the seconds that are left out at the beginning, and those that are written.
    rates: the largest number of messages a second, by patterns of names: `{"/cam/*": 10}`.
    Raises FileExistsError, OSError; UnknownName for a port that is not in it, UnknownPlugin,
    LocalProtocolError for a path without a name.
    """
    where, known = named(path), recording.ports
    for name in ports or ():
        if name not in known:
            raise UnknownName(f'"{name}" was not recorded: there are {" ".join(known)}')
    begin = min((storage.begin for storage in recording.storages if storage.end), default=0)
    begin += round(start * SECOND)
    end = FOREVER if duration is None else begin + round(duration * SECOND)
    sink: DumperWriter | McapWriter | BagWriter | MatWriter
    if form == "dumper":
        sink = DumperWriter(where, times)
    elif form == "robometry":
        from yarpy.kits.record.matlab.writer import MatWriter

        sink = MatWriter(where, _facts(recording))
    elif form != "mcap":
        sink = BagWriter(where, 1 if form == "bag1" else 2)
    else:
        where = where if where.suffix == ENDING else where.with_name(f"{where.name}{ENDING}")
        where.parent.mkdir(parents=True, exist_ok=True)
        sink = McapWriter(where, compression, _facts(recording))
    found = Converted(sink.path)
    try:
        if isinstance(sink, McapWriter):
            _attach(recording, sink)
        notes = _noted(recording, ports, begin if start else 0, end)
        sent = _sent(recording, ports, begin, end)
        # C++ has the comings and goings of a port in a file of their own, by another clock perhaps.
        others = _others(recording, ports, begin, end)
        series = (
            itertools.chain(notes, sent, others)
            if form == "dumper"
            else heapq.merge(notes, sent, others)
        )
        thin = RateLimit(rates or {})
        for _, _, item in series:
            if isinstance(item, _Note):
                sink.note({key: item[key] for key in item if key != "time_ns"}, item["time_ns"])
                continue
            port = item.channel.topic if isinstance(item, Other) else item.port
            if thin.leaves_out(port, item.received_ns):
                continue
            try:
                if isinstance(item, Other):
                    if not isinstance(sink, McapWriter | BagWriter):
                        found.left_out += 1
                        continue
                    sink.add_other(item)
                    found.messages += 1
                    continue
                sink.add(item.port, item.envelope, item.received_ns, item.payload)
                found.messages += 1
            except LocalProtocolError:
                found.left_out += 1
    finally:
        sink.close()
    return found


def _attach(recording: Recording, sink: McapWriter) -> None:
    """Keep the files that were given to the recording, each once; what has changed is damage."""
    known: set[tuple[str, bytes]] = set()
    for storage in recording.storages:
        if not isinstance(storage, McapStorage):
            continue
        for found in storage.attachments:
            try:
                content = storage.attached(found)
            except Damaged as damage:
                storage.damages.append(damage)
                continue
            if (found.name, content) not in known:
                known.add((found.name, content))
                sink.attach(found.name, content, found.kind)


class RateLimit:
    """Leaves out what comes more often than wanted, by the times of receipt."""

    def __init__(self, rates: Mapping[str, float]) -> None:
        self._rates = dict(rates)
        self._periods: dict[str, int] = {}
        self._next: dict[str, int] = {}

    def leaves_out(self, port: str, received: int) -> bool:
        """Return whether a message is one too many."""
        if not self._rates:
            return False
        period = self._periods.get(port)
        if period is None:
            found = [rate for name, rate in self._rates.items() if fnmatch.fnmatchcase(port, name)]
            period = self._periods[port] = round(SECOND / min(found)) if found else 0
        due = self._next.get(port, 0)
        if not period or received >= due:
            late = received - due
            self._next[port] = (received if late > period else due) + period
            return False
        return True


def _facts(recording: Recording) -> dict[str, str]:
    """Return what is known of all files: the losses of several are added."""
    found: dict[str, str] = {}
    for storage in recording.storages:
        for key, value in storage.facts.items():
            found[key] = _added(found[key], value) if key in found else value
    return found


def _added(one: str, other: str) -> str:
    """Return the sums of two objects of JSON with numbers; `other` if they are something else."""
    try:
        sums, more = json.loads(one), json.loads(other)
        for port, count in more.items():
            sums[port] = sums.get(port, 0) + int(count)
        return json.dumps(sums)
    except (ValueError, TypeError, AttributeError, RecursionError):
        return other


def _noted(
    recording: Recording, ports: Collection[str] | None, begin: int, end: int
) -> Iterator[tuple[int, int, Any]]:
    for note in recording.notes():
        wanted = ports is None or note.get("port", "") in ("", *ports)
        if wanted and begin <= note["time_ns"] < end:
            yield note["time_ns"], 0, _Note(note)


def _sent(
    recording: Recording, ports: Collection[str] | None, begin: int, end: int
) -> Iterator[tuple[int, int, Any]]:
    for number, recorded in enumerate(recording.between(ports, begin, end), start=1):
        yield recorded.received_ns, number, recorded


def _others(
    recording: Recording, ports: Collection[str] | None, begin: int, end: int
) -> Iterator[tuple[int, int, Any]]:
    series = [
        storage.others(ports, begin, end)
        for storage in recording.storages
        if isinstance(storage, McapStorage | BagStorage)
    ]
    one_after_the_other = heapq.merge(*series, key=lambda other: other.received_ns)
    for number, other in enumerate(one_after_the_other, start=1):
        yield other.received_ns, -number, other


class _Note(dict[str, Any]):
    """A note; two of the same moment are in no order."""

    def __lt__(self, other: object) -> bool:
        return False
