"""RingBuffer: the last seconds of a recording, which are written when somebody asks for them.

Rules: for the thread of a recorder alone. What is older than `seconds` goes, by a clock that nobody
sets, and what is more than `memory` bytes: that is no loss. A trigger looks at the messages of a
port, and fires when one matches and the one before it did not.
"""

from __future__ import annotations

import re
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any, Final

from yarpy.data.bottle import Bottle
from yarpy.errors import LocalProtocolError, YarpError
from yarpy.kits.record.capture.output import Output
from yarpy.kits.record.capture.queue import MessageQueue, QueuedMessage
from yarpy.kits.record.capture.subscriptions import compiled
from yarpy.kits.record.envelope import SECOND
from yarpy.wire.message import DATA, Message

LONGEST: Final = 1 << 16  # bytes of a message that a trigger looks at
_NOTES: Final = 1000


class RingBuffer:
    """Keeps messages and notes. triggers: regular expressions by ports, searched for in the text
    of their messages. clock: nanoseconds since some moment. Raises LocalProtocolError for what is
    no expression."""

    def __init__(
        self,
        seconds: float,
        memory: int,
        triggers: Mapping[str, str],
        clock: Callable[[], int] = time.monotonic_ns,
    ) -> None:
        self._keep = round(seconds * SECOND)
        self._memory = memory
        self._clock = clock
        self._messages: deque[tuple[int, QueuedMessage]] = deque()  # with when they came
        self._notes: deque[tuple[Mapping[str, Any], int, int]] = deque(maxlen=_NOTES)
        self._triggers: dict[str, re.Pattern[str]] = {}
        for port, text in triggers.items():
            pattern = compiled(text)
            if pattern is None:
                raise LocalProtocolError(f"the trigger of {port} is empty: {port}=fall")
            self._triggers[port] = pattern
        self._fired: set[str] = set()
        self.held = 0  # bytes

    def add(self, queued: QueuedMessage) -> bool:
        """Keep a message; return whether it is one that was waited for."""
        now = self._clock()
        self._messages.append((now, queued))
        self.held += queued.size
        self._forget(now)
        return queued.port in self._triggers and self._fires(queued)

    def _forget(self, now: int) -> None:
        messages = self._messages
        while messages and (self.held > self._memory or now - messages[0][0] > self._keep):
            self.held -= messages.popleft()[1].size

    def _fires(self, queued: QueuedMessage) -> bool:
        if len(queued.payload) > LONGEST:
            return False
        try:
            text = Message(DATA, queued.payload, "").as_(Bottle).to_text()
        except YarpError:
            return False
        before = queued.port in self._fired
        if self._triggers[queued.port].search(text) is None:
            self._fired.discard(queued.port)
            return False
        self._fired.add(queued.port)
        return not before

    def note(self, what: Mapping[str, Any], received: int) -> None:
        """Keep a note."""
        self._notes.append((what, received, self._clock()))

    def drain(self) -> tuple[Sequence[QueuedMessage], Sequence[tuple[Mapping[str, Any], int]]]:
        """Return the messages and notes of the last seconds, which go."""
        now = self._clock()
        self._forget(now)
        messages = [queued for _, queued in self._messages]
        notes = [(what, at) for what, at, came in self._notes if came >= now - self._keep]
        self._messages.clear()
        self._notes.clear()
        self.held = 0
        return messages, notes

    def save(self, output: Output, queue: MessageQueue) -> None:
        """Write what `drain` gives into a file of its own; what cannot be written counts as lost.
        Raises OSError."""
        messages, notes = self.drain()
        output.begin()
        for note in notes:
            output.note(*note)
        written = 0
        try:
            for number, queued in enumerate(messages, start=1):
                with suppress(LocalProtocolError):  # no file takes it
                    output.add(queued)
                if not output.pending:
                    written = number
            output.flush()
            written = len(messages)
        finally:
            for queued in messages[written:]:
                queue.lose(queued)
        output.rest()
