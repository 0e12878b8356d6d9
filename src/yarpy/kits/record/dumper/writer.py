"""The folders that C++ yarpdatadumper writes, one for each port: `info.log`, `data.log`, pictures.

    NAME/icub/cam/left/info.log       Type: Image;  Stamp: rx;  [time] /icub/cam/left [connected]
    NAME/icub/cam/left/data.log       12 101.250000 00000000.ppm [rgb]
    NAME/icub/cam/left/00000000.ppm

Rules: byte for byte what C++ 3.9 writes, where that is right. Text does not tell int8, int16, int64
and float32 from int32 and float64; pictures of other pixels than mono, rgb, bgr and rgba become
rgb, as in C++, but for float ones (`.float`, without the padding that C++ puts there) and Bayer
ones, which are stored as they are: these end C++ yarpdatadumper. Alpha is lost. An MCAP file keeps
everything. Names of ports are made harmless before they become names of folders.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from yarpy.kits.record.dumper.part import INFO, Part, Times, event, type_of

_ODD: Final = re.compile(r"[:*?|><\\\x00-\x1f]")
_OURS: Final = re.compile(r"(?:info\.log|data\.log|\d{8}\.\w+)", re.IGNORECASE)


class DumperWriter:
    """A new folder at `path`, with one for each port. Raises FileExistsError.

    times: what `--rxTime` and `--txTime` of C++ choose: "" is the sender's time, or that of receipt
    where there is no envelope; "rx", "tx" and "tx+rx" are the others.
    """

    def __init__(self, path: str | Path, times: Times = "") -> None:
        self.path = Path(path)
        self.path.mkdir(parents=True)
        self.size = 0
        self.pending = 0
        self._times: Times = times
        self._parts: dict[str, Part] = {}
        self._events: dict[str, list[str]] = {}  # of ports without messages

    def add(self, port: str, envelope: str, received: int, payload: bytes | memoryview) -> None:
        """Take a message. Raises OSError; LocalProtocolError for what has no text."""
        part = self._parts.get(port)
        if part is None:
            events = self._events.pop(port, None) or [event(port, received, "connected")]
            part = Part(self._folder(port), type_of(payload), self._times, events)
            self._parts[port] = part
        before = part.size
        part.add(envelope, received, payload)
        self.size += part.size - before
        self.pending += 1

    def _folder(self, port: str) -> Path:
        """Return a new folder for a port."""
        wanted = self.path.joinpath(*harmless(port))
        found, number = wanted, 0
        while (found / INFO).exists():
            number += 1
            found = wanted.with_name(f"{wanted.name}_{number:05}")
        found.mkdir(parents=True, exist_ok=True)
        return found

    def note(self, what: Mapping[str, Any], received: int) -> None:
        """Take a note about the recording; of connections only, as in C++."""
        port, word = what.get("port"), what.get("what")
        if not isinstance(port, str) or word not in ("connected", "disconnected"):
            return
        line = event(port, received, str(word))
        if port in self._parts:
            self._parts[port].tell(line)
        else:
            self._events.setdefault(port, []).append(line)

    def add_metadata(self, name: str, values: Mapping[str, str]) -> None:
        """Do nothing: the format has no place for it."""

    def flush(self) -> None:
        """Hand everything to the system. Raises OSError."""
        for part in self._parts.values():
            part.file.flush()
        self.pending = 0

    def sync(self) -> None:
        """The system writes it in its own time."""

    def close(self) -> None:
        """Finish the files. Raises OSError."""
        for part in self._parts.values():
            part.file.close()


def harmless(port: str) -> list[str]:
    """Return the folders for a port, one in the other; none leads out of them.

    >>> harmless("/we:ird*/../x")
    ['we_ird_', '__', 'x']
    """
    found = []
    for word in port.split("/"):
        word = _ODD.sub("_", word)[:200]
        if word.strip(".") == "" and word:
            word = "_" * len(word)
        if _OURS.fullmatch(word):
            word += "_"
        if word:
            found.append(word)
    return found or ["port"]
