"""Findings about what is sent: another type than is expected, stamps of another time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from yarpy.kits.doctor.case import Case, Pair
from yarpy.kits.doctor.finding import Finding
from yarpy.kits.doctor.peek import Peek

AHEAD: Final = 0.5  # seconds by which clocks may differ
BEHIND: Final = 30.0  # seconds that a message may be old
DECLARED: Final = {
    "Image": "yarp/image",
    "Sound": "yarp/sound",
    "Vector": "yarp/vector",
    "Matrix": "yarp/matrix",
}


def find(case: Case) -> Iterator[Finding]:
    """type-mismatch, clock-skew, old-stamps."""
    told: set[str] = set()
    for pair in case.pairs:
        if pair.now is None or not case.wanted:
            continue
        seen = case.peek(pair.source)
        yield from _types(case, pair, seen)
        if pair.source not in told:
            told.add(pair.source)
            yield from _clock(pair, seen)


def _types(case: Case, pair: Pair, seen: Peek) -> Iterator[Finding]:
    end = pair.end("receiver")
    if end is not None and end.failure:
        yield Finding(
            "type-mismatch",
            pair.name,
            f'the program of "{pair.target}" could not use a message of "{pair.source}": '
            f"{end.failure}" + (f" ({pair.source} sends {seen.kind})" if seen.kind else ""),
            f"`yarpy read ... {pair.source}` shows what is sent; connect a port that sends what "
            f"{pair.target} expects, or convert it on the way (`yarpy plugin` lists monitors)",
        )
        return
    state = case.port(pair.target)
    expected = state.type if state is not None else ""
    sent = DECLARED.get(seen.kind, "")
    # The bindings of C++ declare yarp/bottle for whatever they read.
    if expected in DECLARED.values() and (sent or seen.kind) and sent != expected:
        yield Finding(
            "type-mismatch",
            pair.name,
            f'"{pair.target}" expects {expected}, and "{pair.source}" sends {sent or seen.kind}',
            f"connect a port that sends {expected}, or convert it on the way (`yarpy plugin` lists "
            "monitors)",
        )


def _clock(pair: Pair, seen: Peek) -> Iterator[Finding]:
    if seen.stamp is None or not seen.stamp.valid:
        return
    ahead = seen.stamp.time - seen.time
    if ahead > AHEAD:
        yield Finding(
            "clock-skew",
            pair.source,
            f'stamps of "{pair.source}" lie {_spell(ahead)} in the future: the clock of its '
            "computer is ahead of this one's, and whoever compares stamps waits or drops",
            "set the clocks alike: `timedatectl set-ntp true` on both (`timedatectl` shows whether "
            "it works)",
        )
    elif ahead < -BEHIND and seen.stamp.time > 1e9:  # smaller ones count from a start
        yield Finding(
            "old-stamps",
            pair.source,
            f'stamps of "{pair.source}" are {_spell(-ahead)} old when they leave: it sends again '
            "what was recorded, or the clock of its computer is behind this one's",
            "`timedatectl` on both shows whether the clocks are set; programs that drop old "
            "messages drop these",
            "warning",
        )


def _spell(seconds: float) -> str:
    return f"{seconds:.1f} s" if seconds < 1e4 else f"{seconds / 86400:.1f} days"
