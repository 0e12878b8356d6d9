"""Reference: where a joint should be at this moment, given its commands.

    pos     minimum-jerk trajectory from here to a target
    vel     a speed, reached with the reference acceleration
    posd    a position now; a distant one is reached as fast as the motor allows
    mix     trajectories and speeds, whichever was commanded last
    idl     idle: no reference is followed

Rules: no clock; only `step(dt)` advances time. The reference never leaves the limits and is
continuous in position and speed, even when one command interrupts another.
"""

from __future__ import annotations

import math
from typing import Final, Literal

from yarpy.kits.sim.axis import Axis

MODES: Final = ("pos", "vel", "posd", "mix", "idl")

# Peak speed and peak acceleration of a minimum-jerk move of length 1 in time 1.
_PEAK_SPEED = 1.875
_PEAK_ACCELERATION = 10 / math.sqrt(3)
_SHORTEST = 0.05  # seconds that even the smallest move takes


class Move:
    """A fifth-order polynomial from a position, speed and acceleration to rest at `target`."""

    def __init__(
        self, start: float, speed: float, acceleration: float, target: float, duration: float
    ) -> None:
        way = target - start
        c1, c2 = speed * duration, acceleration * duration**2 / 2
        self.target = target
        self.duration = duration
        self.time = 0.0
        self._coefficients = (
            start,
            c1,
            c2,
            10 * way - 6 * c1 - 3 * c2,
            -15 * way + 8 * c1 + 3 * c2,
            6 * way - 3 * c1 - c2,
        )

    @property
    def done(self) -> bool:
        return self.time >= self.duration

    def at(self, time: float) -> tuple[float, float, float]:
        """Position, speed and acceleration, `time` seconds after the start."""
        if time >= self.duration:
            return self.target, 0.0, 0.0
        c0, c1, c2, c3, c4, c5 = self._coefficients
        length = self.duration
        s = time / length
        position = c0 + s * (c1 + s * (c2 + s * (c3 + s * (c4 + s * c5))))
        speed = c1 + s * (2 * c2 + s * (3 * c3 + s * (4 * c4 + s * 5 * c5)))
        acceleration = 2 * c2 + s * (6 * c3 + s * (12 * c4 + s * 20 * c5))
        return position, speed / length, acceleration / length**2


class Reference:
    """The reference of one joint: `position` and `speed`, moved by `step`."""

    def __init__(self, axis: Axis, position: float = 0.0) -> None:
        self.axis = axis
        self.limits = (axis.lowest, axis.highest)
        self.reference_speed = axis.speed
        self.reference_acceleration = axis.acceleration
        self.mode = "pos"
        self.position = min(max(position, axis.lowest), axis.highest)
        self.speed = 0.0
        self.acceleration = 0.0
        self.target = self.position  # of the last trajectory
        self.wanted_speed = 0.0  # as last commanded
        self.direct_target = self.position
        self._doing: Literal["coast", "move", "direct"] = "coast"
        self._coast = 0.0  # the target speed of `coast`
        self._move: Move | None = None

    # -- commands -----------------------------------------------------------------------------

    def switch(self, mode: str) -> None:
        """Change the mode; a moving joint comes to rest. ValueError for an unsupported mode."""
        mode = "idl" if mode == "fidl" else mode
        if mode not in MODES:
            raise ValueError(f"{self.axis.name} has no mode {mode}; it has {' '.join(MODES)}")
        if mode != self.mode:
            self.mode = mode
            self.stop()

    def move_to(self, target: float) -> None:
        """Begin a trajectory; its end is clipped to the limits."""
        self._check("pos", "mix")
        lowest, highest = self.limits
        self.target = min(max(target, lowest), highest)
        way = abs(self.target - self.position)
        speed = min(max(abs(self.reference_speed), 1e-3), self.axis.top_speed)
        acceleration = max(abs(self.reference_acceleration), 1e-3)
        duration = max(
            _SHORTEST,
            _PEAK_SPEED * way / speed,
            math.sqrt(_PEAK_ACCELERATION * way / acceleration),
            4 * abs(self.speed) / acceleration,
        )
        self._move = Move(self.position, self.speed, self.acceleration, self.target, duration)
        self._doing = "move"

    def move_at(self, speed: float) -> None:
        """Turn at this speed until the next command or the limit."""
        self._check("vel", "mix")
        top = self.axis.top_speed
        self.wanted_speed = self._coast = min(max(speed, -top), top)
        self._doing = "coast"

    def go_to(self, position: float) -> None:
        """Go there directly."""
        self._check("posd")
        lowest, highest = self.limits
        self.direct_target = min(max(position, lowest), highest)
        self._doing = "direct"

    def stop(self) -> None:
        """Come to rest."""
        self._doing = "coast"
        self._coast = self.wanted_speed = 0.0

    def place(self, position: float) -> None:
        """Be at rest here, without a trajectory."""
        self.position = self.target = self.direct_target = position
        self.speed = self.acceleration = 0.0
        self.stop()

    def _check(self, *modes: str) -> None:
        if self.mode not in modes:
            raise ValueError(
                f"{self.axis.name} is in mode {self.mode}: switch it to {modes[0]} "
                f"before (set icmd cmod JOINT {modes[0]})"
            )

    # -- time ---------------------------------------------------------------------------------

    @property
    def done(self) -> bool:
        """True while no trajectory is running."""
        return self._doing != "move"

    @property
    def still(self) -> bool:
        """True while the passing of time changes nothing."""
        if self._doing == "direct":
            return self.speed == 0 and self.position == self.direct_target
        return self._doing == "coast" and self.speed == 0 == self._coast

    def step(self, dt: float) -> None:
        """Let `dt` seconds pass."""
        if self._doing == "move":
            self._follow(dt)
        elif self._doing == "direct":
            reach = self.axis.top_speed * dt
            way = min(max(self.direct_target - self.position, -reach), reach)
            self._set(self.position + way, way / dt, 0.0)
        else:
            reach = max(abs(self.reference_acceleration), 1e-3) * dt
            change = min(max(self._coast - self.speed, -reach), reach)
            speed = self.speed + change
            self._set(self.position + speed * dt, speed, change / dt)
            if self.speed == 0 and self._at_limit(self._coast):
                self._coast = 0.0

    def _follow(self, dt: float) -> None:
        move = self._move
        assert move is not None
        move.time += dt
        self._set(*move.at(move.time))
        if move.done:
            self._doing, self._coast = "coast", 0.0

    def _set(self, position: float, speed: float, acceleration: float) -> None:
        lowest, highest = self.limits
        if not lowest <= position <= highest:
            position = min(max(position, lowest), highest)
            speed = acceleration = 0.0
        self.position, self.speed, self.acceleration = position, speed, acceleration

    def _at_limit(self, direction: float) -> bool:
        lowest, highest = self.limits
        return (direction > 0 and self.position >= highest) or (
            direction < 0 and self.position <= lowest
        )
