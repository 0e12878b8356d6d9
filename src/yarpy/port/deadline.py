"""Deadlines as a program sees them: an event for each that was missed, and who looks for silence.

Rules: a message that comes late is noticed when it comes. That none comes is noticed by a thread of
the port, which only ports have whose program wants to hear of it.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Final

from yarpy.link.receive.inbound import Inbound
from yarpy.scope import Flag
from yarpy.threads import Thread

SHORTEST: Final = 0.002  # seconds between two looks
LONGEST: Final = 0.5


@dataclass(frozen=True, slots=True)
class DeadlineEvent:
    """A message from `source` came `lateness` seconds after its deadline; or (`silent`) none has
    come, that many seconds after it should have. `missed`: how many deadlines were, so far."""

    source: str
    target: str
    carrier: str
    lateness: float
    missed: int
    silent: bool = False

    def __str__(self) -> str:
        what = "nothing came" if self.silent else "a message came late"
        late = f"{self.lateness * 1e3:.1f} ms after the deadline"
        return f"{what} from {self.source} to {self.target}: {late} (missed: {self.missed})"


class Watch:
    """Looks for silence on the connections that `inputs` gives, until `stop`."""

    def __init__(self, name: str, inputs: Callable[[], Iterable[Inbound]]) -> None:
        self._inputs = inputs
        self._stopped = Flag()
        thread = Thread(target=self._run, name=f"yarpy deadlines {name}", daemon=True)
        thread.start()

    def stop(self) -> None:
        """Look no more."""
        self._stopped.set()

    def _run(self) -> None:
        pause = 0.0
        while not self._stopped.wait(pause):
            due = [link.timing for link in self._inputs() if link.timing is not None]
            for timing in due:
                timing.look()
            left = min((timing.due for timing in due), default=float("inf")) - time.monotonic()
            pause = min(max(left, SHORTEST), LONGEST)
