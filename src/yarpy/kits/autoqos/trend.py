"""The trend of connections over the last looks: speed, lateness and misses.

Rules: pure. Counters are those of the ports; what has gone backwards (a connection made again)
counts as nothing. None: nobody counts that.
"""

from __future__ import annotations

from collections import deque
from itertools import pairwise
from typing import Final, TypeAlias

from yarpy.network.traffic import End, Flow, Snapshot

Pair: TypeAlias = tuple[str, str]
KEEP: Final = 30.0  # seconds
SHORTEST: Final = 0.4  # seconds: looks that are nearer say nothing of speed
MBIT: Final = 125_000.0  # bytes per second


class Trend:
    """The looks of the last seconds."""

    def __init__(self) -> None:
        self._looks: deque[tuple[float, dict[Pair, Flow]]] = deque()

    def add(self, snapshot: Snapshot, now: float) -> None:
        """One more look."""
        self._looks.append((now, snapshot.flows))
        while self._looks[0][0] < now - KEEP:
            self._looks.popleft()

    def missed(self, pairs: list[Pair], since: float) -> float | None:
        """The part of the messages over these connections that missed a deadline from the first
        look at or after `since` until now, a single one being chance; None where nobody counts, or
        nothing came."""
        looks = [flows for at, flows in self._looks if at >= since - 1e-9]
        missed, came = _counted(pairs, looks)
        return (missed if missed > 1 else 0) / came if came else None

    def pace(self, pairs: list[Pair]) -> float:
        """Messages, or missed deadlines, per second over all of these connections in the last
        looks; 0.0 if nobody counts, or nothing came."""
        looks = [(at, flows) for at, flows in self._looks if _are_counted(pairs, flows)]
        _, came = _counted(pairs, [flows for _, flows in looks])
        return came / (looks[-1][0] - looks[0][0]) if came else 0.0

    def counts(self, pairs: list[Pair]) -> bool:
        """Return whether misses of a deadline are counted now on one of these connections."""
        return bool(self._looks) and _are_counted(pairs, self._looks[-1][1])

    def wants_more(self, pair: Pair, since: float) -> bool:
        """Return whether its sender had more to send than it could, at most looks since then."""
        looks = [flows.get(pair) for at, flows in self._looks if at >= since - 1e-9]
        wanting = total = 0
        for before, after in pairwise(looks):
            if before is None or after is None:
                return False
            old, new = before.sender, after.sender
            total += 1
            if new is None or old is None:
                wanting += 1  # it does not even answer
            else:
                wanting += bool(new.unacknowledged) or _left_out(new) > _left_out(old)
        return 2 * wanting > total

    def mbit(self, pair: Pair, since: float) -> float | None:
        """Return what arrived since then, in Mbit/s; None if that is not known."""
        looks = [(at, flows[pair]) for at, flows in self._looks if at >= since and pair in flows]
        if len(looks) < 2 or looks[-1][0] - looks[0][0] < SHORTEST:
            return None
        for side in ("receiver", "sender"):
            ends = [getattr(flow, side) for _, flow in (looks[0], looks[-1])]
            sizes: list[int] = [
                end.bytes for end in ends if end is not None and end.bytes is not None
            ]
            if len(sizes) == 2:
                return max(sizes[1] - sizes[0], 0) / (looks[-1][0] - looks[0][0]) / MBIT
        return None


def _left_out(end: End) -> int:
    """Return how many messages a sender did not send."""
    return (end.replaced or 0) + (end.drops or 0)


def _are_counted(pairs: list[Pair], flows: dict[Pair, Flow]) -> bool:
    return any(pair in flows and flows[pair].missed is not None for pair in pairs)


def _counted(pairs: list[Pair], looks: list[dict[Pair, Flow]]) -> tuple[int, int]:
    """Return how many messages missed their deadline between the first look and the last, and of
    how many."""
    missed = came = 0
    if len(looks) < 2:
        return missed, came
    for pair in pairs:
        first, last = looks[0].get(pair), looks[-1].get(pair)
        if first is None or last is None or first.missed is None or last.missed is None:
            continue
        late = max(last.missed - first.missed, 0)
        ends = [flow.receiver.messages if flow.receiver else None for flow in (first, last)]
        passed = max((ends[1] or 0) - (ends[0] or 0), 0)
        missed, came = missed + late, came + max(passed, late)
    return missed, came
