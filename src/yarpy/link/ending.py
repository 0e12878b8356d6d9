"""Ending: how `interrupt()` and `close()` of a port end whatever waits in it.

Rules: nothing waits in one piece. Who waits for a lock, a condition, bytes or room waits SLICE
seconds at a time and then asks the port's Ending whether to go on; for an ended port every time
limit is over, as it is in a call whose `scope` was ended or has no time left. So a wait ends within
SLICE, whoever ends it (another thread, a signal handler, a callback), on every system, and needs no
descriptor to be woken by. A lock that the frame beneath a signal handler, or beneath a callback,
may hold is an RLock: its `_is_owned` tells, and then nobody waits for it. Time limits are moments
of `time.monotonic`, made once from a caller's `timeout` by `moment`; None: no limit.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Final, Protocol

from yarpy import scope
from yarpy.errors import PortClosed

SLICE: Final = 0.02  # seconds of one wait
NOW: Final = 0.0  # a moment that has always come: nothing is waited for


class Lockable(Protocol):
    """A lock of the threading module."""

    def acquire(self, blocking: bool = True, timeout: float = -1) -> bool: ...


class Ending:
    """The flag that says whether operations of one port may go on waiting. `reason`: why not;
    empty: they may."""

    __slots__ = ("reason",)

    def __init__(self) -> None:
        self.reason = ""

    def begin(self, reason: str) -> None:
        """End every wait, and those to come, with PortClosed(reason). Any thread, any time."""
        self.reason = reason

    def resume(self) -> None:
        """Let operations wait again."""
        self.reason = ""

    def check(self) -> None:
        """Raise PortClosed if the port has ended, or the call under way."""
        reason = self.reason or scope.ended()
        if reason:
            raise PortClosed(reason)

    def slice(self, until: float | None) -> float:
        """Return the seconds of the next wait; 0.0 if `until` has come, or the port or the call
        under way has ended."""
        if self.reason or scope.ended():
            return 0.0
        until = scope.until(until)
        if until is None:
            return SLICE
        return max(0.0, min(SLICE, until - time.monotonic()))

    def acquire(self, lock: Lockable, until: float | None = None) -> bool:
        """Take a lock; return False if `until` comes first, or the port ends."""
        while not lock.acquire(False):
            wait = self.slice(until)
            if not wait:
                return False
            if lock.acquire(timeout=wait):
                return True
        return True

    def wait_for(
        self, condition: threading.Condition, true: Callable[[], bool], until: float | None = None
    ) -> bool:
        """Wait, under the condition's lock, until `true()`; False if `until` comes first, or the
        port ends."""
        while not true():
            wait = self.slice(until)
            if not wait:
                return False
            condition.wait(wait)
        return True


#: Of what nobody waits for in person, such as a connection's own thread.
NEVER: Final = Ending()


def moment(timeout: float | None) -> float | None:
    """Return the moment of `time.monotonic` that is `timeout` seconds away; None: no limit."""
    return None if timeout is None else time.monotonic() + timeout


def left(until: float | None) -> float | None:
    """Return the seconds until that moment, at least 0.0; None: no limit."""
    return None if until is None else max(0.0, until - time.monotonic())
