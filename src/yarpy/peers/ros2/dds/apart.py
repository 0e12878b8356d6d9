"""Those at our topic whose type has the name of ours, and whom the library keeps apart from us all
the same: it compares what both say of the fields, and how they write them.

Rules: the library tells that it keeps somebody apart, and by what, but not whom: they are those
that it does not count among who hears us, or whom we hear. Whoever says the same as we is none of
them, but has just come, or promises too little.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

from yarpy.peers.ros2.dds.library import load, turn
from yarpy.peers.ros2.dds.status import REPRESENTATION, TYPE
from yarpy.peers.ros2.key import Key
from yarpy.peers.ros2.token import SUBSCRIBER, Token

#: by policy, what differs, and what to do
WHY: Final = {
    TYPE: (
        "its fields differ, or it may grow there (@appendable, @mutable)",
        "types of ROS 2 are @final: declare it there so, with the same fields",
    ),
    REPRESENTATION: (
        "it is taken there as XCDR2 alone, as types are that may grow (@appendable, @mutable)",
        "types of ROS 2 are @final, and go as XCDR1: declare it there so, and let that be taken",
    ),
}


def apart(
    policy: str, part: Any, entity: Any, class_: Any, key: Key, peers: str
) -> Iterator[Token]:
    """Yield those whom a reader or writer of ours, `entity`, is kept apart from by a policy of
    `WHY`; `class_`: of its type; `peers`: PUBLISHER or SUBSCRIBER."""
    met = _met(entity, "subscription" if peers == SUBSCRIBER else "publication")
    for sample in part.endpoints(peers):
        if sample.topic_name != f"rt{key.name}" or sample.type_name != key.type:
            continue
        if _differs(sample, class_, policy) and sample.key not in met:
            yield part.token(sample, peers)


def apart_by(sample: Any, class_: Any) -> str:
    """Return the policy of `WHY` that may keep a reader or writer of somebody, whose type has the
    name of ours, apart from those of `class_`; "" if none does."""
    return next((policy for policy in WHY if _differs(sample, class_, policy)), "")


def _differs(sample: Any, class_: Any, policy: str) -> bool:
    if policy == TYPE:
        return bool(sample.type_id != class_.__idl__.get_type_id())
    return not _takes_first(sample.qos)


def _takes_first(qos: Any) -> bool:
    """Return whether the first version of CDR is taken."""
    for policy in qos:
        if type(policy).__name__ == "DataRepresentation":
            return bool(policy.use_cdrv0_representation)
    return True


def _met(entity: Any, what: str) -> set[Any]:
    found = set()
    for handle in getattr(entity, f"get_matched_{what}s")():
        try:
            with turn:
                item = getattr(entity, f"get_matched_{what}_data")(handle)
        except load().DDSException:
            continue  # it has just gone
        if item is not None:
            found.add(item.key)
    return found
