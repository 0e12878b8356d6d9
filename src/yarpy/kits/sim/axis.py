"""Axis: the fixed properties of a joint - its name, its range, its top speed.

Angles in degrees, positions of a sliding axis in millimetres.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Axis:
    """One joint. `top_speed` and `top_acceleration` are the limits of its motor."""

    name: str
    lowest: float
    highest: float
    speed: float = 100.0  # default for trajectories
    acceleration: float = 1000.0
    top_speed: float = 300.0
    top_acceleration: float = 20_000.0
    kind: str = "revolute"

    def __post_init__(self) -> None:
        if not self.lowest <= self.highest:
            raise ValueError(f"axis {self.name}: its range is from {self.lowest} to {self.highest}")
