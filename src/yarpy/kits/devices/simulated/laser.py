"""SimulatedLaser: a laser scanner without hardware; fakeLaser in C++.

    SimulatedLaser("use_square_trap")       in the middle of a square room
    SimulatedLaser("use_constant", distance=0.5)

Rules: what it sees is one of `SCENES`, under the names of C++ (`use_mapfile` is missing). Beyond
what it can measure, ranges are infinite.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, inf, radians, sin
from typing import Final

#: Half the width of the square room, metres.
WALL: Final = 1.5
_MOST: Final = 100_000  # ranges in a scan


class SimulatedLaser:
    """A scanner that stands still, see `laser.interface`.

    scene: what is around it. angles: of the first range and behind the last, degrees. distances:
    what it can measure, metres. step: degrees. distance: that of the scene `use_constant`.
    Raises ValueError for a scene that is none, and settings that make no scan.
    """

    info = "a simulated laser scanner"

    def __init__(
        self,
        scene: str = "use_pattern",
        *,
        angles: tuple[float, float] = (0.0, 360.0),
        distances: tuple[float, float] = (0.1, 3.5),
        step: float = 1.0,
        distance: float = 1.0,
    ) -> None:
        if scene not in SCENES:
            raise ValueError(f'the laser has no scene "{scene}": {", ".join(SCENES)}')
        lowest, highest = angles
        if not 0.0 < step <= highest - lowest <= 360.0 or (highest - lowest) / step > _MOST:
            raise ValueError(f"no scan goes from {lowest} to {highest} degrees by {step}")
        if not 0.0 <= distances[0] < distances[1]:
            raise ValueError(f"no laser measures from {distances[0]} to {distances[1]} metres")
        self.angles = (lowest, highest)
        self.distances = distances
        self.step = step
        self._scene = SCENES[scene]
        self._constant = distance

    def ranges(self) -> list[float]:
        """Metres, one for each step."""
        (lowest, highest), (nearest, farthest) = self.angles, self.distances
        seen = (
            self._scene(number, radians(lowest + number * self.step), self._constant)
            for number in range(round((highest - lowest) / self.step))
        )
        return [one if nearest <= one <= farthest else inf for one in seen]

    def condition(self) -> str:
        """It works."""
        return "in use"


def _room(number: int, angle: float, constant: float) -> float:
    return WALL / max(abs(cos(angle)), abs(sin(angle)))


#: What can be around it: the distance, by the number of the range, its angle and a constant.
SCENES: Final[dict[str, Callable[[int, float, float], float]]] = {
    "no_obstacles": lambda number, angle, constant: inf,
    "use_constant": lambda number, angle, constant: constant,
    "use_pattern": lambda number, angle, constant: number / 100.0,
    "use_square_trap": _room,
}
