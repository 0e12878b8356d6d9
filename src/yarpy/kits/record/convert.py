"""Recordings written anew: as an MCAP file or as the folders of C++, all of them or a part.

Rules: messages keep their bytes, envelopes and times, as far as the new form has them; notes are
kept in MCAP files. An unfinished or damaged recording becomes a whole one with what could be read.
"""

from __future__ import annotations

import heapq
import itertools
import json
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from yarpy.errors import LocalProtocolError, UnknownName
from yarpy.kits.record.dumper.part import Times
from yarpy.kits.record.dumper.writer import DumperWriter
from yarpy.kits.record.envelope import SECOND
from yarpy.kits.record.mcap.tape import FOREVER
from yarpy.kits.record.mcap.writer import McapWriter
from yarpy.kits.record.output import ENDING, Sink
from yarpy.kits.record.recorded import Recorded
from yarpy.kits.record.recording import Recording


@dataclass
class Converted:
    """What was written: `path`, how many `messages`, and those that the new form does not take."""

    path: Path
    messages: int = 0
    left_out: int = 0


def convert(
    recording: Recording,
    path: str | Path,
    *,
    dumper: bool = False,
    compression: str = "none",
    times: Times = "",
    ports: Collection[str] | None = None,
    start: float = 0.0,
    duration: float | None = None,
) -> Converted:
    """Write a recording into the new file or folder `path`.

    dumper: write the folders of C++ yarpdatadumper, with these `times` (see `DumperWriter`).
    start, duration: the seconds that are left out at the beginning, and those that are written.
    Raises FileExistsError, OSError; UnknownName for a port that is not in it, UnknownPlugin.
    """
    known = recording.ports
    for name in ports or ():
        if name not in known:
            raise UnknownName(f'"{name}" was not recorded: there are {" ".join(known)}')
    begin = min((tape.begin for tape in recording.tapes if tape.end), default=0)
    begin += round(start * SECOND)
    end = FOREVER if duration is None else begin + round(duration * SECOND)
    sink: Sink
    if dumper:
        sink = DumperWriter(path, times)
    else:
        where = Path(path)
        where = where if where.suffix == ENDING else where.with_name(f"{where.name}{ENDING}")
        where.parent.mkdir(parents=True, exist_ok=True)
        sink = McapWriter(where, compression, _facts(recording))
    found = Converted(sink.path)
    try:
        notes = _noted(recording, ports, begin if start else 0, end)
        sent = _sent(recording, ports, begin, end)
        # C++ has the comings and goings of a port in a file of their own, by another clock perhaps.
        series = itertools.chain(notes, sent) if dumper else heapq.merge(notes, sent)
        for _, _, item in series:
            if not isinstance(item, Recorded):
                sink.note({key: item[key] for key in item if key != "time_ns"}, item["time_ns"])
                continue
            try:
                sink.add(item.port, item.envelope, item.received_ns, item.payload)
                found.messages += 1
            except LocalProtocolError:
                found.left_out += 1
    finally:
        sink.close()
    return found


def _facts(recording: Recording) -> dict[str, str]:
    """Return what is known of all files: the losses of several are added."""
    found: dict[str, str] = {}
    for tape in recording.tapes:
        for key, value in tape.facts.items():
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


class _Note(dict[str, Any]):
    """A note; two of the same moment are in no order."""

    def __lt__(self, other: object) -> bool:
        return False
