"""From samples to a table: medians, tails and ratios that a noisy machine does not spoil.

A ratio compares the medians of the same round, where the peers ran one after the other, and the
middle one of these ratios counts: a disturbance that lasts a while hits both sides of it.
"""

import statistics
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from workload import GOALS, WORKLOADS, Goal, Workload


@dataclass(frozen=True)
class Measurement:
    """What one client said after one round."""

    samples: Sequence[float]
    """Nanoseconds of each exchange, or messages per second."""
    processor: float | None = None
    """Nanoseconds that client and server ran per exchange or message, if known."""


# Results[workload][peer] = one measurement per round
Rounds = Sequence[Measurement]
Results = Mapping[str, Mapping[str, Rounds]]


def medians(rounds: Rounds) -> list[float]:
    """The median of each round."""
    return [statistics.median(one.samples) for one in rounds]


def quantile(values: Sequence[float], part: float) -> float:
    """The smallest value that at least `part` (0 to 1) of the values do not exceed."""
    ordered = sorted(values)
    return ordered[max(0, -int(-part * len(ordered) // 1) - 1)]


def ratio(mine: Rounds, other: Rounds) -> float:
    """How many times as much as `other`: the middle of the rounds' ratios."""
    pairs = zip(medians(mine), medians(other), strict=False)
    return statistics.median(a / b for a, b in pairs)


def processor_ratio(mine: Rounds, other: Rounds) -> float | None:
    """The same of the processor's time; None where nobody counted it."""
    pairs = zip(mine, other, strict=False)
    found = [a.processor / b.processor for a, b in pairs if a.processor and b.processor]
    return statistics.median(found) if found else None


def summary(rounds: Rounds, workload: Workload) -> dict[str, float | None]:
    """What the JSON file keeps of a peer, in the workload's unit; `processor` in microseconds."""
    scale = 1.0 if workload.more_is_better else 1e-3
    everything = [value for one in rounds for value in one.samples]
    by_round = medians(rounds)
    ran = [one.processor for one in rounds if one.processor is not None]
    return {
        "median": statistics.median(everything) * scale,
        "p99": quantile(everything, 0.01 if workload.more_is_better else 0.99) * scale,
        "lowest_round": min(by_round) * scale,
        "highest_round": max(by_round) * scale,
        "processor": statistics.median(ran) * 1e-3 if ran else None,
        "rounds": len(by_round),
        "samples": len(everything),
    }


@dataclass(frozen=True)
class Outcome:
    """A goal beside what was measured."""

    goal: Goal
    workload: str
    measured: float

    @property
    def reached(self) -> bool:
        if WORKLOADS[self.workload].more_is_better and not self.goal.processor:
            return self.measured >= self.goal.factor
        return self.measured <= self.goal.factor


def outcomes(results: Results, goals: Sequence[Goal] = GOALS) -> Iterator[Outcome]:
    """Every goal whose two peers ran, once for each workload that asks the same of them."""
    for goal in goals:
        for name, peers in results.items():
            if WORKLOADS[name].function != goal.function:
                continue
            if not {goal.peer, goal.against} <= {*peers}:
                continue
            compare = processor_ratio if goal.processor else ratio
            measured = compare(peers[goal.peer], peers[goal.against])
            if measured is not None:
                yield Outcome(goal, name, measured)


def table(results: Results) -> Iterator[str]:
    """The lines of the report: one block per workload, then the goals."""
    for name, peers in results.items():
        workload = WORKLOADS[name]
        yield ""
        cores = f"{workload.cores} core" + "s" * (workload.cores > 1)
        pause = f", every {workload.pause * 1000:g} ms" if workload.pause else ""
        yield f"{name}: {workload.title} [{workload.unit}, {cores}{pause}]"
        tail = "" if workload.more_is_better else "p99"
        yield (
            f"  {'peer':18}{'median':>11}{tail:>11}{'medians of rounds':>23}"
            f"{'cpu us':>9}{'x raw':>8}"
        )
        for peer, rounds in peers.items():
            row = summary(rounds, workload)
            spread = f"{_number(row['lowest_round'])} - {_number(row['highest_round'])}"
            compared = f"{ratio(rounds, peers['raw']):8.2f}" if "raw" in peers else ""
            tail = "" if workload.more_is_better else _number(row["p99"])
            yield (
                f"  {peer:18}{_number(row['median']):>11}{tail:>11}{spread:>23}"
                f"{_number(row['processor']):>9}{compared}"
            )
    reached = list(outcomes(results))
    if reached:
        yield ""
        yield "goals: ratio of medians, paired by round"
    for outcome in reached:
        more = WORKLOADS[outcome.workload].more_is_better and not outcome.goal.processor
        sign = ">=" if more else "<="
        yield (
            f"  {outcome.workload:15}{outcome.goal.title:48}{outcome.measured:7.2f}"
            f"   goal {sign} {outcome.goal.factor:<5g} {'reached' if outcome.reached else 'missed'}"
        )


def _number(value: float | None) -> str:
    if value is None:
        return "-"
    return f"{value:,.0f}" if value >= 1000 else f"{value:.1f}"
