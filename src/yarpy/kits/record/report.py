"""A summary of a recording, for people and for programs: `yarpy info`.

Rules: pure. Without `check` nothing but summaries is read, or the heads of chunks where a file has
none; with it every message is, which finds what is damaged and where ports were silent.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import Any

from yarpy.kits.record.capture.disk_space import size_text
from yarpy.kits.record.capture.loss import KINDS, WORDS
from yarpy.kits.record.envelope import SECOND
from yarpy.kits.record.mcap.storage import McapStorage
from yarpy.kits.record.recording import Recording
from yarpy.log import readable


@dataclass
class PortReport:
    """A port: `rate` in messages a second; `lost`, `missed` ... as `Count` has them;
    `gap` is the longest silence in seconds and `gap_at` when it began, None if that was not
    looked for."""

    name: str
    kinds: list[str]
    messages: int
    rate: float
    lost: int = 0
    missed: int = 0
    left_out: int = 0
    replaced: int = 0
    gap: float | None = None
    gap_at: float | None = None
    playable: bool = True


@dataclass
class Report:
    """A recording. Times are in seconds since 1970."""

    files: list[dict[str, Any]]
    begin: float
    end: float
    messages: int
    ports: list[PortReport]
    marks: list[dict[str, Any]]
    damages: list[str]
    complete: bool
    facts: dict[str, str] = field(default_factory=dict)
    attachments: list[dict[str, Any]] = field(default_factory=list)


def report(recording: Recording, check: bool = False) -> Report:
    """Return what is in a recording."""
    begin, end = recording.begin, recording.end
    gaps = _gaps(recording) if check else {}
    notes = recording.notes()
    losses = _losses(recording, notes)
    duration = end - begin
    ports = []
    for facts in recording.ports.values():
        rate = (facts.messages - 1) / duration if duration > 0 and facts.messages > 1 else 0.0
        one = PortReport(facts.name, facts.kinds, facts.messages, rate, playable=facts.playable)
        one.lost, one.missed, one.left_out, one.replaced = losses.get(facts.name, [0] * len(KINDS))
        if facts.name in gaps:
            one.gap, one.gap_at = gaps[facts.name]
        ports.append(one)
    return Report(
        files=[
            {"path": str(storage.path), "bytes": storage.size, "finished": storage.complete}
            for storage in recording.storages
        ],
        begin=begin,
        end=end,
        messages=sum(port.messages for port in ports),
        ports=sorted(ports, key=lambda port: port.name),
        marks=[
            {"time": note["time_ns"] / SECOND, "what": _text(note.get("what")), "text": _said(note)}
            for note in notes
            if note.get("what") not in ("lost", "connected", "disconnected")
        ],
        damages=recording.damages,
        complete=recording.complete,
        facts={
            key: value for storage in recording.storages for key, value in storage.facts.items()
        },
        attachments=[
            {"name": one.name, "type": one.kind, "bytes": one.size}
            for storage in recording.storages
            if isinstance(storage, McapStorage)
            for one in storage.attachments
        ],
    )


def _losses(recording: Recording, notes: list[dict[str, Any]]) -> dict[str, list[int]]:
    """Return the numbers of KINDS of each port. What a finished file says at its end
    is all; of an unfinished one there are the notes."""
    found: dict[str, list[int]] = {}
    finished = False
    for storage in recording.storages:
        for place, key in enumerate(KINDS):
            try:
                told = json.loads(storage.facts.get(key, "null"))
            except (ValueError, RecursionError):
                told = None
            if isinstance(told, dict):
                finished = True
                for port, count in told.items():
                    found.setdefault(port, [0] * len(KINDS))[place] += _count(count)
    if not finished or not recording.complete:
        counted: dict[str, list[int]] = {}
        for note in notes:
            if note.get("what") == "lost" and isinstance(note.get("port"), str):
                one = counted.setdefault(note["port"], [0] * len(KINDS))
                for place, key in ((0, "count"), (1, "missed"), (3, "replaced")):
                    one[place] += _count(note.get(key))
        for port, numbers in counted.items():
            known = found.setdefault(port, [0] * len(KINDS))
            known[:] = map(max, known, numbers)
    return found


def _count(value: Any) -> int:
    return value if isinstance(value, int) and value > 0 else 0


def _gaps(recording: Recording) -> dict[str, tuple[float, float]]:
    """Read everything; the longest time between two messages of each port, and its beginning."""
    last: dict[str, int] = {}
    found: dict[str, tuple[int, int]] = {}
    for recorded in recording:
        port, now = recorded.port, recorded.received_ns
        before = last.get(port)
        if before is not None and now - before > found.get(port, (-1, 0))[0]:
            found[port] = now - before, before
        last[port] = now
    return {port: (gap / SECOND, at / SECOND) for port, (gap, at) in found.items()}


def _text(value: Any) -> str:
    return readable(str(value))[:200]


def _said(note: dict[str, Any]) -> str:
    rest = {key: value for key, value in note.items() if key not in ("what", "time_ns", "text")}
    words = [_text(note["text"])] if note.get("text") else []
    return " ".join([*words, *(f"{key}={_text(value)}" for key, value in rest.items())])


def lines(found: Report) -> list[str]:
    """Return a report for people."""
    told = []
    for file in found.files:
        state = "" if file["finished"] else ", unfinished"
        told.append(f"file:      {file['path']} ({size_text(file['bytes'])}{state})")
    told.append(f"messages:  {found.messages}")
    told.append(f"duration:  {found.end - found.begin:.3f} s")
    if found.end:
        told.append(f"start:     {_date(found.begin)}")
        told.append(f"end:       {_date(found.end)}")
    words = [found.facts[key] for key in ("host", "system") if key in found.facts]
    if "yarpy" in found.facts:
        words.append(f"yarpy {found.facts['yarpy']}")
    if words:
        told.append(f"recorded:  {readable(', '.join(words))}")
    told.append("ports:")
    wide = max((len(readable(port.name)) for port in found.ports), default=0)
    for port in found.ports:
        told.append(f"  {readable(port.name).ljust(wide)}  {_port(port, found.begin)}")
    for one in found.attachments:
        kind = f"{one['type']}, " if one["type"] else ""
        told.append(f"attached:  {_text(one['name'])} ({_text(kind)}{size_text(one['bytes'])})")
    if found.marks:
        told.append("notes:")
    for mark in found.marks:
        text = f"{mark['what']} {mark['text']}".rstrip()
        told.append(f"  {mark['time'] - found.begin:10.3f} s  {text}")
    if found.damages:
        told.append("damaged:")
        told += [f"  {readable(damage)}" for damage in found.damages]
    return told


def _port(port: PortReport, begin: float) -> str:
    words = [f"{port.messages:8} messages", f"{port.rate:8.2f} Hz", " ".join(port.kinds)]
    odd = [
        f"{number} {word}"
        for number, word in zip(
            (port.lost, port.missed, port.left_out, port.replaced), WORDS, strict=True
        )
        if number
    ]
    if port.gap is not None and port.gap_at is not None:
        odd.append(f"longest silence {port.gap:.3f} s at {port.gap_at - begin:.3f} s")
    if not port.playable:
        odd.append("not of YARP")
    return "  ".join(words).rstrip() + (f"  ({', '.join(odd)})" if odd else "")


def _date(seconds: float) -> str:
    try:
        local = datetime.fromtimestamp(seconds, UTC).astimezone()
        return f"{local.isoformat(sep=' ', timespec='milliseconds')} ({seconds:.6f})"
    except (OverflowError, OSError, ValueError):
        return f"{seconds:.6f}"
