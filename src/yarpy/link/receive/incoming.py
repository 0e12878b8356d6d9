"""Incoming: the message that a connection is receiving: its progress, and the memory it takes.

Rules: a connection may be silent for ever between two messages, but not inside of one. What has
come of a message is what it holds, since buffers grow with what comes; beyond FREE bytes it is
taken from the port's budget. Messages that come at once cost nothing here, and of a stream of large
ones the first alone asks the budget.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final

from yarpy.errors import RemoteProtocolError

if TYPE_CHECKING:
    from collections.abc import Callable

    from yarpy.link.receive.budget import Budget

FREE: Final = 1 << 16  # bytes that are not counted, as every connection has a buffer of that size
LEAST: Final = 60_000  # bytes that must come in each window of time
WINDOW: Final = 2  # its length, as a multiple of the silence that is allowed


class Incoming:
    """The progress of the message that one connection is receiving. `silence`: seconds without a
    byte that are let be.

    end: wakes the connection's thread for its end. forget: gives back memory that is kept for the
    next message.
    """

    def __init__(
        self, silence: float | None, end: Callable[[], None], forget: Callable[[], None]
    ) -> None:
        self.silence = silence
        self.budget: Budget | None = None
        self.forget = forget
        self.held = 0  # bytes that the budget counts, of this message or kept from the last one
        self.since = 0.0  # when the message began; 0: none has
        self.reason = ""  # why it came to its end before it was whole
        self._end = end
        self._window = float("inf") if silence is None else WINDOW * silence
        self._seen = 0  # bytes of it, and when the last of them came
        self._heard = 0.0
        self._window_from = 0  # where it was when the present window of time began
        self._window_since = 0.0

    def advance(self, size: int) -> None:
        """`size` bytes of the message have come, and it needs more. Raises RemoteProtocolError."""
        if self.reason:
            raise RemoteProtocolError(self.reason)
        now = time.monotonic()
        if not self.since:
            self.since = self._window_since = now
            self._window_from = self._seen = 0
        if size != self._seen:
            self._seen = size
            self._heard = now
        if size > self.held and size > FREE and self.budget is not None:
            self.budget.take(self, 2 * size)
            if self.reason:
                raise RemoteProtocolError(self.reason)
        if now - self._window_since > self._window:
            if size - self._window_from < LEAST:
                rate = (size - self._window_from) / (now - self._window_since)
                self._fail(f"a message that has begun comes at {rate:.3g} bytes per second")
            self._window_since, self._window_from = now, size

    def wait(self) -> None:
        """A wait for more of the message was in vain. Raises RemoteProtocolError after too many."""
        if self.silence is not None and time.monotonic() - self._heard > 0.99 * self.silence:
            self._fail(f"nothing has come for {self.silence:g} s in the middle of a message")

    def finish(self) -> None:
        """The message is whole, or none is under way."""
        self.since = 0.0

    def end(self, reason: str) -> None:
        """End the connection, for a reason that is to be logged. Any thread may call."""
        self.reason = reason
        self._end()

    def leave(self) -> None:
        """The connection has ended: nothing is held any more."""
        if self.budget is not None:
            self.budget.give_back(self)

    def _fail(self, reason: str) -> None:
        self.reason = reason
        raise RemoteProtocolError(reason)
