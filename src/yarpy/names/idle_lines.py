"""The connections to a name server that are kept for the next command.

Rules: a connection is lent to one command at a time. The lock guards the list alone and is never
held across I/O. What has waited for more than IDLE seconds may be dead, and what a forked process
shares with its parent would mix their replies: both are closed, not lent. Those of a client that is
dropped close by themselves.
"""

from __future__ import annotations

import os
import time

from yarpy import fork
from yarpy.names.line import Line

IDLE = 10.0  # seconds after which an unused connection is not trusted any more
SPARE = 2  # connections of each kind that are kept for the next command


class IdleLines:
    """Connections that wait for a command, the one used last at the end."""

    def __init__(self) -> None:
        self._lines: list[Line] = []
        self._lock = fork.lock()

    @property
    def kinds(self) -> list[str]:
        """The kinds of the connections that wait."""
        return [line.kind for line in self._lines]

    def borrow(self, kind: str) -> Line | None:
        """Return a connection of a kind, for one command; None if a new one has to be made."""
        now, process = time.monotonic(), os.getpid()
        stale = []
        found = None
        with self._lock:
            for line in reversed(self._lines):
                # A fork shares the socket; two processes in one dialogue would mix their replies.
                if now - line.used > IDLE or line.process != process:
                    stale.append(line)
                elif found is None and line.kind == kind:
                    found = line
            gone = {id(line) for line in (*stale, found)}
            self._lines = [line for line in self._lines if id(line) not in gone]
        for line in stale:
            line.close()
        return found

    def give_back(self, line: Line) -> None:
        """Keep a connection, or close it: where a reply is not read to its end, or SPARE wait."""
        line.used = time.monotonic()
        with self._lock:
            alike = sum(other.kind == line.kind for other in self._lines)
            if line.clean and alike < SPARE:
                self._lines.append(line)
                return
        line.close()

    def close(self) -> None:
        """Close all that wait."""
        with self._lock:
            lines, self._lines = self._lines, []
        for line in lines:
            line.close()
