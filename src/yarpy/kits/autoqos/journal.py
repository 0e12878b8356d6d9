"""The journal: what the agent has changed, on disk before it is done.

Rules: whoever starts next finds what one that was killed has left, and undoes it. One agent at a
time: the file is locked while it runs. A line is a change as JSON, with the value of the beginning
in `before`; it is written and synced before the change is made, so a last line without an end, as a
crash leaves it, stands for nothing. Others that cannot be read are counted, and kept in a copy.
"""

from __future__ import annotations

import json
import os
from contextlib import suppress
from pathlib import Path
from typing import Final

from yarpy.errors import LocalProtocolError
from yarpy.kits.autoqos.change import Change
from yarpy.limit import JOURNAL
from yarpy.platform.file_lock import hold
from yarpy.platform.folders import data_home

NAME: Final = "autoqos.journal"


def path() -> Path:
    """Return the path of this user's journal."""
    return data_home(os.environ) / NAME


class Journal:
    """Open, and so locked. Raises LocalProtocolError if another agent has it."""

    def __init__(self, where: Path) -> None:
        self.where = where
        try:
            where.parent.mkdir(parents=True, exist_ok=True)
            self._file = open(where, "a+b")  # noqa: SIM115
        except OSError as error:
            raise LocalProtocolError(f"{where} cannot be written: {error}") from error
        try:
            held = hold(self._file.fileno())
        except OSError:  # a file system without locks: two agents are not found out
            held = True
        if not held:
            self._file.close()
            raise LocalProtocolError(
                f"another autoqos is running: it has {where} (YARP_DATA_HOME says where that is)"
            )
        self._first: dict[tuple[str, str, str], Change] = {}
        self.damaged = 0  # lines that could not be read
        self.copy = where.with_name(f"{where.name}.damaged")
        self._file.seek(0)
        text = self._file.read(JOURNAL)
        for line in text.splitlines(keepends=True):
            try:
                change = Change.from_dict(json.loads(line))
            except (ValueError, RecursionError):
                self.damaged += line.endswith(b"\n")
            else:
                self._first.setdefault(change.what, change)
        self.damaged += bool(self._file.read(1))  # too much of it
        if self.damaged:
            with suppress(OSError):
                self.copy.write_bytes(text)

    def left(self) -> list[Change]:
        """Return the changes that undo everything, the last change first."""
        return [change.undone for change in reversed(self._first.values())]

    def write(self, change: Change) -> None:
        """A change is about to be made. Only the first of each thing counts."""
        if change.what in self._first:
            return
        self._first[change.what] = change
        self._file.write(json.dumps(change.as_dict()).encode() + b"\n")
        self._file.flush()
        os.fsync(self._file.fileno())

    def clear(self) -> None:
        """Empty the journal: all has been undone."""
        self._first.clear()
        self._file.truncate(0)

    def close(self) -> None:
        """Let others have it."""
        self._file.close()
