"""Confirmation: what is known of messages that their receiver does not acknowledge.

Rules: there are two witnesses. A receiver of yarpy says how many came when it is asked, now and
then (one of C++ only that it lives); what had left a whole question earlier and has not come by
then never will. And the system knows which bytes it has never handed to the peer's. Messages of
which neither says anything when the connection breaks are `unconfirmed`: they may have arrived.
"""

from __future__ import annotations

from bisect import bisect_right
from collections import deque
from dataclasses import dataclass
from typing import Final

RECENT: Final = 1024  # messages whose place in the stream of bytes is remembered


@dataclass(frozen=True, slots=True)
class Outcome:
    """The outcome of messages: how many are known to have arrived or to be lost; the rest is
    open."""

    came: int
    lost: int
    open: int


class Confirmation:
    """The messages of one connection, numbered as they leave.

    `witness`: whether the receiver is asked, so that its silence means something.
    """

    def __init__(self, witness: bool = False) -> None:
        self.witness = witness
        # Where each of the last messages ended, in bytes of the connection. The sender appends.
        self.ends: deque[int] = deque(maxlen=RECENT)
        self._came = 0
        self._asked = 0  # how many had left when the receiver was asked last
        self._settled = 0  # ... and the time before

    def recall(self, count: int) -> None:
        """The last `count` messages never left."""
        for _ in range(min(count, len(self.ends))):
            self.ends.pop()

    def told(self, left: int, came: int) -> None:
        """The receiver was asked when `left` messages had left: `came` have come, or were counted
        as lost over there."""
        self._settled = min(self._asked, left)
        self._asked = left
        self._came = came

    def outcome(self, left: int, in_order: bool) -> Outcome:
        """Of `left` messages, by what the receiver says; all came if nobody can ask it.

        `in_order`: what has not come waits for the one before it, as in a stream; else it is lost.
        """
        if not self.witness:
            return Outcome(left, 0, 0)
        came = min(self._came, left)
        lost = 0 if in_order else max(0, min(self._settled, left) - came)
        return Outcome(came, lost, left - came - lost)

    def end(self, left: int, taken: int) -> Outcome:
        """Of `left` messages in a stream that has ended, when the peer's system had confirmed
        `taken` bytes, whether or not its program has read them."""
        came = min(self.outcome(left, True).came, left - self._behind(left, taken))
        return Outcome(came, 0, left - came)

    def _behind(self, left: int, taken: int) -> int:
        """Return how many of `left` messages do not end within so many bytes."""
        ends = self.ends
        behind = len(ends) - bisect_right(ends, taken)
        if ends and behind == len(ends) < left:  # further back than we remember: by their size
            size = max(1, (ends[-1] - ends[0]) // max(1, len(ends) - 1))
            behind += max(0, ends[0] - taken - 1) // size
        return min(behind, left)
