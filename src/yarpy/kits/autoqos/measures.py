"""Measures: what can be done for a rule, as the changes that each takes now.

Rules: pure. A change that would change nothing is none, and what an end does not tell is left as it
is. Only what somebody counts as best effort is asked to send less, never below its minimum.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, Final

from yarpy.kits.autoqos.change import Change, Key
from yarpy.network.traffic import End, Flow, Snapshot
from yarpy.qos import tos_of

HIGH: Final = "AF42"
NORMAL: Final = "CS0"
LOW: Final = "AF11"
URGENT: Final = ("SCHED_FIFO", 30)
USUAL: Final = ("SCHED_OTHER", 0)
FLOOR: Final = 0.1  # Mbit/s that whoever has stated no minimum keeps
SHRINK: Final = 0.6  # times what it sends now


def ends(flow: Flow) -> Iterator[tuple[str, str, End]]:
    """Port, peer and end, of both ends that answer."""
    if flow.sender is not None:
        yield flow.source, flow.target, flow.sender
    if flow.receiver is not None:
        yield flow.target, flow.source, flow.receiver


def packets(flows: Iterable[Flow], level: str, up: bool) -> tuple[Change, ...]:
    """Both ends of all flows at that class, unless they are there or beyond."""
    wanted = rank(level)
    found = []
    for flow in flows:
        for port, peer, end in ends(flow):
            now = end.qos.packets
            if now is None or (rank(now) >= wanted if up else rank(now) <= wanted):
                continue
            found.append(Change(port, peer, "packets", level, now))
    return tuple(found)


def rank(value: str | int) -> int:
    """Classes in their order: those of bulk lie below the usual."""
    dscp = tos_of(value) >> 2
    return -1 if dscp in (8, 10) else dscp


def threads(flows: Iterable[Flow]) -> tuple[Change, ...]:
    """Real-time threads at both ends of all flows."""
    found = []
    for flow in flows:
        for port, peer, end in ends(flow):
            policy = end.qos.policy
            if policy in (None, "SCHED_OTHER"):
                found.append(Change(port, peer, "threads", URGENT, USUAL))
    return tuple(found)


def timing(flow: Flow, deadline: float, rate: float) -> tuple[Change, ...]:
    """Its receiver counts missed deadlines, if it can and does not do so already."""
    end = flow.receiver
    if end is None or end.messages is None or end.timing:
        return ()
    return (Change(flow.target, flow.source, "timing", (deadline, rate), (0.0, 0.0)),)


def carrier(flows: Iterable[Flow], wanted: str) -> tuple[Change, ...]:
    """Return the changes that move all flows to another carrier."""
    return tuple(
        Change(flow.source, flow.target, "carrier", wanted, flow.carrier)
        for flow in flows
        if wanted and flow.sender is not None and flow.carrier not in ("", wanted)
    )


def limit(
    snapshot: Snapshot, flow: Flow, mbit: float, least: float, alone: bool
) -> tuple[Change, ...]:
    """Its sender sends less than the `mbit` that it sends now. `alone`: it has no other
    connection that would be limited as well."""
    least = max(least, FLOOR)
    port = snapshot.ports.get(flow.source)
    end = flow.sender
    if end is None or port is None or not port.ours:
        return ()
    own = [name for name in end.dropped if name.endswith(" of the port")]
    before: Any
    if "adaptive" in end.monitors:
        peer, told = flow.target, end.parameters.get("mbit")
        before = float(told) if isinstance(told, int | float) else 0.0
    elif not alone or (own and not own[0].startswith("Adaptive")):
        return ()
    else:
        peer, before = flow.source, None
    wanted = round(max(least, SHRINK * mbit), 3)
    return (Change(flow.source, peer, "limit", wanted, before),) if wanted < mbit else ()


def changes_of(found: Iterable[Change], key: Key, pairs: set[tuple[str, str]]) -> list[Change]:
    """Return the changes of a key that concern these connections."""
    return [
        one
        for one in found
        if one.key == key
        and any(
            {one.port, one.peer} == {*pair} or (one.port == one.peer == pair[0]) for pair in pairs
        )
    ]
