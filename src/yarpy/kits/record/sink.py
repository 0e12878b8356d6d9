"""Sink: a file or folder that is being written; both at once, and none at all.

Rules: for one thread, but for `sync`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, Final, Literal, Protocol, TypeAlias

from yarpy.errors import LocalProtocolError
from yarpy.kits.record.dumper.writer import DumperWriter
from yarpy.kits.record.mcap.writer import McapWriter

ENDING: Final = ".mcap"

Format: TypeAlias = Literal["mcap", "dumper", "both"]
Opener: TypeAlias = "Callable[[Path], Sink]"


def named(path: str | Path) -> Path:
    """Return the path of a new recording. Raises LocalProtocolError for one without a name."""
    found = Path(path)
    if found.name in ("", ".."):
        raise LocalProtocolError(f'"{path}" is no name of a recording: try {found / "walk"}')
    return found


class Sink(Protocol):
    """A file or folder that is being written."""

    path: Path

    @property
    def size(self) -> int:
        """Return how many bytes were written."""

    @property
    def pending(self) -> int:
        """Return how much waits to be written; 0 for nothing."""

    def add(self, port: str, envelope: str, received: int, payload: bytes | memoryview) -> None:
        """Take a message."""

    def note(self, what: Mapping[str, Any], received: int) -> None:
        """Take a note about the recording."""

    def add_metadata(self, name: str, values: Mapping[str, str]) -> None:
        """Take what is known at the end."""

    def flush(self) -> None:
        """Hand everything to the system."""

    def sync(self) -> None:
        """Wait for the disk."""

    def close(self) -> None:
        """Finish it."""


class Tee:
    """An MCAP file, and the folders of C++ beside it."""

    def __init__(self, file: McapWriter, folder: DumperWriter) -> None:
        self._file = file
        self._folder = folder
        self.path = file.path

    @property
    def size(self) -> int:
        """Return how many bytes were written."""
        return self._file.size + self._folder.size

    @property
    def pending(self) -> int:
        """Return how much waits to be written; 0 for nothing."""
        return self._file.pending + self._folder.pending

    def add(self, port: str, envelope: str, received: int, payload: bytes | memoryview) -> None:
        """Take a message; what C++ cannot keep is in the file alone."""
        self._file.add(port, envelope, received, payload)
        with suppress(LocalProtocolError):
            self._folder.add(port, envelope, received, payload)

    def note(self, what: Mapping[str, Any], received: int) -> None:
        """Take a note about the recording."""
        self._file.note(what, received)
        self._folder.note(what, received)

    def add_metadata(self, name: str, values: Mapping[str, str]) -> None:
        """Take what is known at the end."""
        self._file.add_metadata(name, values)

    def flush(self) -> None:
        """Hand everything to the system."""
        self._file.flush()
        self._folder.flush()

    def sync(self) -> None:
        """Wait for the disk."""
        self._file.sync()

    def close(self) -> None:
        """Finish both."""
        try:
            self._folder.close()
        finally:
            self._file.close()


class NullSink:
    """Where messages go while there is no file."""

    path = Path()
    size = 0
    pending = 0

    def add(self, port: str, envelope: str, received: int, payload: bytes | memoryview) -> None:
        """Leave a message out."""

    def note(self, what: Mapping[str, Any], received: int) -> None:
        """Leave a note out."""

    def add_metadata(self, name: str, values: Mapping[str, str]) -> None:
        """Leave it out."""

    def flush(self) -> None:
        """Nothing waits."""

    def sync(self) -> None:
        """Nothing waits."""

    def close(self) -> None:
        """Nothing is open."""
