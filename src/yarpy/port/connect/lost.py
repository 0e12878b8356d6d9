"""Lost: a connection that failed and shall come back.

Rules: each pause between two attempts is longer than the one before, by chance, so that the ports
of a robot do not all dial at once. What its log says is said once for each reason.
"""

from __future__ import annotations

import random
import time
from dataclasses import dataclass, field
from typing import Final

from yarpy.errors import YarpError
from yarpy.link.begin.handshake import find_carrier
from yarpy.log import logger
from yarpy.port.hub import Hub
from yarpy.route import Route

log = logger("yarpy.port")

TICK: Final = 0.1  # seconds until the first attempt
CALM: Final = 0.5  # seconds for a sender that is back to dial by itself
LONGEST: Final = 30.0  # seconds between attempts at something that stays away
SILENCE: Final = (
    1.0  # seconds for a first answer; a dead host gives none, and its name may be elsewhere
)
SLOWER: Final = 1.3  # so much longer is each pause than the one before, and up to so much by chance

_chance = random.Random()  # the numbers of `random` itself are the program's, which may have a seed


@dataclass(slots=True, eq=False)
class Lost:
    """A connection that failed."""

    hub: Hub
    route: Route
    incoming: bool
    # On Windows time.monotonic goes on every 15 ms, which would not tell what was first.
    since: float = field(default_factory=time.perf_counter)
    pause: float = TICK
    due: float = 0.0
    timeout: float = SILENCE  # twice as long after each one: a port that is alive may be slow
    seen_gone: bool = False
    back: float | None = None  # when its sender was seen again
    told: str = ""  # what was logged last: each reason is told once, not at every attempt

    def put_off(self, now: float) -> None:
        """Another attempt later; each pause is longer than the one before, but when a sender is
        back."""
        if self.back is not None and self.back + CALM > now:
            self.due = self.back + CALM
            return
        self.due = now + self.pause * _chance.uniform(1.0, SLOWER)
        self.pause = min(self.pause * SLOWER, max(self.pause, LONGEST))

    def tell(self, reason: YarpError, then: str) -> None:
        """Log why it does not come back, and what happens `then`."""
        if str(reason) != self.told:
            self.told = str(reason)
            way = "from" if self.incoming else "to"
            log.warning(
                "%s: no connection %s %s: %s; %s", self.hub.name, way, self.peer, reason, then
            )

    def is_calm(self, now: float) -> bool:
        """Return whether the sender of an input, which answers, has had time to dial by itself."""
        if self.back is None:
            self.back = now if self.seen_gone else self.since
        return now - self.back >= CALM

    @property
    def peer(self) -> str:
        """The name of the other end."""
        return self.route.source if self.incoming else self.route.target

    def is_there(self) -> bool:
        """Return whether there is such a connection already."""
        if self.incoming:
            return any(link.route.source == self.peer for link in self.hub.inputs.links)
        return any(link.route.target == self.peer for link in self.hub.outputs.links)


def is_pulled(route: Route) -> bool:
    """Return whether the receiver of such a connection is the one that dials."""
    return not find_carrier(route.spec).push
