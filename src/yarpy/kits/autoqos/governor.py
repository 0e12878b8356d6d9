"""The governor: decides, from looks at the network, what to change next.

Rules: pure; looks and times go in, steps come out, and whoever makes a step says how that went. One
step at a time: then it waits until the effect can be seen, and takes the step back if there was
none. What did not help is not tried again for a while, each time for longer, so nothing oscillates.

    trouble    a critical connection misses more than TOLERANCE of its deadlines, twice in a row
    measures   its packets, its threads; then of best effort: packets, another carrier, less
    starving   best effort gets less than its minimum, and wants more: what was given is taken back
    calm       for a while no trouble: limits grow again, step by step
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from yarpy.kits.autoqos import measures
from yarpy.kits.autoqos.change import Change, Step
from yarpy.kits.autoqos.history import FLOOD, LONGEST_REST, REST, History
from yarpy.kits.autoqos.rules import Rule, Rules
from yarpy.kits.autoqos.trend import Pair, Trend
from yarpy.network.traffic import Snapshot

TOLERANCE: Final = 0.02  # of the messages may miss their deadline
HELPED: Final = 0.8  # times what was missed before, or less
SETTLE: Final = 0.5  # seconds until the effect of a step is looked at
SILENT: Final = 5.0  # seconds without a message after which a step is thought to have done harm
LOOK_AT: Final = 0.5  # seconds that trouble lasts before it is believed, at least
MESSAGES: Final = 50  # on which a connection is judged
SLOWEST: Final = 20.0  # seconds for which these are awaited
STARVING: Final = 1.5  # seconds, likewise
ENOUGH: Final = 0.8  # of its minimum: less is starving
CALM: Final = 15.0  # seconds without trouble before a limit grows
GROW: Final = 1.5  # times a limit
SPARE: Final = 1.5  # times its minimum: best effort that gets less keeps its packets' class


@dataclass(slots=True)
class Trial:
    """A step whose effect is not known yet."""

    rule: Rule
    measure: str
    changes: tuple[Change, ...]
    before: float | None  # the part that missed its deadline
    since: float
    span: float  # seconds over which it is judged


class Governor:
    """`trusting`: steps are taken to have helped (nobody makes them)."""

    def __init__(self, rules: Rules, trusting: bool = False) -> None:
        self._rules = rules
        self._trusting = trusting
        self._trend = Trend()
        self._history = History()
        self._trial: Trial | None = None
        self._pending: tuple[Rule, str, float | None] | None = None
        self._told: set[object] = set()
        self._quiet_since = 0.0
        self._changed = 0.0  # when the last step was made
        self._calm = CALM
        self._groups: dict[Rule, list[Pair]] = {}
        self.steps = 0  # that changed something

    # -- what happens -----------------------------------------------------------------------------

    def decide(self, snapshot: Snapshot, now: float) -> Step | None:
        """Return the next step to take or to tell; None for nothing."""
        self._trend.add(snapshot, now)
        self._quiet_since = self._quiet_since or now
        self._sort(snapshot)
        for step in self._news(snapshot):
            return step
        if self._trial is not None:
            return self._judge(self._trial, now)
        if self._pending is not None:
            return None
        for attempt in (self._feed, self._help, self._relax):
            found = attempt(snapshot, now)
            if found is not None:
                return found
        return None

    def done(self, step: Step, failed: dict[Change, str], now: float) -> None:
        """A step was made, but for those changes that failed, with the reasons."""
        made = [change for change in step.changes if change not in failed]
        for change in made:
            self._history.add(change)
        self.steps += bool(made)
        self._told.update(("failed", change.what, change.value) for change in failed)
        pending, self._pending = self._pending, None
        if made:
            self._changed = now
        if pending is None:
            return
        rule, measure, before = pending
        if not made:
            self._history.failed(rule, measure, now)
        elif not self._trusting:
            span = self._span(self._groups.get(rule, []))
            self._trial = Trial(rule, measure, tuple(made), before, now, span)

    # -- what there is ----------------------------------------------------------------------------

    def _sort(self, snapshot: Snapshot) -> None:
        """Find the connections that each rule is about."""
        self._groups = {rule: [] for rule in self._rules.rules}
        for pair, flow in snapshot.flows.items():
            found = self._rules.of(flow.source, flow.target) if flow.target else []
            if len(found) == 1:
                self._groups[found[0]].append(pair)

    def _news(self, snapshot: Snapshot) -> Iterator[Step]:
        """Yield the steps that tell of new connections, or count them."""
        at_odds: set[Rule] = set()  # with another rule: they do match something
        for pair, flow in snapshot.flows.items():
            found = self._rules.of(flow.source, flow.target) if flow.target else []
            at_odds.update(found if len(found) == 2 else ())
            if len(found) == 2 and self._first(("both", pair)):
                lines = " and ".join(str(rule.line) for rule in found)
                yield Step(
                    f"{_name(pair)} is critical and best effort (lines {lines} of "
                    f"{self._rules.where}): it is left alone until one of them says otherwise"
                )
        for rule, pairs in self._groups.items():
            if not pairs and rule not in at_odds and self._first(("none", rule)):
                patterns = ", ".join(rule.connections)
                yield Step(f"the rule in line {rule.line} ({patterns}) matches no connection now")
            if rule.kind != "critical":
                continue
            changes: list[Change] = []
            for pair in pairs:
                flow = snapshot.flows[pair]
                if flow.receiver is not None and self._first(("timing", pair)):
                    changes += measures.timing(flow, rule.deadline, rule.rate)
                    if flow.receiver.messages is None:
                        yield Step(f"{_name(pair)}: {pair[1]} counts no deadlines, so it is given "
                                   "priority when there is other traffic")  # fmt: skip
            if changes:
                yield Step(
                    f"deadlines of {rule.deadline * 1e3:g} ms are counted on "
                    + _names([(one.peer, one.port) for one in changes]),
                    tuple(changes),
                )

    def _first(self, what: object) -> bool:
        new = what not in self._told
        self._told.add(what)
        return new

    def _of(self, kind: str) -> Iterator[tuple[Rule, list[Pair]]]:
        for rule, pairs in self._groups.items():
            if rule.kind == kind and pairs:
                yield rule, pairs

    # -- trouble ----------------------------------------------------------------------------------

    def _help(self, snapshot: Snapshot, now: float) -> Step | None:
        """The next measure for the critical rule that is worst off."""
        worst: tuple[float, Rule, list[Pair]] | None = None
        for rule, pairs in self._of("critical"):
            if self._history.rests(rule, FLOOD, now):
                continue  # it is late by its own doing
            missed = self._trend.missed(pairs, max(now - self._span(pairs), self._changed))
            if missed is None and not self._trend.counts(pairs) and self._crowded(snapshot):
                missed = 1.0  # nobody can tell: better to be careful
            if missed is not None and missed > TOLERANCE and (worst is None or missed > worst[0]):
                worst = missed, rule, pairs
        if worst is None:
            return None
        self._quiet_since = now
        missed, rule, pairs = worst
        if not self._lasts(pairs, now):
            return None
        blind = not self._trend.counts(pairs)
        for measure, changes, words in self._measures(snapshot, rule, pairs, now, blind):
            changes = tuple(
                one
                for one in changes
                if ("failed", one.what, one.value) not in self._told
                and self._history.now(one) != one.value
            )
            if changes and not self._history.rests(rule, measure, now):
                self._pending = rule, measure, None if blind else missed
                trouble = "nobody counts deadlines of" if blind else f"{missed:.0%} late on"
                return Step(f"{trouble} {_names(pairs)}: {words}", changes)
        if self._first(("all", rule, int(now // REST))):
            return Step(f"{missed:.0%} late on {_names(pairs)}, and nothing more can be done now")
        return None

    def _lasts(self, pairs: list[Pair], now: float) -> bool:
        """Return whether two looks in a row found it."""
        if not self._trend.counts(pairs):
            return True
        span = self._span(pairs)
        half = self._trend.missed(pairs, max(now - span / 2, self._changed))
        return half is not None and half > TOLERANCE and now - self._changed >= span

    def _span(self, pairs: list[Pair]) -> float:
        """Seconds over which these connections are judged: until enough messages have come."""
        pace = self._trend.pace(pairs)
        return min(max(LOOK_AT, MESSAGES / pace if pace else LOOK_AT), SLOWEST)

    def _crowded(self, snapshot: Snapshot) -> bool:
        return any(
            (snapshot.flows[pair].speed or 0) > 0 for _, p in self._of("best-effort") for pair in p
        )

    def _measures(
        self, snapshot: Snapshot, rule: Rule, pairs: list[Pair], now: float, blind: bool
    ) -> Iterator[tuple[str, tuple[Change, ...], str]]:
        """Yield the measures for it, in the order of what they cost the others."""
        flows = [snapshot.flows[pair] for pair in pairs]
        yield "packets", measures.packets(flows, measures.HIGH, True), "its packets become HIGH"
        yield "threads", measures.threads(flows), "its threads become SCHED_FIFO 30"
        if blind:
            return  # the others do not pay for what nobody can see
        for other, others in self._of("best-effort"):
            bulk = [
                snapshot.flows[pair]
                for pair in others
                if (self._trend.mbit(pair, now - CALM) or 0.0) >= SPARE * other.least
            ]
            name = _names(others)
            yield (
                f"bulk packets {other.line}",
                measures.packets(bulk, measures.LOW, False),
                f"the packets of {name} become LOW",
            )
            yield (
                f"carrier {other.line}",
                measures.carrier(bulk, other.carrier),
                f"{name} moves to {other.carrier}",
            )
        for other, others in self._of("best-effort"):
            for pair in others:
                mbit = self._trend.mbit(pair, now - 2 * LOOK_AT)
                if mbit is None:
                    continue
                mbit = min(mbit, self._history.limit_of(pair) or mbit)
                changes = self._limited(snapshot, pair, mbit, other.least)
                for change in changes:
                    words = f"{_name(pair)} sends {change.value:g} Mbit/s instead of {mbit:.3g}"
                    yield f"limit {pair}", changes, words

    def _limited(
        self, snapshot: Snapshot, pair: Pair, mbit: float, least: float
    ) -> tuple[Change, ...]:
        others = [flow for key, flow in snapshot.flows.items() if key[0] == pair[0] and key[1]]
        found = measures.limit(snapshot, snapshot.flows[pair], mbit, least, len(others) == 1)
        return tuple(
            Change(one.port, one.peer, "limit", one.value, self._history.now(one)) for one in found
        )

    # -- whether it helped ------------------------------------------------------------------------

    def _judge(self, trial: Trial, now: float) -> Step | None:
        pairs = self._groups.get(trial.rule, [])
        span = SETTLE + trial.span
        if now - trial.since < span:
            return None
        missed = self._trend.missed(pairs, trial.since + SETTLE)
        if missed is None and now - trial.since < max(SILENT, span) and trial.before is not None:
            return None  # nothing came yet, or nobody answered
        self._trial = None
        if trial.before is None:
            return None  # nobody can tell
        if missed is not None and (missed <= TOLERANCE or missed < HELPED * trial.before):
            if trial.measure == "relax":
                return None
            self._history.helped(trial.rule, trial.measure)
            return Step(f"that helped: {trial.before:.0%} -> {missed:.0%} late on {_names(pairs)}")
        if missed is not None and trial.measure.startswith("limit") and self._can_shrink(trial):
            return None  # on the way: only at its minimum is it certain that it did not help
        self._history.failed(trial.rule, trial.measure, now)
        told = "nothing comes" if missed is None else f"{missed:.0%} late"
        back = tuple(change.undone for change in reversed(trial.changes))
        if trial.measure == "relax":
            self._calm = min(2 * self._calm, LONGEST_REST)
            return Step(f"too early ({told}): the limit is as it was", back)
        if trial.measure.startswith("limit"):  # all of the way back
            back = self._history.all_undone(trial.changes)
        return Step(f"that did not help ({told}): it is as it was", back)

    def _can_shrink(self, trial: Trial) -> bool:
        """Return whether a limit is above the minimum that its connection keeps."""
        [change] = trial.changes
        least = [rule.least for rule, all_ in self._of("best-effort") for pair in all_
                 if pair[0] == change.port]  # fmt: skip
        return bool(change.value > max([measures.FLOOR, *least]))

    # -- nobody starves ---------------------------------------------------------------------------

    def _feed(self, snapshot: Snapshot, now: float) -> Step | None:
        """Best effort that gets less than its minimum comes before what is critical."""
        since = max(now - STARVING, self._changed)
        if now - self._changed < STARVING:
            return None
        for rule, pairs in self._of("best-effort"):
            for pair in pairs:
                mbit = self._trend.mbit(pair, since)
                if not rule.least or mbit is None or mbit >= ENOUGH * rule.least:
                    continue
                if self._history.limit_of(pair) is None and self._trend.wants_more(pair, since):
                    step = self._demoted(snapshot, rule, pair, mbit, now)
                    if step is not None:
                        return step
        return None

    def _demoted(
        self, snapshot: Snapshot, rule: Rule, pair: Pair, mbit: float, now: float
    ) -> Step | None:
        self._quiet_since = now
        why = f"{_name(pair)} gets {mbit:.2g} of its {rule.least:g} Mbit/s: "
        own = [
            change.undone
            for change in measures.changes_of(self._history.changes, "packets", {pair})
            if change.value == measures.LOW
        ]
        if own:
            return Step(why + "its packets are as they were", tuple(own))
        floods: list[tuple[float, Rule, Pair]] = [
            (self._trend.mbit(one, now - STARVING) or 0.0, critical, one)
            for critical, all_ in self._of("critical")
            for one in all_
        ]
        for speed, critical, one in sorted(floods, key=lambda flood: -flood[0]):
            if speed < rule.least:
                break
            flow = snapshot.flows[one]
            changes = measures.packets([flow], measures.NORMAL, False)
            if changes:
                self._history.failed(critical, FLOOD, now)
                words = f"{_name(one)} floods ({speed:.3g} Mbit/s), its packets become NORM"
                return Step(why + words, changes)
            limited = self._limited(
                snapshot, one, min(speed, self._history.limit_of(one) or speed), 0.0
            )
            if limited:
                self._history.failed(critical, FLOOD, now)
                words = f"{_name(one)} sends {limited[0].value:g} Mbit/s instead of {speed:.3g}"
                return Step(why + words, limited)
        return None

    # -- calm -------------------------------------------------------------------------------------

    def _relax(self, snapshot: Snapshot, now: float) -> Step | None:
        """Limits grow again, the one that was made last first."""
        if now - max(self._quiet_since, self._changed) < self._calm:
            return None
        for made in reversed(self._history.changes):
            if made.key != "limit":
                continue
            rule = next((rule for rule, _ in self._of("critical")), None)
            speed = [
                self._trend.mbit(pair, now - CALM) or 0.0
                for pair in snapshot.flows
                if pair[0] == made.port
            ]
            unused = max(speed, default=0.0) < 0.5 * made.value
            value = made.before if unused else round(GROW * made.value, 3)
            words = "it has no limit any more" if value is None else f"it may send {value:g} Mbit/s"
            step = Step(
                f"no trouble for {self._calm:g} s: {made.port}: {words}",
                (Change(made.port, made.peer, "limit", value, made.value),),
            )
            if rule is not None:
                self._pending = rule, "relax", 0.0
            return step
        return None


def _name(pair: Pair) -> str:
    return f"{pair[0]} -> {pair[1]}"


def _names(pairs: list[Pair]) -> str:
    names = [_name(pair) for pair in pairs]
    return ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")


__all__ = ["Governor"]
