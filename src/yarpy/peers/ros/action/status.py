"""The states of a goal of actionlib, and how an action is spoken of: five topics.

Rules: pure. The numbers are those of actionlib_msgs/GoalStatus. Times are in nanoseconds.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Any, Final

from yarpy.errors import DecodeError
from yarpy.peers.ros.message.library import default_library
from yarpy.peers.ros.message.message import Message, Time
from yarpy.peers.ros.message.parse import type_name

CANCEL_TYPE: Final = "actionlib_msgs/GoalID"
STATUS_TYPE: Final = "actionlib_msgs/GoalStatusArray"


class Status(IntEnum):
    """Of a goal."""

    PENDING = 0
    ACTIVE = 1
    PREEMPTED = 2  # canceled while it was carried out
    SUCCEEDED = 3
    ABORTED = 4
    REJECTED = 5
    PREEMPTING = 6
    RECALLING = 7
    RECALLED = 8  # canceled before it was begun
    LOST = 9

    @property
    def is_over(self) -> bool:
        """Return whether nothing changes any more."""
        return self in _OVER


_OVER: Final = frozenset(
    (*(Status.PREEMPTED, Status.SUCCEEDED, Status.ABORTED), *(Status.REJECTED, Status.RECALLED))
)


@dataclass(frozen=True, slots=True)
class Types:
    """The classes of an action: what it is declared with, and the messages of its topics."""

    name: str
    Goal: type[Message]
    Result: type[Message]
    Feedback: type[Message]
    ActionGoal: type[Message]
    ActionResult: type[Message]
    ActionFeedback: type[Message]


def types_of(name: str) -> Types:
    """Return the types of the action package/Name; package/NameAction means the same. Raises
    UnknownType, DecodeError."""
    plain = type_name(name)
    plain = plain.removesuffix("Action") if not plain.endswith("/Action") else plain
    load = default_library().message
    parts = ("Goal", "Result", "Feedback", "ActionGoal", "ActionResult", "ActionFeedback")
    return Types(plain, *(load(f"{plain}{part}") for part in parts))


def made(kind: type[Message], value: Any) -> Any:
    """Return an object of a type, of a list or dict of its fields, or an empty one for None. Raises
    TypeError, ValueError, DecodeError."""
    if value is None:
        return kind()
    if isinstance(value, Message):
        if value._type != kind._type:
            raise TypeError(f"{kind._type} is expected here, not {value._type}")
        return value
    return kind.from_bottle(value)


def status_of(number: int) -> Status:
    """Return the status of a number. Raises DecodeError."""
    if number not in _NUMBERS:
        raise DecodeError(f"a goal with the status {number}, which there is not")
    return Status(number)


_NUMBERS: Final = frozenset(map(int, Status))


def stamp_of(seconds: float) -> Time:
    """Return seconds as a time of ROS."""
    return Time.from_sec(seconds)
