"""Findings about monitors: one drops what comes, or another connection has priority over it."""

from __future__ import annotations

from collections.abc import Iterator

from yarpy.kits.doctor.case import Case, Pair
from yarpy.kits.doctor.finding import Finding
from yarpy.network.traffic import End


def find(case: Case) -> Iterator[Finding]:
    """monitor-drops, starved."""
    for pair in case.pairs:
        for side in ("sender", "receiver"):
            end = pair.end(side)
            if end is not None and end.dropped:
                yield from _drops(case, pair, side, end)


def _drops(case: Case, pair: Pair, side: str, end: End) -> Iterator[Finding]:
    old = getattr(pair.before, side, None)
    before = old.dropped if old is not None else {}
    for name, count in end.dropped.items():
        if not count:
            continue
        recently = count - before.get(name, 0)
        # With one look only, or a slow stream, all that ever came counts.
        dropped = recently or count
        passed = _passed(pair, side, bool(recently))
        port = pair.source if side == "sender" else pair.target
        if name == "priority" and _winner(end) not in ("", pair.source):
            yield _starved(pair, end, dropped)
            continue
        why = end.failures.get(name, "")
        if not why and passed:
            continue  # that is what it is for
        yield Finding(
            "monitor-drops",
            pair.name,
            f'the monitor {name} at "{port}" drops '
            + (f"{dropped} of {dropped + passed}" if passed else f"all {dropped}")
            + (f" messages: {why}" if why else " messages"),
            _advice(pair, name, side),
            "warning" if passed else "fault",
        )


def _passed(pair: Pair, side: str, recently: bool) -> int:
    """Messages that got past this end."""
    key = "messages" if side == "sender" else "delivered"
    grown = pair.grown(side, key)
    if recently and grown is not None:
        return max(grown, 0)
    return getattr(pair.end(side), key, None) or 0


def _advice(pair: Pair, name: str, side: str) -> str:
    if name.endswith(" of the port"):
        port, way = (pair.source, "out") if side == "sender" else (pair.target, "in")
        return f"correct it, or take it off the port: `yarpy admin rpc {port}`, `dtch {way}`"
    return f"correct it, or connect without it: `yarpy connect {pair.source} {pair.target} " + (
        f"{pair.carrier}`"
    )


def _winner(end: End) -> str:
    return str(end.state.get("winner", ""))


def _starved(pair: Pair, end: End, dropped: int) -> Finding:
    return Finding(
        "starved",
        pair.name,
        f'{dropped} messages of "{pair.source}" were dropped, because "{_winner(end)}" has '
        f'priority at "{pair.target}"',
        f"make it stronger: `yarpy connect {pair.source} {pair.target} {pair.carrier}"
        f"+recv.priority+st.10+bs.N` with a larger N, or silence {_winner(end)}",
    )
