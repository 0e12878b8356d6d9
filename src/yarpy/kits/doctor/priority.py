"""Findings about priorities: what was asked for is not what the system does."""

from __future__ import annotations

from collections.abc import Iterator

from yarpy.kits.doctor import process
from yarpy.kits.doctor.case import Case, Pair
from yarpy.kits.doctor.finding import Finding
from yarpy.network.traffic import End


def find(case: Case) -> Iterator[Finding]:
    """not-granted."""
    for pair in case.pairs:
        for side, port in (("sender", pair.source), ("receiver", pair.target)):
            end = pair.end(side)
            if end is not None and end.asked:
                yield _not_granted(case, pair, port, end)


def _not_granted(case: Case, pair: Pair, port: str, end: End) -> Finding:
    asked = " ".join(str(value) for value in end.asked.values())
    granted = " ".join(
        str(value) for key in end.asked if (value := getattr(end.qos, str(key), None)) is not None
    )
    pid = case.pid(port)
    why = ""
    if "packets" not in end.asked and pid:
        most = process.limit(pid, "Max realtime priority")
        why = (
            f"; its process {pid} may have real-time priorities up to {most}"
            if most
            else (
                f"; its process {pid} has no right to real-time priorities unless it runs as root"
            )
        )
    side = "--src" if port == pair.source else "--des"
    return Finding(
        "not-granted",
        pair.name,
        f'"{port}" was asked for {asked} on this connection, and the system gives '
        f"{granted or 'nothing'}{why}",
        (
            f"`yarpy qos set {pair.source} {pair.target} {side} {end.asked['packets']}` asks again"
            if "packets" in end.asked
            else "run it as root, grant CAP_SYS_NICE, or raise the limit (`ulimit -r 99`, or "
            f"rtprio in /etc/security/limits.conf); then `yarpy sched set {pair.source} "
            f"{pair.target} {side} FIFO:30` asks again"
        ),
        "warning",
    )
