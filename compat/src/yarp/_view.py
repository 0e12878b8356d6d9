"""View: what the interfaces of a device have in common.

Rules: a view looks at a board, which has the members of `yarpy.devices` (`encoders()`,
`position_move(joints, positions)` ...). Methods of C++ exist for one joint, for some and for all;
results go into the last argument. What the device refuses, or does not have, is False.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import yarpy
from yarp._log import say
from yarp._numbers import store

FAILURES = (yarpy.YarpError, AttributeError, IndexError, KeyError, NotImplementedError)


class View:
    """A device, seen through one interface."""

    def __init__(self, board: Any = None) -> None:
        self._board = board

    def getAxes(self, ax: Any = None) -> int:
        """The number of joints."""
        count = len(self._board.axis_names)
        if ax is not None:
            store(ax, [count])
        return count

    def _values(self, member: str) -> Sequence[Any]:
        """The values of all joints: measured, or set."""
        found = getattr(self._board, member)
        values: Sequence[Any] = found() if callable(found) else found
        return values

    def _get(self, member: str, arguments: tuple[Any, ...], part: int | None = None) -> bool:
        """Store values: `(target)` of all, `(joint, target)`, `(count, joints, target)`.

        part: which number of each value, where values are pairs.
        """
        return self._tell(lambda: self._fill(self._values(member), arguments, part))

    def _fill(self, values: Sequence[Any], arguments: tuple[Any, ...], part: int | None) -> None:
        numbers = values if part is None else [value[part] for value in values]
        if len(arguments) == 2:
            store(arguments[1], [numbers[_joint(arguments[0], len(numbers))]])
        elif len(arguments) == 3:
            joints = [*arguments[1]][: arguments[0]]
            store(arguments[2], [numbers[_joint(joint, len(numbers))] for joint in joints])
        else:
            store(arguments[0], numbers)

    def _one(self, member: str, joint: int) -> float:
        """The value of one joint as the result, 0 if there is none."""
        found: list[float] = [0.0]
        self._get(member, (joint, found))
        return float(found[0])

    def _do(self, method: str, arguments: tuple[Any, ...]) -> bool:
        """Act: `(values)` on all joints, `(joint, value)`, `(count, joints, values)`."""

        def act() -> None:
            joints, values = self._split(arguments)
            getattr(self._board, method)(joints, values)

        return self._tell(act)

    def _change(self, member: str, arguments: tuple[Any, ...]) -> bool:
        """Change settings, by the same arguments."""

        def act() -> None:
            joints, values = self._split(arguments)
            changed = [*self._values(member)]
            for joint, value in zip(joints, values, strict=True):
                changed[_joint(joint, len(changed))] = value
            setattr(self._board, member, changed)

        return self._tell(act)

    def _split(self, arguments: tuple[Any, ...]) -> tuple[list[int], list[Any]]:
        if len(arguments) == 2:
            return [_joint(arguments[0], self.getAxes())], [arguments[1]]
        if len(arguments) == 3:
            joints = [*arguments[1]][: arguments[0]]
            return joints, [*arguments[2]][: arguments[0]]
        values = [*arguments[0]][: self.getAxes()]
        return [*range(len(values))], values

    def _joints(self, arguments: tuple[Any, ...]) -> list[int]:
        """`()` all, `(joint)`, `(count, joints)`."""
        if not arguments:
            return [*range(self.getAxes())]
        if len(arguments) == 1:
            return [_joint(arguments[0], self.getAxes())]
        return [*arguments[1]][: arguments[0]]

    def _tell(self, action: Callable[[], object]) -> bool:
        """Return whether it went well; the log says what did not."""
        try:
            return action() is not False
        except FAILURES as error:
            say("ERROR", f"|yarp.dev.{type(self).__name__}| {error}")
            return False


def _joint(joint: int, count: int) -> int:
    try:
        inside = 0 <= joint < count
    except TypeError:
        raise TypeError(f"a joint is a number, not {joint!r}") from None
    if not inside:
        raise IndexError(f"no joint {joint} (there are 0 to {count - 1})")
    return joint
