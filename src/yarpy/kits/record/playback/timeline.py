"""The time of a player: which moment of a recording it is, and when a message is due.

Rules: pure; the clock is given, in seconds of a clock that is never set. Each change of rate, each
pause and each jump begins anew from the exact moment, so that nothing adds up.
"""

from __future__ import annotations

from typing import Final

SECOND: Final = 1_000_000_000  # nanoseconds


class Timeline:
    """Moments are nanoseconds of the recording; `rate` 2 plays twice as fast."""

    def __init__(self, moment: int, rate: float = 1.0) -> None:
        self._moment = moment
        self._clock: float | None = None  # when that moment was; None while it stands still
        self.rate = rate

    @property
    def running(self) -> bool:
        """Return whether time goes on."""
        return self._clock is not None

    def moment(self, clock: float) -> int:
        """Return which moment it is."""
        if self._clock is None:
            return self._moment
        return self._moment + round((clock - self._clock) * self.rate * SECOND)

    def due(self, moment: int) -> float:
        """Return when a moment comes, by the clock; only while time goes on."""
        assert self._clock is not None
        return self._clock + (moment - self._moment) / SECOND / self.rate

    def start(self, clock: float) -> None:
        """Let time go on."""
        if self._clock is None:
            self._clock = clock

    def stop(self, clock: float) -> None:
        """Let time stand still."""
        self._moment = self.moment(clock)
        self._clock = None

    def jump(self, moment: int, clock: float) -> None:
        """Set the moment that it is now."""
        self._moment = moment
        if self._clock is not None:
            self._clock = clock

    def pace(self, rate: float, clock: float) -> None:
        """Go on at another rate from now on."""
        self.jump(self.moment(clock), clock)
        self.rate = rate
