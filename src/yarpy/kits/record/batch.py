"""Batch: what the thread of a recorder has given to its files and the system does not have yet.

Rules: for that thread alone. Its memory counts until it is written; what cannot be written is lost,
and counted so.
"""

from __future__ import annotations

import time
from typing import Final

from yarpy.errors import LocalProtocolError
from yarpy.kits.record.intake import Intake, Taken
from yarpy.kits.record.output import Output

FLUSH: Final = 0.4  # seconds until what has come is handed to the system


class Batch:
    """The messages that were given to the output and are not in the system's hands yet."""

    def __init__(self, intake: Intake, output: Output) -> None:
        self._intake = intake
        self._output = output
        self._taken: list[Taken] = []
        self._since = 0.0  # as of time.monotonic; 0 if nothing waits

    def begin(self) -> None:
        """Something waits."""
        self._since = self._since or time.monotonic()

    @property
    def due(self) -> bool:
        """Return whether it is time to flush."""
        if not self._since:
            return False
        full = self._intake.held > self._intake.memory // 16
        return full or time.monotonic() - self._since >= FLUSH

    def add(self, taken: Taken) -> None:
        """Give a message to the output. Raises OSError."""
        self._taken.append(taken)
        self.count_missed(taken)
        try:
            self._output.add(taken)
        except LocalProtocolError:
            self._taken.pop()
            self._intake.lose(taken)
            self._intake.free(taken.size)
            return
        self.begin()
        if not self._output.pending:
            self._settle()

    def count_missed(self, taken: Taken) -> None:
        """Count what the numbers of envelopes leave out."""
        number, space, _ = taken.envelope.partition(" ")
        if not (space and number.isascii() and number.isdigit() and len(number) < 11):
            return
        count, sequence = self._intake.counts[taken.port], int(number)
        if taken.follows and 0 <= count.sequence < sequence - 1:
            count.missed += sequence - count.sequence - 1
        count.sequence = sequence

    def flush(self) -> None:
        """Hand it to the system. Raises OSError."""
        self._output.flush()
        self._settle()

    def _settle(self) -> None:
        self._intake.free(sum(taken.size for taken in self._taken))
        self._taken.clear()
        self._since = 0.0

    def lose(self) -> None:
        """It is lost."""
        for taken in self._taken:
            self._intake.lose(taken)
        self._settle()
