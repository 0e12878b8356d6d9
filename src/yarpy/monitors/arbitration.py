"""Arbitration: which of several connections may deliver - the equations of the priority monitor.

Rules: pure; the caller passes the time. Messages stimulate their connection, stimulation decays,
active connections excite and inhibit each other, and the one with the largest output wins. Ties go
to the one that came first. (Paikan, Metta, Natale: A port-arbitrated mechanism for behavior
selection in humanoid robotics, ICAR 2013; constants as in C++ YARP.)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import exp
from typing import Final

THRESHOLD: Final = 1.0  # stimulation that makes a connection active
_STEEP: Final = 5.0  # how sharply stimulation falls off towards its end
_TAIL: Final = exp(-_STEEP)
_SINGULAR: Final = 1e-12
_KNOWN: Final = 1024  # outcomes that are remembered


class Inconsistent(ArithmeticError):
    """The weights have no solution, usually because connections excite each other in a circle."""


@dataclass(slots=True, eq=False)
class Competitor:
    """One connection, from `source`. Times in seconds.

    `fade` is how long stimulation lasts, `rest` how long a neuron recovers (0: not a neuron),
    `strength` what a message adds, `weights` how strongly it excites (above 0) or inhibits others.
    """

    source: str
    fade: float = 1.0
    rest: float = 0.0
    strength: float = 1.0
    bias: float = 1.0
    weights: tuple[tuple[str, float], ...] = ()
    virtual: bool = False
    stimulus: float = field(default=0.0, init=False)  # at the time `since`; below 0: it is resting
    since: float = field(default=0.0, init=False)
    active: bool = field(default=False, init=False)

    def stimulation(self, now: float) -> float:
        """The remaining stimulation; updates `active`."""
        age = now - self.since
        if self.rest > 0 and age >= self.fade and self.stimulus >= THRESHOLD:
            self.stimulus = -self.stimulus
        if not self._refractory(self.stimulus):
            left = self.stimulus * _share(age, self.fade)
        elif self.stimulus > 0:
            left = self.stimulus
        else:
            left = self.stimulus * _share(age - self.fade, self.rest)
        if left <= 0:
            self.active = False
        return left

    def stimulate(self, now: float) -> None:
        """A message has arrived."""
        left = self.stimulation(now)
        if self._refractory(left):
            return
        self.stimulus = min(left + self.strength, THRESHOLD)
        self.since = now
        if self.stimulus >= THRESHOLD:
            self.active = True

    def _refractory(self, stimulus: float) -> bool:
        """Return whether messages cannot stimulate it: a neuron that is firing, or recovering from
        it."""
        return self.rest > 0 and not 0 <= stimulus < THRESHOLD


@dataclass(frozen=True, slots=True)
class Outcome:
    """The competitor that may deliver (None: none), and the outputs of the active ones by
    source."""

    winner: Competitor | None
    outputs: dict[str, float]


def _share(age: float, length: float) -> float:
    """The fraction left after `age` of something that lasts `length`: from 1 down to 0."""
    if age > length:
        return 0.0
    if length <= 0:
        return 1.0
    return 1.0 - exp(_STEEP * (age - length) / length) + _TAIL


class Contest:
    """The competitors for one port. Outcomes depend only on which are active, so few are computed.

    Call `changed` whenever the bias, weights or `virtual` of one changed.
    """

    def __init__(self, competitors: Sequence[Competitor] = ()) -> None:
        self.competitors = tuple(competitors)
        self._outcomes: dict[int, Outcome] = {}

    def changed(self) -> None:
        """Forget all outcomes; they are computed again."""
        self._outcomes.clear()

    def decide(self, arrived: Competitor, now: float) -> bool:
        """Return whether a message that `arrived` delivers at `now` may pass. Raises
        Inconsistent."""
        arrived.stimulate(now)
        return self.outcome(now).winner is arrived

    def outcome(self, now: float) -> Outcome:
        """The outcome at `now`. Raises Inconsistent."""
        mask, bit = 0, 1
        for one in self.competitors:
            if one.active:
                age = now - one.since
                if age < one.fade or (age == one.fade and not one.rest):
                    mask |= bit
                else:
                    one.active = False
            bit <<= 1
        found = self._outcomes.get(mask)
        if found is None:
            if len(self._outcomes) >= _KNOWN:
                self._outcomes.clear()
            found = self._outcomes[mask] = _outcome(
                [one for index, one in enumerate(self.competitors) if mask >> index & 1]
            )
        return found


def _outcome(active: Sequence[Competitor]) -> Outcome:
    linked = any(one.weights for one in active)
    outputs = _solve(active) if linked else [one.bias for one in active]
    best, most = None, 0.0
    for one, output in zip(active, outputs, strict=True):
        if output > most and not one.virtual:
            best, most = one, output
    return Outcome(best, {one.source: y for one, y in zip(active, outputs, strict=True)})


def _solve(active: Sequence[Competitor]) -> list[float]:
    """The fixed point y = W y + b of the active ones; the others have no effect and feel none.

    W[k][j] is the weight of j's link to k.
    """
    size = len(active)
    rows = []
    for k, one in enumerate(active):
        row = [0.0] * (size + 1)
        for j, other in enumerate(active):
            for target, weight in other.weights:
                if target == one.source:
                    row[j] = -weight
        row[k] += 1.0
        row[size] = one.bias
        rows.append(row)
    for column in range(size):  # Gauss-Jordan, the largest element of a column as its pivot
        pivot = max(range(column, size), key=lambda index: abs(rows[index][column]))
        if abs(rows[pivot][column]) < _SINGULAR:
            raise Inconsistent
        rows[column], rows[pivot] = rows[pivot], rows[column]
        lead = rows[column]
        scale = lead[column]
        for row in rows:
            factor = row[column] / scale
            if row is not lead and factor:
                for index in range(column, size + 1):
                    row[index] -= factor * lead[index]
    return [row[size] / row[index] for index, row in enumerate(rows)]
