"""Backlog: the last seconds of what was taken, which are written when somebody asks for them.

Rules: for the thread of a recorder alone. What is older than `seconds` goes, and what is more than
`memory` bytes: that is no loss. A trigger looks at the messages of a port, and fires when one
matches and the one before it did not.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Mapping, Sequence
from typing import Any, Final

from yarpy.data.bottle import Bottle
from yarpy.errors import LocalProtocolError, YarpError
from yarpy.kits.record.envelope import SECOND
from yarpy.kits.record.following import compiled
from yarpy.kits.record.intake import Taken
from yarpy.wire.message import DATA, Message

LONGEST: Final = 1 << 16  # bytes of a message that a trigger looks at
_NOTES: Final = 1000


class Backlog:
    """Keeps messages and notes. triggers: regular expressions by ports, searched for in the text
    of their messages. Raises LocalProtocolError for what is none."""

    def __init__(self, seconds: float, memory: int, triggers: Mapping[str, str]) -> None:
        self._keep = round(seconds * SECOND)
        self._memory = memory
        self._taken: deque[Taken] = deque()
        self._notes: deque[tuple[Mapping[str, Any], int]] = deque(maxlen=_NOTES)
        self._triggers: dict[str, re.Pattern[str]] = {}
        for port, text in triggers.items():
            pattern = compiled(text)
            if pattern is None:
                raise LocalProtocolError(f"the trigger of {port} is empty: {port}=fall")
            self._triggers[port] = pattern
        self._fired: set[str] = set()
        self.held = 0  # bytes

    def add(self, taken: Taken) -> bool:
        """Keep a message; return whether it is one that was waited for."""
        self._taken.append(taken)
        self.held += taken.size
        self._forget(taken.received_ns)
        return taken.port in self._triggers and self._fires(taken)

    def _forget(self, now: int) -> None:
        taken = self._taken
        while taken and (
            self.held > self._memory or not 0 <= now - taken[0].received_ns <= self._keep
        ):
            self.held -= taken.popleft().size

    def _fires(self, taken: Taken) -> bool:
        if len(taken.payload) > LONGEST:
            return False
        try:
            text = Message(DATA, taken.payload, "").as_(Bottle).to_text()
        except YarpError:
            return False
        before = taken.port in self._fired
        if self._triggers[taken.port].search(text) is None:
            self._fired.discard(taken.port)
            return False
        self._fired.add(taken.port)
        return not before

    def note(self, what: Mapping[str, Any], received: int) -> None:
        """Keep a note."""
        self._notes.append((what, received))

    def drain(self, now: int) -> tuple[Sequence[Taken], Sequence[tuple[Mapping[str, Any], int]]]:
        """Return the messages and notes of the last seconds, which go."""
        self._forget(now)
        first = now - self._keep
        taken = [*self._taken]
        notes = [(what, moment) for what, moment in self._notes if moment >= first]
        self._taken.clear()
        self._notes.clear()
        self.held = 0
        return taken, notes
