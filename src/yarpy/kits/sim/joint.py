"""Joint: a motor that follows its reference, within its limits.

Rules: no clock; only `step(dt)` advances time. The joint follows its reference as a critically
damped second-order system, solved exactly, so that the result does not depend on the step length;
acceleration, speed and range have hard limits.
"""

from __future__ import annotations

import math
from typing import Final

from yarpy.kits.sim.axis import Axis
from yarpy.kits.sim.reference import Reference

STIFFNESS: Final = 200.0  # rad/s, of the closed loop: slower ones swing with controllers in C++
FRICTION: Final = 5.0  # 1/s, when nothing drives the joint

_NEAR = 1e-6  # degrees, and degrees per second, within which the joint has arrived
_SLOW = 1e-3  # degrees per second at which friction holds an idle joint


class Joint:
    """The position of an axis (`position`), its velocity, and the reference that it follows."""

    def __init__(self, axis: Axis, position: float = 0.0) -> None:
        self.axis = axis
        self.reference = Reference(axis, position)
        self.position = self.reference.position
        self.speed = 0.0
        self.acceleration = 0.0

    @property
    def done(self) -> bool:
        """True when the joint has arrived at the end of a trajectory."""
        reference = self.reference
        return reference.done and abs(self.position - reference.position) < 0.05

    def place(self, position: float) -> None:
        """Be at rest here, without a trajectory."""
        self.reference.place(position)
        self.position = position
        self.speed = self.acceleration = 0.0

    def step(self, dt: float) -> None:
        """Let `dt` seconds pass."""
        reference = self.reference
        position, speed = self.position, self.speed
        if reference.mode == "idl":
            self.speed *= math.exp(-FRICTION * dt)
            if abs(self.speed) < _SLOW:
                self.speed = 0.0
            self._advance(position + (speed + self.speed) / 2 * dt)
            reference.place(self.position)  # where the next mode begins
        elif self._arrived():
            self.position, self.speed = reference.position, 0.0
        else:
            self._follow(dt)
        self.acceleration = (self.speed - speed) / dt

    def _arrived(self) -> bool:
        reference = self.reference
        away = abs(self.position - reference.position)
        return reference.still and abs(self.speed) < _NEAR and away < _NEAR

    def _follow(self, dt: float) -> None:
        reference, axis = self.reference, self.axis
        error = self.position - reference.position
        rate = self.speed - reference.speed + STIFFNESS * error
        reference.step(dt)
        decay = math.exp(-STIFFNESS * dt)
        error_then = (error + rate * dt) * decay
        rate_then = rate * decay - STIFFNESS * error_then
        most, top = axis.top_acceleration * dt, axis.top_speed
        wanted = reference.speed + rate_then
        speed = min(max(wanted, self.speed - most, -top), self.speed + most, top)
        if speed == wanted:
            position = reference.position + error_then
        else:
            position = self.position + (self.speed + speed) / 2 * dt
        self.speed = speed
        self._advance(position)

    def _advance(self, position: float) -> None:
        """Go to a position, but not beyond the range."""
        lowest, highest = self.reference.limits
        # If limits are changed so that the joint is outside, it waits for its reference.
        if lowest <= self.position <= highest and not lowest <= position <= highest:
            position, self.speed = min(max(position, lowest), highest), 0.0
        self.position = position
