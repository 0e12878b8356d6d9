"""Counters: how one link is doing, always on.

Rules: cheap enough to update for every message; no locks (one thread at a time carries a link's
messages, readers may see a number that is one message old). Times in seconds.
"""

from __future__ import annotations

import time
from dataclasses import asdict, dataclass

_SMOOTHING = 1 / 16  # the gain RFC 3550 uses for jitter


@dataclass(slots=True)
class Counter:
    """`messages` and `bytes` carried, `drops` (messages this side did not pass on), and timing.

    `period` is the smoothed time between messages, `jitter` the smoothed change of it (as RFC 3550
    does it), `latency` the smoothed time from sending to the reply or acknowledgement. Seconds;
    0.0 means not measured yet.
    """

    messages: int = 0
    bytes: int = 0
    drops: int = 0
    period: float = 0.0
    jitter: float = 0.0
    latency: float = 0.0
    since: float = 0.0
    last: float = 0.0

    def count(self, now: float) -> None:
        """One more message at time `now` (time.perf_counter)."""
        self.messages += 1
        gap = now - self.last
        if self.messages > 2:
            change = gap - self.period
            self.period += change * _SMOOTHING
            self.jitter += (abs(change) - self.jitter) * _SMOOTHING
        elif self.messages == 2:
            self.period = gap
        self.last = now

    def measure(self, latency: float) -> None:
        """The answer to a message took `latency` seconds."""
        if self.latency:
            self.latency += (latency - self.latency) * _SMOOTHING
        else:
            self.latency = latency

    @property
    def rate(self) -> float:
        """Messages per second now; falls towards 0 once they stop coming."""
        if not self.period:
            return 0.0
        quiet = time.perf_counter() - self.last
        return 1.0 / max(self.period, quiet if quiet > 2 * self.period else 0.0)

    def as_dict(self) -> dict[str, float]:
        """All numbers by name, with `rate`."""
        found = asdict(self)
        del found["last"]
        return {**found, "rate": self.rate}
