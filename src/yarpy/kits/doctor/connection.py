"""Findings about connections: there is none, it goes the other way round, one end has
forgotten it."""

from __future__ import annotations

from collections.abc import Iterator

from yarpy import registry
from yarpy.errors import UnknownPlugin
from yarpy.kits.doctor.case import Case, Pair
from yarpy.kits.doctor.finding import Finding


def find(case: Case) -> Iterator[Finding]:
    """not-connected, wrong-way, one-sided, stale-multicast."""
    for pair in case.pairs:
        if case.port(pair.source) is None and case.port(pair.target) is None:
            continue
        if pair.now is None:
            if len(case.wanted) == 2 and not _hidden(case, pair):
                yield _missing(case, pair)
        elif case.port(pair.source) and case.port(pair.target):
            yield from _one_sided(pair)


def names_sender(carrier: str) -> bool:
    """Return whether both ends of such a connection know it by the names of the two ports. Over
    http, mjpeg or mqtt, for instance, nobody says who sends."""
    try:
        return registry.carriers.facts(carrier.partition("+")[0]).reaches.told
    except UnknownPlugin:
        return True


def _hidden(case: Case, pair: Pair) -> bool:
    """Return whether one of the two ports does not answer or does not exist, which is another
    finding."""
    return not (case.port(pair.source) and case.port(pair.target))


def _missing(case: Case, pair: Pair) -> Finding:
    back = case.pair(pair.target, pair.source)
    if back.now is not None:
        return Finding(
            "wrong-way",
            pair.name,
            f'"{pair.target}" sends to "{pair.source}", and not the other way round',
            f"`yarpy disconnect {pair.target} {pair.source}` and `yarpy connect {pair.source} "
            f"{pair.target}`",
        )
    return Finding(
        "not-connected",
        pair.name,
        f'"{pair.source}" and "{pair.target}" are there, and are not connected',
        f"`yarpy connect {pair.source} {pair.target}`",
    )


def _one_sided(pair: Pair) -> Iterator[Finding]:
    """Over a moment an end may be missing: it was so at both looks. Where the receiver does not
    learn who sends, it lists the connection under another name."""
    if pair.now is None or pair.before is None or not names_sender(pair.carrier):
        return
    again = (
        f"`yarpy disconnect {pair.source} {pair.target}` and `yarpy connect {pair.source} "
        f"{pair.target} {pair.now.carrier}`"
    )
    if pair.now.sender is None and pair.before.sender is None:
        if pair.carrier == "mcast":
            yield Finding(
                "stale-multicast",
                pair.name,
                f'"{pair.target}" still listens to a multicast group for "{pair.source}", which '
                "does not send to it any more (its program was started again, or has another group "
                "by now)",
                again,
            )
        else:
            yield Finding(
                "one-sided",
                pair.name,
                f'"{pair.target}" waits for messages from "{pair.source}" over {pair.carrier}, '
                "which knows nothing of that connection",
                again,
            )
    if pair.now.receiver is None and pair.before.receiver is None:
        yield Finding(
            "one-sided",
            pair.name,
            f'"{pair.source}" sends to "{pair.target}" over {pair.carrier}, which knows nothing of '
            "that connection (its program was started again, or has dropped it)",
            again,
        )
