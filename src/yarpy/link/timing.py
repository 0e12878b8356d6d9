"""Timing: whether the messages of one connection come in time, and as often as they should.

Rules: a connection without a deadline has none of this and pays nothing. At the receiver it sees
each message before the monitors do. A message with a stamp is late if it is older than `deadline`
seconds when it arrives, as far as the stamp is a time of day; clocks of two computers must agree
for that. One without a stamp is late if it comes more than `deadline` seconds after it was due,
which is a period of `rate` after the one before, and at once where there is no rate. Each late
message, and each silence, counts once.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, Final, NamedTuple

from yarpy.data.stamp import Stamp
from yarpy.errors import DecodeError
from yarpy.monitors.chain import Chain
from yarpy.qos import Qos
from yarpy.wire.message import Message, Packet

DAYTIME: Final = 1e9  # seconds; smaller stamps count from some start
OLDEST: Final = 3600.0  # a message that is older is played back


class Timing:
    """The deadline and rate expected of a connection, and how well it keeps them. Seconds, and
    messages per second.

    `missed` messages were late or did not come when they should; `late` of these were dropped for
    it; `worst` is the longest delay beyond the deadline; `missing` messages did not come at all, as
    far as the rate says. `tell(lateness, silent)` is called for each miss.
    """

    def __init__(
        self,
        qos: Qos,
        tell: Callable[[float, bool], None] | None = None,
        clock: Callable[[], float] = time.time,
        monotonic: Callable[[], float] = time.monotonic,
    ) -> None:
        self.wanted = qos
        self.deadline = qos.deadline
        self.rate = qos.rate
        self.drops = qos.late == "drop"
        self.missed = self.late = self.missing = 0
        self.worst = 0.0
        self._tell = tell
        self._clock, self._monotonic = clock, monotonic
        self._last = monotonic()
        self._silent = False  # this silence was counted

    @property
    def gap(self) -> float | None:
        """The longest pause between two messages, None if any will do."""
        if self.rate:
            return 1 / self.rate + (1 / self.rate if self.deadline is None else self.deadline)
        return self.deadline

    @property
    def due(self) -> float:
        """The time when the next message must have come (time.monotonic)."""
        gap = self.gap if self.rate else None
        return float("inf") if gap is None or self._silent else self._last + gap

    def accept(self, message: Message) -> bool:
        """A message has come: False if it is to be dropped."""
        now = self._monotonic()
        pause, self._last = now - self._last, now
        if self.rate:
            self.missing += max(int(pause * self.rate + 0.5) - 1, 0)
        told, self._silent = self._silent, False
        age = age_of(message.envelope, self._clock) if self.deadline is not None else None
        if age is not None and self.deadline is not None:
            late = age - self.deadline
        else:
            gap = self.gap
            late = 0.0 if gap is None else pause - gap
        if late <= 0.0:
            return True
        if age is not None or not told:
            self._miss(late, silent=False)
        else:
            self.worst = max(self.worst, late)
        if age is None or not self.drops:
            return True  # the first one after a pause is news
        self.late += 1
        return False

    def look(self) -> None:
        """Nothing may have come for too long: count that, once."""
        late = self._monotonic() - self.due
        if late > 0.0:
            self._silent = True
            self._miss(late, silent=True)

    def _miss(self, late: float, silent: bool) -> None:
        self.missed += 1
        self.worst = max(self.worst, late)
        if self._tell is not None:
            self._tell(late, silent)

    def as_dict(self) -> dict[str, Any]:
        """Return what is expected, and how it went until now."""
        self.look()
        found: dict[str, Any] = {}
        if self.deadline is not None:
            found["deadline"] = self.deadline
        if self.rate is not None:
            found["rate"] = self.rate
        if self.drops:
            found["late"] = "drop"
        return {
            **found,
            "missed": self.missed,
            "dropped": self.late,
            "missing": self.missing,
            "worst": self.worst,
        }


def age_of(envelope: str, clock: Callable[[], float] = time.time) -> float | None:
    """Return the age of a message by its stamp; None if it has none, or that is no time of day."""
    if not envelope:
        return None
    try:
        made = Stamp.from_text(envelope).time
    except DecodeError:
        return None
    if not made >= DAYTIME:
        return None
    age = clock() - made
    return age if age < OLDEST else None


class Dated(NamedTuple):
    """A packet in a queue, and when it is too late for it (time.monotonic)."""

    packet: Packet
    due: float


def expected(before: Qos | None, wanted: Qos) -> Qos:
    """Return the QoS that is expected of a connection from now on; what is None in `wanted` stays,
    0 ends it."""
    before = before or Qos()
    deadline = before.deadline if wanted.deadline is None else wanted.deadline
    rate = before.rate if wanted.rate is None else wanted.rate
    late = "drop" if (wanted.late or before.late) == "drop" else None
    return Qos(deadline=deadline or None, rate=rate or None, late=late)


def chain_of(timing: Timing, where: str) -> Chain:
    """A chain that has it in front."""
    return Chain([timing], where)
