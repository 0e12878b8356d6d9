"""Axis: the fixed properties of a joint - its name, its range, its top speed.

Angles in degrees, positions of a sliding axis in millimetres.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final


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


#: The head of an iCub: three joints of the neck, three of the eyes.
ICUB_HEAD: Final = (
    Axis("neck_pitch", -40.0, 30.0),
    Axis("neck_roll", -70.0, 60.0),
    Axis("neck_yaw", -55.0, 55.0),
    Axis("eyes_tilt", -35.0, 30.0, speed=150.0, acceleration=3000.0, top_speed=500.0),
    Axis("eyes_version", -50.0, 50.0, speed=150.0, acceleration=3000.0, top_speed=500.0),
    Axis("eyes_vergence", 0.0, 50.0, speed=150.0, acceleration=3000.0, top_speed=500.0),
)
