"""Names of the numbers of a message: those of joints, where a message tells them.

    (1.0 2.0) after (hip knee)    what ROS calls a JointState: positions, velocities, efforts
    22 or 24 lists and flags      what a control board sends as stateExt:o: joints by their numbers

Rules: pure. There is a label for each number, in the order in which `numbers_of` gives them, ""
where nothing is known; none at all if no number has one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final

from yarpy.errors import YarpError
from yarpy.kits.record.form.sensor import JOINT_PARTS
from yarpy.kits.record.recorded import Recorded

LONGEST: Final = 60  # characters of a name
_DEPTH: Final = 20
_ROS: Final = ("position", "velocity", "effort")
_ROS_PARTS: Final = 5  # of a JointState: its header, the names, and three lists
_BOARD: Final = (
    "position", "velocity", "acceleration", "motor position", "motor velocity",
    "motor acceleration", "torque", "PWM", "current", "control mode", "interaction mode",
    "temperature",
)  # fmt: skip


def labels_of(recorded: Recorded, count: int) -> list[str]:
    """Return the labels of the first `count` numbers of a message, [] if there are none."""
    try:
        value = recorded.value
    except YarpError:
        return []
    if not isinstance(value, list) or not any(isinstance(one, list) for one in value):
        return []
    walk = _board(value) if _is_board(value) else _labels(value, _DEPTH)
    found = [label for label, _ in zip(walk, range(count), strict=False)]
    return found if any(found) else []


def _is_number(value: object) -> bool:
    return isinstance(value, bool | int | float)


def _is_board(value: list[Any]) -> bool:
    """Return whether it is the state of a control board, as `form.sensor` knows it."""
    if len(value) not in JOINT_PARTS or not all(map(_is_number, value[1::2])):
        return False
    lists = value[::2]
    return all(
        isinstance(one, list) and len(one) == len(lists[0]) and all(map(_is_number, one))
        for one in lists
    )


def _board(value: list[Any]) -> Iterator[str]:
    for quantity, numbers in zip(_BOARD, value[::2], strict=False):
        for joint in range(len(numbers)):
            yield f"joint {joint} {quantity}"
        yield f"{quantity} is valid"


def _labels(value: Any, depth: int) -> Iterator[str]:
    """Yield a label for each number in a value."""
    if _is_number(value):
        yield ""
    elif not depth or isinstance(value, bytes | str):
        return
    elif isinstance(value, Mapping):
        for one in value.values():
            yield from _labels(one, depth - 1)
    elif isinstance(value, list):
        names: list[str] = []
        place = 0  # how many lists there were since the names
        quantities = _ROS if len(value) == _ROS_PARTS else ()
        for one in value:
            numbers = isinstance(one, list) and all(map(_is_number, one))
            if numbers and names and len(one) in (0, len(names)):
                more = quantities[place] if place < len(quantities) else str(place + 1)
                place += 1
                yield from (f"{name} {more}" for name in names[: len(one)])
                continue
            if isinstance(one, list) and one and all(isinstance(name, str) for name in one):
                names, place = [name[:LONGEST] for name in one], 0
            yield from _labels(one, depth - 1)
