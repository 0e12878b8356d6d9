"""Notice that the system's clock was set while a recorder runs.

Rules: it is compared with the clock that nobody sets. Half a second and less is no step: services
of time move a clock by so little.
"""

from __future__ import annotations

import time
from typing import Final

STEP: Final = 0.5  # seconds


class SystemClock:
    """The system's clock since the last look at it."""

    def __init__(self) -> None:
        self._ahead = _ahead()

    def look(self) -> float:
        """Return by how many seconds it was set since the last look, 0.0 if it was not."""
        before, self._ahead = self._ahead, _ahead()
        seconds = (self._ahead - before) / 1e9
        return seconds if abs(seconds) > STEP else 0.0


def _ahead() -> int:
    """Return by how many nanoseconds it is ahead of the monotonic clock."""
    return time.time_ns() - time.monotonic_ns()
