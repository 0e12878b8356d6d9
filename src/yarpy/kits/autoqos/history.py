"""History: the changes that are in force, and the measures that did not help.

Rules: pure; times go in. A change that puts back what was there before is forgotten. A measure that
did not help rests, each time for longer, up to LONGEST_REST; one that has helped lets the others of
its rule be tried again.
"""

from __future__ import annotations

from typing import Final

from yarpy.kits.autoqos.change import Change
from yarpy.kits.autoqos.rules import Rule
from yarpy.kits.autoqos.trend import Pair

REST: Final = 60.0  # seconds until what did not help is tried again; then twice that
LONGEST_REST: Final = 3600.0
FLOOD: Final = "flood"  # the measure against a critical connection that takes too much itself


class History:
    """The changes that a governor has made, and the measures that rest."""

    def __init__(self) -> None:
        self._made: dict[tuple[str, str, str], Change] = {}
        self._rest: dict[tuple[int, str], float] = {}  # until when, by line of the rule and measure
        self._strikes: dict[tuple[int, str], int] = {}

    # -- changes ----------------------------------------------------------------------------------

    @property
    def changes(self) -> list[Change]:
        """The changes in force, each from what was there at first; the newest setting last."""
        return [*self._made.values()]

    def add(self, change: Change) -> None:
        """Note a change that was made."""
        first = self._made.get(change.what)
        if first is not None and first.before == change.value:
            del self._made[change.what]
            return
        before = change.before if first is None else first.before
        self._made[change.what] = Change(change.port, change.peer, change.key, change.value, before)

    def now(self, change: Change) -> object:
        """Return the value in force of the setting that a change is about."""
        made = self._made.get(change.what)
        return change.before if made is None else made.value

    def limit_of(self, pair: Pair) -> float | None:
        """Return the limit of a connection, or of all of its sender, in Mbit/s; None without."""
        for peer in pair:
            made = self._made.get((pair[0], peer, "limit"))
            if made is not None:
                return float(made.value or 0) or None
        return None

    def all_undone(self, changes: tuple[Change, ...]) -> tuple[Change, ...]:
        """Return the changes that bring settings back to before the first of their changes."""
        return tuple(
            Change(one.port, one.peer, one.key, self._made[one.what].before, one.value)
            for one in changes
            if one.what in self._made
        )

    # -- measures ---------------------------------------------------------------------------------

    def rests(self, rule: Rule, measure: str, now: float) -> bool:
        """Return whether a measure for a rule is not to be tried now."""
        return self._rest.get((rule.line, measure), 0.0) > now

    def failed(self, rule: Rule, measure: str, now: float) -> None:
        """Note that it did not help, or is refused: not again for a while."""
        key = rule.line, measure
        strikes = self._strikes[key] = self._strikes.get(key, 0) + 1
        self._rest[key] = now + min(REST * 2 ** min(strikes - 1, 10), LONGEST_REST)

    def helped(self, rule: Rule, measure: str) -> None:
        """Note that it helped: together with it, what did not help may."""
        self._strikes.pop((rule.line, measure), None)
        for key in [key for key in self._rest if key[0] == rule.line and key[1] != FLOOD]:
            del self._rest[key]
