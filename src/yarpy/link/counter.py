"""Counters: how one link is doing, always on, and the totals of links that have ended.

Rules: cheap enough to update for every message; no locks (one thread at a time carries a link's
messages, readers may see a number that is one message old). Times in seconds. When a link has
ended, its counter is kept, not the link, which holds on to buffers.
"""

from __future__ import annotations

import time
from dataclasses import asdict, dataclass
from typing import Final

_SMOOTHING = 1 / 16  # the gain RFC 3550 uses for jitter
SUMMED: Final = ("messages", "bytes", "replaced", "drops", "unconfirmed")
KEEP: Final = 64  # counters of ended links, which may still change a little


@dataclass(slots=True)
class Counter:
    """`messages` and `bytes` carried, `replaced` (messages that gave way to newer ones, where the
    newest wins), `drops` (messages that this side lost, or a monitor dropped), `unconfirmed` (on
    their way when the connection broke: some may have arrived), and timing. No message is in two of
    these.

    `period` is the smoothed time between messages, `jitter` the smoothed change of it (as RFC 3550
    does it), `latency` the smoothed time from sending to the reply or acknowledgement. Seconds;
    0.0 means not measured yet.
    """

    messages: int = 0
    bytes: int = 0
    replaced: int = 0
    drops: int = 0
    unconfirmed: int = 0
    period: float = 0.0
    jitter: float = 0.0
    latency: float = 0.0
    since: float = 0.0
    last: float = 0.0

    def count(self, now: float, more: int = 1, together: int = 1) -> None:
        """Count a message at time `now` (time.perf_counter); 0 `more`: it is counted already.
        `together`: so many came at once."""
        self.messages += more
        gap = (now - self.last) / together
        if self.messages > 2:
            change = gap - self.period
            self.period += change * _SMOOTHING
            self.jitter += ((change if change > 0.0 else -change) - self.jitter) * _SMOOTHING
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


class _State:
    """The sums, and the last counters with drops that these do not include.

    An object, not a tuple: compiled code keeps a tuple as a plain value, which is never the same.
    """

    __slots__ = ("last", "sums")

    def __init__(self, sums: tuple[int, ...], last: tuple[tuple[Counter, int], ...]) -> None:
        self.sums = sums
        self.last = last


class Past:
    """Sums of the counts in SUMMED over connections that have ended.

    The last counters may still change, when what waited unread is dropped later; older ones are
    added up for good. Whoever adds holds the lock of the connections; whoever looks holds none,
    since a signal handler above may need that one.
    """

    def __init__(self) -> None:
        self._state = _State((0,) * len(SUMMED), ())  # replaced as one

    def add(self, counter: Counter, lost: int = 0) -> None:
        """A connection has ended; `lost` are drops that its counter does not include. Once is
        enough."""
        while True:
            state = self._state
            sums, last = state.sums, state.last
            if any(one is counter for one, _ in last):
                return
            last = (*last, (counter, lost))
            if len(last) > KEEP:
                sums, last = _sum(sums, *last[0]), last[1:]
            replaced = _State(sums, last)
            if self._state is state:  # else a signal handler has added another one meanwhile
                self._state = replaced
                return

    def as_dict(self) -> dict[str, int]:
        """The sums by name."""
        state = self._state
        sums = state.sums
        for counter, lost in state.last:
            sums = _sum(sums, counter, lost)
        return dict(zip(SUMMED, sums, strict=True))


def _sum(sums: tuple[int, ...], counter: Counter, lost: int) -> tuple[int, ...]:
    found = [before + getattr(counter, key) for before, key in zip(sums, SUMMED, strict=True)]
    found[SUMMED.index("drops")] += lost
    return tuple(found)
