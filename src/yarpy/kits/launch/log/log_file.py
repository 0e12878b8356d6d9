"""Files that keep a log: text, JSON or MCAP, by the ending of their names.

    walk.log, walk.txt      as it is shown, with the date
    walk.json, walk.jsonl   an object in each line
    walk.mcap               the messages as they came, for `yarpy play` and Foxglove

Rules: a file that is there is never replaced. What was added is in the file after each `flush`.
"""

from __future__ import annotations

import json
import time
from datetime import datetime
from pathlib import Path
from typing import IO, Protocol

from yarpy.errors import LocalProtocolError
from yarpy.kits.launch.log.shown import text_of, told_of
from yarpy.port.keep.log_line import LogLine
from yarpy.wire.message import Message


class LogFile(Protocol):
    """A file that keeps lines."""

    def add(self, line: LogLine, message: Message) -> None:
        """Keep a line, which came as that message. Raises OSError."""

    def flush(self) -> None:
        """Let others read what was added. Raises OSError."""

    def close(self) -> None:
        """Add no more."""


def open_log_file(path: str | Path) -> LogFile:
    """Return a new file for lines. Raises FileExistsError, OSError, LocalProtocolError for an
    ending that nobody knows, UnknownPlugin if the library `mcap` is missing."""
    path = Path(path)
    match path.suffix:
        case ".log" | ".txt":
            return TextFile(path)
        case ".json" | ".jsonl":
            return JsonFile(path)
        case ".mcap":
            return McapFile(path)
    raise LocalProtocolError(
        f'"{path.name}" does not say what to write: end it with .log, .txt, .json, .jsonl or .mcap'
    )


class TextFile:
    """A file of text."""

    def __init__(self, path: Path) -> None:
        self._file: IO[str] = path.open("x", encoding="utf-8", errors="backslashreplace")

    def add(self, line: LogLine, message: Message) -> None:
        day = datetime.fromtimestamp(line.time or time.time()).strftime("%Y-%m-%d")
        self._file.write(f"{day} {text_of(line)}\n")

    def flush(self) -> None:
        self._file.flush()

    def close(self) -> None:
        self._file.close()


class JsonFile:
    """A file of objects, one in each line."""

    def __init__(self, path: Path) -> None:
        self._file: IO[str] = path.open("x", encoding="utf-8", errors="replace")

    def add(self, line: LogLine, message: Message) -> None:
        self._file.write(json.dumps(told_of(line), ensure_ascii=False, default=str) + "\n")

    def flush(self) -> None:
        self._file.flush()

    def close(self) -> None:
        self._file.close()


class McapFile:
    """A recording, whose topics are the ports of the programs."""

    def __init__(self, path: Path) -> None:
        from yarpy.kits.record.mcap.writer import McapWriter

        self._writer = McapWriter(path)

    def add(self, line: LogLine, message: Message) -> None:
        received = int((line.time or time.time()) * 1e9)
        self._writer.add(line.origin or "/log", "", received, bytes(message.to_bytes()))

    def flush(self) -> None:
        self._writer.flush()

    def close(self) -> None:
        self._writer.close()
