"""Recordings of C++ yarpdatadumper: a folder with a folder for each port.

Rules: lines are read one after the other, so memory does not grow with the recording. A line that
cannot be read is left out and told with its byte; the last one, if it has no end, was cut off. A
`Stamp: rx` says nothing about the column (C++ writes the sender's time there if it has one), so a
single column is both times; where there are two, the first is the sender's. Names of picture files
lead nowhere else.
"""

from __future__ import annotations

import heapq
import os
import re
from collections.abc import Callable, Container, Iterator
from pathlib import Path
from typing import Any, BinaryIO, Final

from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError, MissingFile, UnknownPlugin
from yarpy.kits.record.dumper.part import DATA, INFO
from yarpy.kits.record.dumper.picture import read_picture
from yarpy.kits.record.envelope import SECOND, stamp_text
from yarpy.kits.record.mcap.layout import Damaged
from yarpy.kits.record.mcap.storage import FOREVER
from yarpy.kits.record.recorded import PortFacts, Recorded
from yarpy.limit import DUMPED_LINE, RECORDED_TEXT, limits
from yarpy.platform.refusal import reason

_LINE: Final = re.compile(
    rb"(-?\d{1,10}) (-?\d{1,11})\.(\d{6})(?: (-?\d{1,11})\.(\d{6}))?(?: |$)", re.ASCII
)
_ONE: Final = re.compile(rb"(-?\d{1,10}) (-?\d{1,11})\.(\d{6})(?: |$)", re.ASCII)
_FILE: Final = re.compile(r"([\w-]{1,100}\.\w{1,20})(?: \[(.{0,4})\])?\s*")
_PICTURES: Final = ("Image", "Depth", "Video")
_DAMAGES: Final = 1000  # that are told of a folder


class DumperStorage:
    """A folder at `path`, and those in it. Raises MissingFile if none is a recording."""

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self.damages: list[Damaged] = []
        self._parts = [
            Part(info.parent, self._tell)
            for info in sorted(self.path.rglob(INFO))
            if (info.parent / DATA).is_file()
        ]
        if not self._parts:
            raise MissingFile(f"{path} has no recording: no folder with {INFO} and {DATA}")
        self.size = sum(part.size for part in self._parts)

    def _tell(self, damage: Damaged) -> None:
        if len(self.damages) < _DAMAGES and str(damage) not in map(str, self.damages):
            self.damages.append(damage)

    @property
    def begin(self) -> int:
        """Return the earliest time of a first message, in nanoseconds; 0 if there is none."""
        return min((part.span[0] for part in self._parts if part.messages), default=0)

    @property
    def end(self) -> int:
        """Return the latest time of a message, in nanoseconds; 0 if there is none."""
        return max((part.span[1] for part in self._parts), default=0)

    @property
    def complete(self) -> bool:
        """Return whether nothing was cut off."""
        return all(part.complete for part in self._parts)

    @property
    def facts(self) -> dict[str, str]:
        """Return what is known of the recorder, which is nothing."""
        return {}

    @property
    def ports(self) -> dict[str, PortFacts]:
        """Return the ports by their names."""
        found: dict[str, PortFacts] = {}
        for part in self._parts:
            facts = found.setdefault(part.port, PortFacts(part.port))
            facts.messages += part.messages
            if part.kind not in facts.kinds:
                facts.kinds.append(part.kind)
        return found

    def messages(
        self, ports: Container[str] | None = None, begin: int = 0, end: int = FOREVER
    ) -> Iterator[Recorded]:
        """Yield the messages of these ports (None: all) from `begin` until before `end`, in the
        order of their times. Raises UnknownPlugin where a library for pictures is missing."""
        series = [
            part.read(begin, end) for part in self._parts if ports is None or part.port in ports
        ]
        if len(series) == 1:
            return series[0]
        return heapq.merge(*series, key=lambda recorded: recorded.received_ns)

    def notes(self) -> list[dict[str, Any]]:
        """Return who came and went."""
        return [note for part in self._parts for note in part.notes]

    def close(self) -> None:
        """Nothing stays open."""


class Part:
    """The folder of a port: its name, type and size, and the first and last time in it.

    tell: called with what is damaged. times: how many columns of them there are, 0: info.log says.
    """

    def __init__(self, folder: Path, tell: Callable[[Damaged], object], times: int = 0) -> None:
        self._folder = folder
        self._columns = times
        self._tell = tell
        try:
            with open(folder / INFO, "rb") as file:
                text = file.read(RECORDED_TEXT).decode("utf-8", "replace")
            with os.scandir(folder) as found:
                self.size = sum(one.stat().st_size for one in found if one.is_file())
        except OSError as error:
            raise MissingFile(f"{folder / INFO} cannot be read: {reason(error)}") from error
        lines = text.splitlines()
        words = lines[0].split() if lines else []
        self._type = words[1].rstrip(";") if len(words) > 1 and words[0] == "Type:" else "Bottle"
        self._stamps = next((line for line in lines[:3] if line.startswith("Stamp:")), "")
        self.kind = "yarp/image" if self._type.startswith(_PICTURES) else "yarp/bottle"
        self.notes = [note for line in lines[1:] for note in _events(line)]
        named = [note["port"] for note in self.notes]
        # A recorder that was never connected has no name to write down.
        self.port: str = named[0] if named else f"/{folder.name}"
        self.messages = 0
        self.complete = True
        self.span = (0, 0)
        self._survey()

    def _survey(self) -> None:
        """Count the lines, and read their times."""
        first, last = 0, 0
        for _, line in self._lines():
            times = self._times(line)
            if times is not None:
                self.messages += 1
                first = times[2] if self.messages == 1 else min(first, times[2])
                last = max(last, times[2])
        self.span = first, last

    def _lines(self) -> Iterator[tuple[int, bytes]]:
        """Yield the place and the text of each line."""
        try:
            with open(self._folder / DATA, "rb") as file:
                yield from self._lines_of(file)
        except OSError as error:
            raise MissingFile(f"{self._folder / DATA} cannot be read: {reason(error)}") from error

    def _lines_of(self, file: BinaryIO) -> Iterator[tuple[int, bytes]]:
        place = 0
        while line := file.readline(DUMPED_LINE):
            if not line.endswith(b"\n"):
                long = len(line) >= DUMPED_LINE
                why = (
                    f"a line of more than {DUMPED_LINE} bytes"
                    if long
                    else "the last line is cut off"
                )
                self.complete = False
                self._damaged(place, why)
                return
            if line.strip():
                yield place, line.rstrip(b"\r\n")
            place += len(line)

    def _damaged(self, place: int, why: str) -> None:
        self._tell(Damaged(place, f"{self._folder.name}/{DATA}: {why}"))

    def _times(self, line: bytes) -> tuple[int, int, int, int] | None:
        """Return the count, the times of sending and of receipt, and where the content begins."""
        match = (_LINE if "tx" in self._stamps or self._columns > 1 else _ONE).match(line)
        if match is None:
            return None
        sent = _nanoseconds(match[2], match[3])
        two = self._columns > 1 or "tx+rx" in self._stamps or (match[1] == b"-1" and sent == 0)
        if match.re is _LINE and match[4] is not None and two:
            return int(match[1]), sent, _nanoseconds(match[4], match[5]), match.end()
        if match.re is _LINE and match[4] is not None:  # the content begins with a number
            match = _ONE.match(line)
            assert match is not None
        return int(match[1]), sent, sent, match.end()

    def times(self) -> Iterator[tuple[int, int]]:
        """Yield the times of sending and of receipt of each message, in nanoseconds."""
        for _, line in self._lines():
            times = self._times(line)
            if times is not None:
                yield times[1:3]

    def read(self, begin: int, end: int) -> Iterator[Recorded]:
        """Yield the messages of that time."""
        for recorded in self.numbered(lambda sent, received: begin <= received < end):
            yield recorded[1]

    def numbered(self, wanted: Callable[[int, int], bool]) -> Iterator[tuple[int, Recorded]]:
        """Yield the messages with wanted times of sending and of receipt, and their numbers in the
        file, from 0."""
        number = -1
        for place, line in self._lines():
            times = self._times(line)
            if times is None:
                self._damaged(place, "a line without a number and a time")
                continue
            number += 1
            count, sent, received, start = times
            if not wanted(sent, received):
                continue
            text = line[start:].decode("utf-8", "surrogateescape")
            try:
                payload = self._payload(text)
            except UnknownPlugin:
                raise
            except (DecodeError, ValueError, OSError) as error:
                self._damaged(place, str(error))
                continue
            envelope = stamp_text(count, sent) if count >= 0 and sent >= 0 else ""
            yield number, Recorded(self.port, received, sent, envelope, payload)

    def _payload(self, text: str) -> bytes:
        if self.kind == "yarp/image" and (match := _FILE.fullmatch(text)) is not None:
            with open(self._folder / match[1], "rb") as file:
                data = file.read(limits().picture + RECORDED_TEXT)
            value: Any = read_picture(data, match[1], match[2] or "")
        else:
            value = Bottle.from_text(text)
        return b"".join(map(bytes, codec.encode(value)))


def _nanoseconds(seconds: bytes, micros: bytes) -> int:
    whole = int(seconds) * SECOND
    return whole - int(micros) * 1000 if seconds.startswith(b"-") else whole + int(micros) * 1000


_EVENT: Final = re.compile(r"\[(\d{1,11}\.\d{6})\] (/\S{0,1000}) \[(connected|disconnected)\]")


def _events(line: str) -> Iterator[dict[str, Any]]:
    match = _EVENT.fullmatch(line.strip())
    if match is not None:
        when = round(float(match[1]) * SECOND)
        yield {"what": match[3], "port": match[2], "time_ns": when}
