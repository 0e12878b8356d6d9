"""Past: what the connections of a port that are over have carried, in sum.

Rules: counters are kept, not links, which hold on to buffers; they may still change a little, when
what waited unread is dropped later. Old ones are added up for good.
"""

from __future__ import annotations

import threading
from collections import deque
from typing import Final

from yarpy.link.counter import Counter

KEEP: Final = 64  # counters that may still change


class Past:
    """Sums of `messages`, `bytes` and `drops`."""

    def __init__(self) -> None:
        self._sums = [0, 0, 0]
        self._last: deque[tuple[Counter, int]] = deque()
        self._lock = threading.Lock()  # connections end in threads of their own

    def add(self, counter: Counter, lost: int = 0) -> None:
        """A connection is over; `lost` are drops that its counter does not know."""
        with self._lock:
            self._last.append((counter, lost))
            if len(self._last) > KEEP:
                self._sums = _sum(self._sums, *self._last.popleft())

    def as_dict(self) -> dict[str, int]:
        """The sums by name."""
        with self._lock:
            sums = self._sums
            for counter, lost in self._last:
                sums = _sum(sums, counter, lost)
        return dict(zip(("messages", "bytes", "drops"), sums, strict=True))


def _sum(sums: list[int], counter: Counter, lost: int) -> list[int]:
    messages, size, drops = sums
    return [messages + counter.messages, size + counter.bytes, drops + counter.drops + lost]
