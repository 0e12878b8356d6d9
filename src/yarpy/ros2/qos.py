"""What topics promise: the QoS of ROS 2, and the text that stands for it in tokens.

    ::,10:,:,:,,      reliable, volatile, the last ten      2::,5:,:,:,,      sensor data
    :1:,1:,:,:,,      transient local: who comes late gets the last message

Rules: each number that is usual is left out of the text. Zenoh connects whatever there is: nothing
of this stops data, but it says how much is kept, and who waits for whom.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

from yarpy.errors import AddressError, DecodeError

RELIABLE: Final = 1
BEST_EFFORT: Final = 2
TRANSIENT_LOCAL: Final = 1
VOLATILE: Final = 2
KEEP_LAST: Final = 1
KEEP_ALL: Final = 2
DEPTH: Final = 42  # what no text stands for
FOREVER: Final = (9223372036, 854775807)  # seconds, nanoseconds

MOST_KEPT: Final = 10_000  # messages that we keep, whatever somebody says

_NUMBER: Final = r"(\d{0,20})"
_TEXT = re.compile(
    rf"{_NUMBER}:{_NUMBER}:{_NUMBER},{_NUMBER}:{_NUMBER},{_NUMBER}"
    rf":{_NUMBER},{_NUMBER}:{_NUMBER},{_NUMBER},{_NUMBER}"
)


@dataclass(frozen=True, slots=True)
class Qos:
    """The numbers of rmw; durations are pairs of seconds and nanoseconds."""

    reliability: int = RELIABLE
    durability: int = VOLATILE
    history: int = KEEP_LAST
    depth: int = 10
    deadline: tuple[int, int] = FOREVER
    lifespan: tuple[int, int] = FOREVER
    liveliness: int = 1
    lease: tuple[int, int] = FOREVER

    @property
    def reliable(self) -> bool:
        return self.reliability != BEST_EFFORT

    @property
    def latched(self) -> bool:
        """Whether who comes late gets what was said before."""
        return self.durability == TRANSIENT_LOCAL

    @property
    def kept(self) -> int:
        """How many messages are kept."""
        return MOST_KEPT if self.history == KEEP_ALL else max(1, min(self.depth, MOST_KEPT))

    def __str__(self) -> str:
        rows = (
            ((self.reliability, RELIABLE),),
            ((self.durability, VOLATILE),),
            ((self.history, KEEP_LAST), (self.depth or DEPTH, DEPTH)),
            _pairs(self.deadline),
            _pairs(self.lifespan),
            ((self.liveliness, 1), *_pairs(self.lease)),
        )
        return ":".join(
            ",".join("" if value == usual else str(value) for value, usual in row) for row in rows
        )


def _pairs(duration: tuple[int, int]) -> tuple[tuple[int, int], ...]:
    return tuple(zip(duration, FOREVER, strict=True))


def parse_qos(text: str) -> Qos:
    """What such a text says. Raises DecodeError."""
    found = _TEXT.fullmatch(text)
    if found is None:
        raise DecodeError(f"{text[:80]!r} is no QoS of ROS 2")
    usual = (RELIABLE, VOLATILE, KEEP_LAST, DEPTH, *FOREVER, *FOREVER, 1, *FOREVER)
    n = [int(item) if item else other for item, other in zip(found.groups(), usual, strict=True)]
    return Qos(n[0], n[1], n[2], n[3], (n[4], n[5]), (n[6], n[7]), n[8], (n[9], n[10]))


#: by the names of rmw
PROFILES: Final = {
    "default": Qos(),
    "sensor": Qos(BEST_EFFORT, depth=5),
    "latched": Qos(durability=TRANSIENT_LOCAL, depth=1),
    "all": Qos(history=KEEP_ALL, depth=0),
}


def profile(name: str | None) -> Qos:
    """The QoS of a name, of the default one for None. Raises AddressError."""
    found = PROFILES.get(name or "default")
    if found is None:
        raise AddressError(f'"{(name or "")[:80]}" is no QoS: it is one of {", ".join(PROFILES)}')
    return found
