"""SimulatedJoypad: nobody touches it unless told; fakeJoypad in C++.

    joypad = SimulatedJoypad()
    joypad.state.axes[0] = 0.5

Rules: it has what its state has.
"""

from __future__ import annotations

import math
from typing import TypeVar

from yarpy.kits.devices.interfaces.joypad import (
    Hats,
    JoypadState,
    Numbers,
    Point,
    Points,
    Touch,
    Touches,
)
from yarpy.kits.devices.refusal import Refused

T = TypeVar("T")


class SimulatedJoypad:
    """Every member of `interfaces.joypad.Joypad`. `state` may be changed."""

    def __init__(self, state: JoypadState | None = None) -> None:
        self.state = state or JoypadState(
            buttons=[0.0] * 10,
            axes=[0.0] * 6,
            hats=[0],
            touches=[Touch()],
            sticks=[Point(), Point()],
            trackballs=[Point()],
        )

    def axis_count(self) -> int:
        """Return the number of axes."""
        return len(self.state.axes)

    def button_count(self) -> int:
        """Return the number of buttons."""
        return len(self.state.buttons)

    def trackball_count(self) -> int:
        """Return the number of trackballs."""
        return len(self.state.trackballs)

    def hat_count(self) -> int:
        """Return the number of hats."""
        return len(self.state.hats)

    def surface_count(self) -> int:
        """Return the number of surfaces."""
        return len(self.state.touches)

    def stick_count(self) -> int:
        """Return the number of sticks."""
        return len(self.state.sticks)

    def stick_freedom(self, stick: int) -> int:
        """Return 2."""
        self._one(self.state.sticks, stick, "stick")
        return 2

    def button(self, button: int) -> float:
        """Return how far it is pressed."""
        return float(self._one(self.state.buttons, button, "button"))

    def trackball(self, trackball: int) -> Point:
        """Return how it has moved."""
        return self._one(self.state.trackballs, trackball, "trackball")

    def hat(self, hat: int) -> int:
        """Return where it is pressed."""
        return int(self._one(self.state.hats, hat, "hat"))

    def axis(self, axis: int) -> float:
        """Return where it is."""
        return float(self._one(self.state.axes, axis, "axis"))

    def stick(self, stick: int, mode: int = 1) -> tuple[Point, int]:
        """Return where it is."""
        found = self._one(self.state.sticks, stick, "stick")
        if mode == 0:
            found = Point(math.hypot(found.x, found.y), math.atan2(found.y, found.x))
        return found, mode

    def touch(self, surface: int) -> list[Point]:
        """Return the fingers."""
        return self._one(self.state.touches, surface, "touch surface").touches

    def axes(self) -> Numbers:
        """Return all."""
        return Numbers([*self.state.axes])

    def buttons(self) -> Numbers:
        """Return all."""
        return Numbers([*self.state.buttons])

    def hats(self) -> Hats:
        """Return all."""
        return Hats([*self.state.hats])

    def sticks(self) -> Points:
        """Return all."""
        return Points([*self.state.sticks])

    def trackballs(self) -> Points:
        """Return all."""
        return Points([*self.state.trackballs])

    def touches(self) -> Touches:
        """Return all."""
        return Touches([*self.state.touches])

    def everything(self) -> JoypadState:
        """Return all of all."""
        return self.state

    def _one(self, items: list[T], index: int, what: str) -> T:
        if not 0 <= index < len(items):
            raise Refused(f"no {what} {index} (there are {len(items)})")
        return items[index]
