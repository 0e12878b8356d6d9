"""Statuses of readers and writers of the library, as events."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

from yarpy.peers.ros2.dds.library import load
from yarpy.peers.ros2.event import CHANGED, DEADLINE, INCOMPATIBLE, LOST, MESSAGE, Event

TYPE: Final = "type_consistency"
REPRESENTATION: Final = "data_representation"
POLICIES: Final = {
    2: "durability",
    4: "deadline",
    8: "liveliness",
    11: "reliability",
    24: TYPE,
    25: REPRESENTATION,
}

_WRITES: Final = {
    "OfferedIncompatibleQos": ("get_offered_incompatible_qos_status", INCOMPATIBLE),
    "OfferedDeadlineMissed": ("get_offered_deadline_missed_status", DEADLINE),
    "LivelinessLost": ("get_liveliness_lost_status", LOST),
}
_READS: Final = {
    "RequestedIncompatibleQos": ("get_requested_incompatible_qos_status", INCOMPATIBLE),
    "RequestedDeadlineMissed": ("get_requested_deadline_missed_status", DEADLINE),
    "LivelinessChanged": ("get_liveliness_changed_status", CHANGED),
    "SampleLost": ("get_sample_lost_status", MESSAGE),
}


def mask_of(writes: bool) -> int:
    """Return the statuses that are events, of a writer or a reader, as the library's bits."""
    found = 0
    for name in _WRITES if writes else _READS:
        found |= getattr(load().DDSStatus, name)
    return found


def events_of(entity: Any, found: int, writes: bool) -> Iterator[Event]:
    """Yield what the bits `found` say of a writer or reader."""
    for name, (method, kind) in (_WRITES if writes else _READS).items():
        if not found & getattr(load().DDSStatus, name):
            continue
        status = getattr(entity, method)()
        if kind == CHANGED:
            yield Event(kind, status.alive_count)
        elif status.total_count_change > 0:
            policy = getattr(status, "last_policy_id", 0)
            yield Event(kind, status.total_count_change, POLICIES.get(policy, ""))
