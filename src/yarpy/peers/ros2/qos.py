"""The QoS of ROS 2, which topics promise, and the text that stands for it in tokens.

    ::,10:,:,:,,      reliable, volatile, the last ten      2::,5:,:,:,,      sensor data
    :1:,1:,:,:,,      transient local: who comes late gets the last message

Rules: each number that is usual is left out of the text. Zenoh connects whatever there is: nothing
of this stops data, but it says how much is kept, and who waits for whom. DDS connects a subscriber
with those publishers only that promise what it asks for. Where no QoS is said, those of the peers
decide about reliability and durability, as for `ros2 topic echo`; how much is kept is never theirs.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Final

from yarpy.errors import AddressError, DecodeError

RELIABLE: Final = 1
BEST_EFFORT: Final = 2
TRANSIENT_LOCAL: Final = 1
VOLATILE: Final = 2
KEEP_LAST: Final = 1
KEEP_ALL: Final = 2
AUTOMATIC: Final = 1  # liveliness: a publisher is alive as long as its program
MANUAL: Final = 3  # ... as long as it says so, by publishing at the latest
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
    liveliness: int = AUTOMATIC
    lease: tuple[int, int] = FOREVER

    @property
    def reliable(self) -> bool:
        return self.reliability != BEST_EFFORT

    @property
    def latched(self) -> bool:
        """True if late subscribers get the messages from before."""
        return self.durability == TRANSIENT_LOCAL

    @property
    def kept(self) -> int:
        """The number of messages that are kept."""
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


def asked(promises: Iterable[Qos]) -> Qos:
    """The QoS of a subscriber that hears all publishers with these: as much as all promise."""
    found = [*promises]
    return Qos(
        RELIABLE if all(qos.reliable for qos in found) else BEST_EFFORT,
        TRANSIENT_LOCAL if found and all(qos.latched for qos in found) else VOLATILE,
    )


def promised(wishes: Iterable[Qos]) -> Qos:
    """The QoS of a publisher that all subscribers with these hear: as much as one asks for."""
    latched = any(qos.latched for qos in wishes)
    return Qos(durability=TRANSIENT_LOCAL if latched else VOLATILE)


def _pairs(duration: tuple[int, int]) -> tuple[tuple[int, int], ...]:
    return tuple(zip(duration, FOREVER, strict=True))


def parse_qos(text: str) -> Qos:
    """Parse the text of a QoS. Raises DecodeError."""
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


_NAMES: Final = {
    "reliability": {"reliable": RELIABLE, "best_effort": BEST_EFFORT},
    "durability": {"volatile": VOLATILE, "transient_local": TRANSIENT_LOCAL},
    "history": {"keep_last": KEEP_LAST, "keep_all": KEEP_ALL},
    "liveliness": {"automatic": AUTOMATIC, "manual_by_topic": MANUAL},
}
_DURATIONS: Final = ("deadline", "lifespan", "lease")
#: what may be said of a QoS beside its name, as words of a target
WORDS: Final = (
    *(f"{key}.NAME" for key in _NAMES),
    "depth.N",
    *(f"{key}.MS" for key in _DURATIONS),
)


def qos_profile(name: str | None = None, **said: str | float) -> Qos:
    """The QoS of a name, changed by what is said beside it, in the words of ROS 2: `reliability`,
    `durability`, `history`, `depth`, `liveliness` (automatic, manual_by_topic), and `deadline`,
    `lifespan` and `lease` (of liveliness) in seconds. Raises AddressError.

    >>> qos_profile("sensor", depth=20, deadline=0.1).kept
    20
    """
    made: dict[str, Any] = {}
    for key, value in said.items():
        if key in _NAMES:
            found = _NAMES[key].get(str(value))
            if found is None:
                names = ", ".join(_NAMES[key])
                raise AddressError(f'"{str(value)[:80]}" is no {key}: it is one of {names}')
            made[key] = found
        elif key == "depth":
            made[key] = int(_number(key, value))
        elif key in _DURATIONS:
            made[key] = divmod(round(_number(key, value) * 1e9), 1_000_000_000)
        else:
            raise AddressError(f'"{key[:80]}" is nothing that a QoS has: {", ".join(WORDS)}')
    return replace(profile(name), **made)


def qos_of_words(name: str | None, words: Mapping[str, str]) -> Qos | None:
    """Return the QoS that the words of a target say, durations being in milliseconds; None where
    nothing is said. Raises AddressError."""
    if name is None and not words:
        return None
    said: dict[str, str | float] = dict(words)
    for key in _DURATIONS:
        if key in words:
            said[key] = _number(key, words[key]) / 1000
    return qos_profile(name, **said)


def _number(key: str, value: object) -> float:
    """A number that is not below 0, nor beyond what ROS 2 can say."""
    try:
        found = float(str(value))
    except ValueError:
        found = -1.0
    if not 0 <= found <= FOREVER[0]:
        raise AddressError(f'"{str(value)[:80]}" is no {key}: it is a number, 0 or more')
    return found
