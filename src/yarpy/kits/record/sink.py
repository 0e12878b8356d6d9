"""Sink: a file or folder that is being written; both at once, and none at all.

Rules: for one thread, but for `sync`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
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
    """An MCAP file, and the folders of C++ beside it.

    Where one of them fails, the other one still takes what the first had not written yet; then the
    error comes. So what is in either of them is not lost.
    """

    def __init__(self, file: McapWriter, folder: DumperWriter) -> None:
        self._file = file
        self._folder = folder
        self._left: list[McapWriter | DumperWriter] = [file, folder]
        self._failed: OSError | None = None
        self.path = file.path

    @property
    def size(self) -> int:
        """Return how many bytes were written."""
        return self._file.size + self._folder.size

    @property
    def pending(self) -> int:
        """Return how much waits to be written; 0 for nothing."""
        return sum(sink.pending for sink in self._left)

    def add(self, port: str, envelope: str, received: int, payload: bytes | memoryview) -> None:
        """Take a message; what C++ cannot keep is in the file alone. Raises OSError."""
        if self._failed is not None and not self.pending:
            raise self._failed
        self._each(lambda sink: sink.add(port, envelope, received, payload))

    def note(self, what: Mapping[str, Any], received: int) -> None:
        """Take a note about the recording."""
        self._each(lambda sink: sink.note(what, received))

    def add_metadata(self, name: str, values: Mapping[str, str]) -> None:
        """Take what is known at the end."""
        self._file.add_metadata(name, values)

    def flush(self) -> None:
        """Hand everything to the system. Raises OSError."""
        self._each(lambda sink: sink.flush())

    def _each(self, act: Callable[[McapWriter | DumperWriter], None]) -> None:
        """Do something with those that have not failed. Raises OSError if none is left."""
        for sink in [*self._left]:
            try:
                act(sink)
            except LocalProtocolError:
                if sink is self._left[0]:
                    raise
            except OSError as error:
                self._failed = error
                self._left.remove(sink)
        if self._failed is not None and not self._left:
            raise self._failed

    def sync(self) -> None:
        """Wait for the disk."""
        self._file.sync()

    def close(self) -> None:
        """Finish both. Raises OSError, also if one has failed before."""
        try:
            self._folder.close()
        finally:
            self._file.close()
        if self._failed is not None:
            raise self._failed


class NullSink:
    """A sink that throws messages away, while there is no file."""

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
