"""QoS in the words of DDS, both ways.

Rules: how much somebody keeps DDS tells nobody.
"""

from __future__ import annotations

import re
from typing import Any, Final

from yarpy.peers.ros2.key import NO_HASH
from yarpy.peers.ros2.qos import (
    AUTOMATIC,
    BEST_EFFORT,
    FOREVER,
    KEEP_ALL,
    MANUAL,
    RELIABLE,
    TRANSIENT_LOCAL,
    VOLATILE,
    Qos,
)

SECOND: Final = 1_000_000_000
FOREVER_NS: Final = (1 << 63) - 1
BLOCKING: Final = 100  # milliseconds that a reliable writer waits for slow readers

_HASH = re.compile(rb"typehash=(RIHS01_[0-9a-f]{64})")


def promises_of(qos: Any) -> tuple[str, Qos]:
    """Return the type hash and the QoS of somebody else."""
    found = {type(policy).__name__: policy for policy in qos}
    said = _HASH.search(getattr(found.get("Userdata"), "data", b""))
    manual = "Liveliness.ManualByTopic" in found
    life = found.get("Liveliness.ManualByTopic") or found.get("Liveliness.Automatic")
    made = Qos(
        reliability=BEST_EFFORT if "Reliability.BestEffort" in found else RELIABLE,
        durability=TRANSIENT_LOCAL if "Durability.TransientLocal" in found else VOLATILE,
        deadline=_pair(getattr(found.get("Deadline"), "deadline", None)),
        lifespan=_pair(getattr(found.get("Lifespan"), "lifespan", None)),
        liveliness=MANUAL if manual else AUTOMATIC,
        lease=_pair(getattr(life, "lease_duration", None)),
    )
    return (said[1].decode() if said else NO_HASH), made


def dds_qos(qos: Qos, hash_: str, room: int = 0, *, writes: bool, about: str = "") -> Any:
    """Return the same for the library, which keeps `room` messages at least. `about`: what else the
    endpoint says of itself."""
    from cyclonedds.core import Policy
    from cyclonedds.core import Qos as DdsQos
    from cyclonedds.util import duration

    history: Any = Policy.History.KeepLast(max(qos.kept, room))
    if qos.history == KEEP_ALL:
        history = Policy.History.KeepAll
    waits = Policy.Reliability.Reliable(duration(milliseconds=BLOCKING))
    life: Any = Policy.Liveliness
    life = life.ManualByTopic if qos.liveliness == MANUAL else life.Automatic
    policies = [
        history,
        waits if qos.reliable else Policy.Reliability.BestEffort,
        Policy.Durability.TransientLocal if qos.latched else Policy.Durability.Volatile,
        Policy.Deadline(_nanoseconds(qos.deadline)),
        life(_nanoseconds(qos.lease)),
        Policy.Userdata(f"{about}typehash={hash_};".encode()),
    ]
    if writes:
        policies += [
            Policy.Lifespan(_nanoseconds(qos.lifespan)),
            Policy.WriterDataLifecycle(autodispose=False),
        ]
    if qos.latched:
        policies.append(Policy.DurabilityService(0, history, -1, -1, -1))
    return DdsQos(*policies)


def _pair(nanoseconds: int | None) -> tuple[int, int]:
    if nanoseconds is None or nanoseconds >= FOREVER_NS:
        return FOREVER
    return divmod(nanoseconds, SECOND)


def _nanoseconds(pair: tuple[int, int]) -> int:
    """The library's number; 0 is, as for rmw, no duration that anybody asks for."""
    found = pair[0] * SECOND + pair[1]
    return FOREVER_NS if not 0 < found < FOREVER_NS else found
