"""The types of an action of ROS 2, from what it is declared with: goal, result and feedback.

    X_SendGoal, X_GetResult     services            X_Goal, X_Result, X_Feedback    what is declared
    X_FeedbackMessage           a topic's messages

Rules: pure. The names have three parts, package/action/X_Goal, since hashes and keys spell them so.
The texts are those that ROS 2 makes of a file `.action`.
"""

from __future__ import annotations

import re
from typing import Final

from yarpy.errors import DecodeError
from yarpy.peers.ros.message.parse import type_name

MESSAGES: Final = ("Goal", "Result", "Feedback", "FeedbackMessage")
SERVICES: Final = ("SendGoal", "GetResult")

_WORD: Final = r"[A-Za-z][A-Za-z0-9_]*+"
_ACTION = re.compile(rf"({_WORD})/action/({_WORD})")
_UUID: Final = "unique_identifier_msgs/UUID goal_id\n"


def plain_name(name: str) -> str:
    """Return package/Type of any way to write it; of a type of an action package/action/Type.
    Raises DecodeError for others."""
    return name if _ACTION.fullmatch(name) else type_name(name)


def action_name(name: str) -> str:
    """Return package/action/Name of the name of an action, with or without the word between. Raises
    DecodeError."""
    found = _ACTION.fullmatch(name)
    if found is None:
        package, _, plain = type_name(name).partition("/")
        return f"{package}/action/{plain}"
    return name


def part_of(name: str) -> tuple[str, str] | None:
    """Return the action that a type belongs to, and which of its parts it is; None for others.

    >>> part_of("example_interfaces/action/Fibonacci_SendGoal")
    ('example_interfaces/action/Fibonacci', 'SendGoal')
    """
    if "/action/" not in name:
        return None
    action, _, part = name.rpartition("_")
    return (action, part) if part in MESSAGES + SERVICES else None


def texts_of(name: str, text: str) -> dict[str, str]:
    """Return the texts of the six types of the action package/action/Name, by full name. Raises
    DecodeError for a text that has not three parts with `---` between them."""
    parts: list[str] = [""]
    for line in text.splitlines():
        if line.startswith("---"):
            parts.append("")
        else:
            parts[-1] += f"{line}\n"
    if len(parts) != 3:
        raise DecodeError(f"{name}: an action has goal, result and feedback, with --- between them")
    goal, result, feedback = parts
    return {
        f"{name}_Goal": goal,
        f"{name}_Result": result,
        f"{name}_Feedback": feedback,
        f"{name}_SendGoal": (
            f"{_UUID}{name}_Goal goal\n---\nbool accepted\nbuiltin_interfaces/Time stamp\n"
        ),
        f"{name}_GetResult": f"{_UUID}---\nint8 status\n{name}_Result result\n",
        f"{name}_FeedbackMessage": f"{_UUID}{name}_Feedback feedback\n",
    }
