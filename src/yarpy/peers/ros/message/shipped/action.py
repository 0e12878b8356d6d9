"""The messages of an action of ROS 1, from what it is declared with: goal, result and feedback.

Rules: pure. The names and the texts are those that ROS makes of a file `.action`.
"""

from __future__ import annotations

from yarpy.errors import DecodeError


def spelled(line: str) -> str:
    """Return a definition as in a file, of one line with `;` between its declarations."""
    return "".join(f"{part.strip()}\n" for part in line.split(";") if part.strip())


def messages_of(name: str, text: str) -> dict[str, str]:
    """Return the seven messages of the action package/Name, by name. Raises DecodeError for a text
    that has not three parts with `---` between them."""
    parts: list[str] = [""]
    for line in text.splitlines():
        if line.startswith("---"):
            parts.append("")
        else:
            parts[-1] += f"{line}\n"
    if len(parts) != 3:
        raise DecodeError(f"{name}: an action has goal, result and feedback, with --- between them")
    plain = name.rpartition("/")[2]
    found = {
        f"{name}{half}": part
        for half, part in zip(("Goal", "Result", "Feedback"), parts, strict=True)
    }
    found[f"{name}ActionGoal"] = f"Header header\nactionlib_msgs/GoalID goal_id\n{plain}Goal goal\n"
    for half in ("Result", "Feedback"):
        found[f"{name}Action{half}"] = (
            f"Header header\nactionlib_msgs/GoalStatus status\n{plain}{half} {half.lower()}\n"
        )
    found[f"{name}Action"] = "".join(
        f"{plain}Action{half} action_{half.lower()}\n" for half in ("Goal", "Result", "Feedback")
    )
    return found
