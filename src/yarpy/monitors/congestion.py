"""Congestion control for whole messages: how many bytes the next one may have.

Rules: pure; the caller passes times and sizes. Messages leave one at a time, and each tells how
long it was under way until it was confirmed. That is to stay below a goal, so the budget is what
crosses within it: AIMD driven by the delay of acknowledgements. The goal is kept in the manner of
SCReAM (RFC 8298) and LEDBAT (RFC 6817); how fast the rate falls and grows is GCC's (Carlucci et
al., Analysis and Design of the Google Congestion Control for WebRTC, 2016): too late, and it falls
to 0.85 of what was measured; in time, and it grows by a factor, but slowly near the rate at which
it was too much the last time. A single late message, for which a processor may be to blame, changes
nothing unless it is very late, and then it costs half the rate at most.
"""

from __future__ import annotations

from math import inf
from typing import Final

BETA: Final = 0.85  # of the measured rate is left when a message was late
EARLY: Final = 0.85  # of the goal: below that there is room to grow
ROOMY: Final = 0.5  # of the goal: below that there is much room
VERY_LATE: Final = 2.0  # times the goal
DOUBLING: Final = 0.5  # seconds in which the rate doubles, far from where it was too much
CAREFUL: Final = 0.1  # of that rate, which is added in each second near it
NEAR: Final = (0.75, 1.1)  # times the rate at which it was too much
AHEAD: Final = 1.5  # times what was measured: no faster than that without having tried
LEAST: Final = 1000.0  # bytes per second
_PAUSE: Final = 1.0  # seconds: as much as one step may count for


class Congestion:
    """Of one connection. `rate` in bytes per second; infinite as long as nothing was too late."""

    def __init__(self) -> None:
        self.rate = inf
        self.delay = 0.0  # seconds, smoothed
        self._brink = 0.0  # the rate measured when it was too much last
        self._last = 0.0
        self._late = 0  # messages in a row

    def budget(self, goal: float) -> float:
        """Bytes that a message may have to be confirmed within `goal` seconds."""
        return self.rate * goal

    def confirmed(self, size: int, seconds: float, goal: float, now: float) -> None:
        """A message of `size` bytes took `seconds`, and should have taken `goal` at most."""
        seconds = max(seconds, 1e-6)
        passed = min(max(now - self._last, 0.0), _PAUSE)
        self._last = now
        self.delay = seconds if not self.delay else self.delay + (seconds - self.delay) / 4
        measured = max(size / seconds, LEAST)
        if seconds > goal:
            self._late += 1
            self._fall(measured, seconds > VERY_LATE * goal)
            return
        self._late = 0
        if self.rate < inf and seconds < EARLY * goal:
            self._grow(measured, passed, seconds < ROOMY * goal)

    def _fall(self, measured: float, very_late: bool) -> None:
        if self._late > 1:
            self._brink = measured
        elif not very_late:
            return
        least = self.rate / 2 if self.rate < inf else 0.0
        self.rate = max(LEAST, least, BETA * min(self.rate, measured))

    def _grow(self, measured: float, passed: float, roomy: bool) -> None:
        low, high = NEAR
        if not roomy and low * self._brink < self.rate < high * self._brink:
            grown = self.rate + CAREFUL * self._brink * passed
        else:
            grown = self.rate * 2 ** (passed / DOUBLING)
        self.rate = max(self.rate, min(grown, AHEAD * measured))
