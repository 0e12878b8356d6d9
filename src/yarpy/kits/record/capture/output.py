"""The files of a recording: the next one begins when one is full, and the oldest may go.

Rules: for one thread, but for `sync`. A file is never replaced. What goes is only what this
recording has made. If the folder is taken away while it is written, the recording goes on in a new
file in a new folder.
"""

from __future__ import annotations

import errno
import os
import shutil
import time
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from yarpy.errors import LocalProtocolError
from yarpy.kits.record.capture.disk_space import Split
from yarpy.kits.record.capture.queue import QueuedMessage
from yarpy.kits.record.dumper.writer import DumperWriter
from yarpy.kits.record.mcap.attachment import LARGEST
from yarpy.kits.record.mcap.writer import McapWriter
from yarpy.kits.record.sink import ENDING, Format, NullSink, Opener, Sink, Tee

_KINDS: Final = {".xml": "application/xml", ".json": "application/json"}


class Output:
    """The files of a recording, under the name `name` (a path without ending).

    format: an MCAP file, the folders of C++, or both; or a function that begins a file or folder of
    another kind at a path.
    split: when a new file begins. most: how many files are kept, 0 for all.
    facts: what is known of the recording, for each file.
    ended: called before a file is finished; what it returns is kept with the file.
    waiting: write nothing before `begin`, and after `rest`.
    attached: files that each MCAP file gets, by their names.
    Raises FileExistsError, OSError.
    """

    def __init__(
        self,
        name: Path,
        compression: str = "none",
        split: Split | None = None,
        most: int = 0,
        facts: Callable[[], Mapping[str, str]] = dict,
        ended: Callable[[], Mapping[str, str]] = dict,
        format: Format | Opener = "mcap",
        waiting: bool = False,
        attached: Mapping[str, bytes] | None = None,
    ) -> None:
        self._name = name
        self._compression = compression
        self._split = split or Split()
        self._most = most
        self._facts = facts
        self._ended = ended
        self._attached = dict(attached or {})
        self._format: Format | Opener = format
        self.files: list[Path] = []  # that are there
        self.removed = 0
        self._number = 0
        self._numbered = split is not None or waiting
        self._done = 0  # bytes of finished files
        self._began = 0.0
        self._sink: Sink = NullSink() if waiting else self._open()

    def _open_next(self) -> Sink:
        """Return the next file whose name is free: an older recording does not end this one."""
        while True:
            try:
                return self._open()
            except FileExistsError:
                continue

    def _open(self) -> Sink:
        self._number += 1
        tail = f"-{self._number:04}" if self._numbered or self._number > 1 else ""
        folder = self._name.with_name(f"{self._name.name}{tail}")
        folder.parent.mkdir(parents=True, exist_ok=True)
        sink: Sink
        if callable(self._format):
            sink = self._format(folder)
        elif self._format == "dumper":
            sink = DumperWriter(folder)
        else:
            if self._format == "both" and folder.exists():
                raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(folder))
            path = folder.with_name(f"{folder.name}{ENDING}")
            sink = McapWriter(path, self._compression, self._facts())
            try:
                for name, content in self._attached.items():
                    sink.attach(name, content, _KINDS.get(Path(name).suffix, "text/plain"))
            except OSError:
                sink.close()
                raise
            if self._format == "both":
                sink = Tee(sink, DumperWriter(folder))
        self.files.append(sink.path)
        self._began = time.monotonic()
        return sink

    @property
    def path(self) -> Path:
        """Return the file that is being written."""
        return self._sink.path

    @property
    def size(self) -> int:
        """Return how many bytes were written, in all files."""
        return self._done + self._sink.size

    @property
    def pending(self) -> int:
        """Return how many bytes wait to be written."""
        return self._sink.pending

    @property
    def gone(self) -> bool:
        """Return whether the file was taken away."""
        return not isinstance(self._sink, NullSink) and not os.path.exists(self._sink.path)

    def add(self, queued: QueuedMessage) -> None:
        """Take a message. Raises OSError; LocalProtocolError for what no file takes."""
        split, sink = self._split, self._sink
        if (split.bytes and sink.size + sink.pending + len(queued.payload) > split.bytes) or (
            split.seconds and time.monotonic() - self._began >= split.seconds
        ):
            self.split()
        self._sink.add(queued.port, queued.envelope, queued.received_ns, queued.payload)

    def note(self, what: Mapping[str, Any], received: int) -> None:
        """Take a note about the recording. Raises OSError."""
        with suppress(LocalProtocolError):  # the file has as many channels as it takes
            self._sink.note(what, received)

    def split(self) -> None:
        """Go on in a new file. Raises OSError."""
        self._finish(self._sink)
        self._done += self._sink.size
        self._sink = self._open_next()
        self._make_room()

    def begin(self) -> None:
        """Begin a file after a time without. Raises OSError."""
        self._sink = self._open_next()
        self._make_room()

    def rest(self) -> None:
        """Finish the file, and write nothing before `begin`. Raises OSError."""
        sink, self._sink = self._sink, NullSink()
        self._done += sink.size
        self._finish(sink)

    def _make_room(self) -> None:
        while self._most and len(self.files) > self._most:
            self._remove(self.files.pop(0))

    def _remove(self, oldest: Path) -> None:
        with suppress(OSError):
            if self._format == "both":
                shutil.rmtree(oldest.with_suffix(""))
            if oldest.is_dir():
                shutil.rmtree(oldest)
            else:
                oldest.unlink()
            self.removed += 1

    def _finish(self, sink: Sink) -> None:
        try:
            if os.path.exists(sink.path):
                sink.add_metadata("yarpy", self._ended())
        finally:
            sink.close()

    def leave(self) -> None:
        """The file was taken away: go on in a new one. Raises OSError."""
        lost, self._done = self._sink, self._done + self._sink.size
        with suppress(OSError):
            lost.close()
        self.files.remove(lost.path)
        self._sink = self._open_next()

    def flush(self) -> None:
        """Hand everything to the system. Raises OSError."""
        self._sink.flush()

    def sync(self) -> None:
        """Wait until the disk has what the system has. Any thread may call it. Raises OSError."""
        self._sink.sync()

    def close(self) -> None:
        """Finish the last file. Raises OSError."""
        self._finish(self._sink)


def contents(paths: Iterable[str | Path]) -> dict[str, bytes]:
    """Return what is in files, by their names without folders. Raises OSError, LocalProtocolError
    for two of one name, and for one that is too large to be attached."""
    found: dict[str, bytes] = {}
    for path in map(Path, paths):
        if path.name in found:
            raise LocalProtocolError(f"two files are called {path.name}: rename one of them")
        with path.open("rb") as file:
            found[path.name] = file.read(LARGEST + 1)  # a device has no size
        if len(found[path.name]) > LARGEST:
            raise LocalProtocolError(f"{path} is too large to be attached: {LARGEST} bytes at most")
    return found
