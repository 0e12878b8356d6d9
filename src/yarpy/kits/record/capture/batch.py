"""Batch: what the thread of a recorder has given to its files and the system does not have yet.

Rules: for that thread alone. Its memory counts until it is written; what cannot be written is lost,
and counted so.
"""

from __future__ import annotations

import time
from typing import Final

from yarpy.errors import LocalProtocolError
from yarpy.kits.record.capture.output import Output
from yarpy.kits.record.capture.queue import MessageQueue, QueuedMessage

FLUSH: Final = 0.4  # seconds until what has come is handed to the system


class Batch:
    """The messages that were given to the output and are not in the system's hands yet."""

    def __init__(self, queue: MessageQueue, output: Output) -> None:
        self._queue = queue
        self._output = output
        self._messages: list[QueuedMessage] = []
        self._since = 0.0  # as of time.monotonic; 0 if nothing waits

    def begin(self) -> None:
        """Something waits."""
        self._since = self._since or time.monotonic()

    @property
    def due(self) -> bool:
        """Return whether it is time to flush."""
        if not self._since:
            return False
        full = self._queue.held > self._queue.memory // 16
        return full or time.monotonic() - self._since >= FLUSH

    def add(self, queued: QueuedMessage) -> None:
        """Give a message to the output. Raises OSError."""
        self.count_missed(queued)
        self._give(queued)

    def _give(self, queued: QueuedMessage) -> None:
        self._messages.append(queued)
        try:
            self._output.add(queued)
        except LocalProtocolError:
            self._messages.pop()
            self._queue.lose(queued)
            self._queue.free(queued.size)
            return
        if not self._output.pending:
            self._settle()
        elif not self._since:
            self.begin()

    def count_missed(self, queued: QueuedMessage) -> None:
        """Count what the numbers of envelopes leave out."""
        number, space, _ = queued.envelope.partition(" ")
        if not (space and number.isascii() and number.isdigit() and len(number) < 11):
            return
        count, sequence = self._queue.counts[queued.port], int(number)
        if queued.follows and 0 <= count.sequence < sequence - 1:
            count.missed += sequence - count.sequence - 1
        count.sequence = sequence

    def flush(self) -> None:
        """Hand it to the system. Raises OSError."""
        self._output.flush()
        self._settle()

    def _settle(self) -> None:
        self._queue.free(sum(queued.size for queued in self._messages))
        self._messages.clear()
        self._since = 0.0

    def again(self) -> None:
        """Give all of it to the output once more: the file that had it is gone. Raises OSError."""
        messages, self._messages, self._since = self._messages, [], 0.0
        for queued in messages:
            self._give(queued)

    def lose(self) -> None:
        """Count all its messages as lost."""
        for queued in self._messages:
            self._queue.lose(queued)
        self._settle()
