"""How long a reader may keep its writer waiting, and how far a message has got by then.

Rules: times are those of `time.monotonic`; a deadline of None never comes, 0.0 is always over. One
limit counts from when the reader began to take nothing, whatever its writers do meanwhile.
"""

from __future__ import annotations

import time
from enum import Enum, auto
from typing import Final

STRANGERS: Final = 10.0  # seconds for a reader that dialled us


class Sent(Enum):
    """How much of a message has left, or is about to."""

    NOTHING = auto()
    PART = auto()  # the rest has to follow before anything else
    ALL = auto()


# Looking a member up in its class takes a while.
NOTHING: Final = Sent.NOTHING
PART: Final = Sent.PART
ALL: Final = Sent.ALL


class WriteTimeout:
    """Of one reader. `limit` in seconds; None: as long as it likes."""

    def __init__(self, limit: float | None = None) -> None:
        self.limit = limit
        self._since = 0.0  # when it began to keep us waiting

    def until(self, deadline: float | None) -> float | None:
        """Until when to wait, if the writer itself waits until `deadline`."""
        if self.limit is None:
            return deadline
        self._since = self._since or time.monotonic()
        own = self._since + self.limit
        return own if deadline is None else min(deadline, own)

    def over(self, took: bool) -> bool:
        """Whether the limit is over, now that the reader took everything or did not."""
        if self.limit is None:
            return False
        if took:
            self._since = 0.0
        return not took and time.monotonic() >= self._since + self.limit
