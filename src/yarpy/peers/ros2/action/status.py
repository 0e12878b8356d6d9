"""The states of a goal of ROS 2, and where an action is spoken of: three services, two topics.

Rules: pure. The numbers are those of action_msgs/msg/GoalStatus and action_msgs/srv/CancelGoal.
"""

from __future__ import annotations

import os
from enum import IntEnum
from typing import Any, Final

from yarpy.peers.ros2.qos import PROFILES, Qos

CANCEL_TYPE: Final = "action_msgs/srv/CancelGoal"
STATUS_TYPE: Final = "action_msgs/msg/GoalStatusArray"
STATUS_QOS: Final[Qos] = PROFILES["latched"]


class Status(IntEnum):
    """Of a goal."""

    UNKNOWN = 0
    ACCEPTED = 1
    EXECUTING = 2
    CANCELING = 3
    SUCCEEDED = 4
    CANCELED = 5
    ABORTED = 6

    @property
    def is_over(self) -> bool:
        """Return whether nothing changes any more."""
        return self >= Status.SUCCEEDED


class Refusal(IntEnum):
    """The reason why a goal is not canceled."""

    NONE = 0
    REJECTED = 1
    UNKNOWN_GOAL = 2
    TERMINATED = 3


def place(action: str, what: str) -> str:
    """Return the name of a service or topic of an action."""
    return f"{action}/_action/{what}"


def new_id() -> bytes:
    """Return the 16 bytes by which a new goal is known: a random UUID."""
    data = bytearray(os.urandom(16))
    data[6] = data[6] & 0x0F | 0x40
    data[8] = data[8] & 0x3F | 0x80
    return bytes(data)


def id_of(uuid: Any) -> bytes:
    """Return the 16 bytes of an object of unique_identifier_msgs/msg/UUID."""
    return bytes(bytearray(uuid.uuid))


def uuid_of(goal: bytes) -> dict[str, Any]:
    """Return the fields of a UUID."""
    return {"uuid": [*goal]}


def stamp_of(nanoseconds: int) -> dict[str, int]:
    """Return the fields of a builtin_interfaces/msg/Time."""
    seconds, rest = divmod(nanoseconds, 1_000_000_000)
    return {"sec": seconds, "nanosec": rest}


def nanoseconds_of(stamp: Any) -> int:
    """Return the nanoseconds of an object of builtin_interfaces/msg/Time."""
    return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)
