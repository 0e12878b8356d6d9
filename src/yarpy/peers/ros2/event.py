"""The events of QoS, as rclpy calls them: what happens to the promises of a topic.

    incompatible_qos      somebody is kept out; `policy` says by what
    deadline_missed       nothing was published, or came, for longer than agreed
    liveliness_lost       we did not say in time that we are alive
    liveliness_changed    of those whom we hear one is alive, or no longer is; `times` are
    message_lost          messages went by

Rules: an endpoint counts its events; `hear`, if there is one, is called in a thread of the
middleware, or in the one that reads. Over Zenoh nobody is kept out, and of all these only what is
lost is known.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import Final, NamedTuple

from yarpy.log import log_failure, logger
from yarpy.monitors.base import FAILURES

log = logger("yarpy.ros2")

INCOMPATIBLE: Final = "incompatible_qos"
DEADLINE: Final = "deadline_missed"
LOST: Final = "liveliness_lost"
CHANGED: Final = "liveliness_changed"
MESSAGE: Final = "message_lost"


class Event(NamedTuple):
    """`times`: how often it happened since the last one; how many are alive of
    liveliness_changed."""

    kind: str
    times: int
    policy: str = ""


class Events:
    """Of an endpoint: how often each kind happened, and who wants to hear of it."""

    def __init__(self) -> None:
        self.counts: Counter[str] = Counter()
        self.hear: Callable[[Event], object] | None = None

    def tell(self, event: Event) -> None:
        """Something happened."""
        self.counts[event.kind] += 1 if event.kind == CHANGED else event.times
        hear = self.hear
        if hear is not None:
            try:
                hear(event)
            except FAILURES as error:
                log_failure(log, error, "what hears of %s failed", event.kind)
