"""SimulatedLaser: a laser scanner without hardware; fakeLaser in C++.

    SimulatedLaser("use_square_trap")       in the middle of a square room
    SimulatedLaser("use_constant", distance=0.5)
    SimulatedLaser("use_mapfile", grid=load_grid("kitchen.map")).place = (1.0, 2.0, 90.0)

Rules: what it sees is one of `SCENES`, under the names of C++, or a map. Beyond what it can
measure, and beyond the map, ranges are infinite. In a map a beam ends where the first cell begins
that is not free.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, inf, radians, sin
from typing import Final

from yarpy.kits.devices.interfaces.grid import Grid

#: Half the width of the square room, metres.
WALL: Final = 1.5
_MOST: Final = 100_000  # ranges in a scan


class SimulatedLaser:
    """A scanner that stands still, see `laser.interface`.

    scene: what is around it. angles: of the first range and behind the last, degrees. distances:
    what it can measure, metres. step: degrees. distance: that of the scene `use_constant`. grid:
    the map of the scene `use_mapfile`. Raises ValueError for no such scene, and for settings that
    make no scan; DecodeError for a map that is none.

    place: where it is in the map, metres and degrees; may be changed at any time.
    """

    info = "a simulated laser scanner"
    place: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __init__(
        self,
        scene: str = "use_pattern",
        *,
        angles: tuple[float, float] = (0.0, 360.0),
        distances: tuple[float, float] = (0.1, 3.5),
        step: float = 1.0,
        distance: float = 1.0,
        grid: Grid | None = None,
    ) -> None:
        if scene not in (*SCENES, _MAP):
            raise ValueError(f'the laser has no scene "{scene}": {", ".join((*SCENES, _MAP))}')
        if scene == _MAP and grid is None:
            raise ValueError(f'the scene "{scene}" needs a map')
        lowest, highest = angles
        if not 0.0 < step <= highest - lowest <= 360.0 or (highest - lowest) / step > _MOST:
            raise ValueError(f"no scan goes from {lowest} to {highest} degrees by {step}")
        if not 0.0 <= distances[0] < distances[1]:
            raise ValueError(f"no laser measures from {distances[0]} to {distances[1]} metres")
        self.angles = (lowest, highest)
        self.distances = distances
        self.step = step
        self._scene = SCENES.get(scene)
        self._map = _Map(grid) if grid is not None and scene == _MAP else None
        self._constant = distance

    def ranges(self) -> list[float]:
        """Metres, one for each step."""
        (lowest, highest), (nearest, farthest) = self.angles, self.distances
        angles = [
            radians(lowest + number * self.step)
            for number in range(round((highest - lowest) / self.step))
        ]
        if self._map is not None:
            x, y, turned = self.place
            seen = [self._map.seen(x, y, radians(turned) + each, farthest) for each in angles]
        else:
            scene = self._scene or _nothing
            seen = [scene(number, each, self._constant) for number, each in enumerate(angles)]
        return [one if nearest <= one <= farthest else inf for one in seen]

    def condition(self) -> str:
        """Return the condition of the scanner: it works."""
        return "in use"


def _room(number: int, angle: float, constant: float) -> float:
    return WALL / max(abs(cos(angle)), abs(sin(angle)))


def _nothing(number: int, angle: float, constant: float) -> float:
    return inf


class _Map:
    """A map, and how far one sees in it. Raises DecodeError."""

    def __init__(self, grid: Grid) -> None:
        self._cells = grid.cells().tolist()
        self._width, self._height, self._resolution = grid.width, grid.height, grid.resolution
        self._corner = grid.x, grid.y
        turned = radians(grid.theta)
        self._turned, self._along, self._across = turned, cos(turned), sin(turned)

    def seen(self, x: float, y: float, angle: float, farthest: float) -> float:
        """Return the metres to the first cell that is not free; infinite if there is none."""
        x, y = x - self._corner[0], y - self._corner[1]
        # In cells from the lower left corner of the map, along its sides.
        right = (x * self._along + y * self._across) / self._resolution
        up = (y * self._along - x * self._across) / self._resolution
        angle -= self._turned
        sides = ((right, cos(angle), self._width), (up, sin(angle), self._height))
        first, last = 0.0, farthest / self._resolution
        for start, way, size in sides:
            if abs(way) < 1e-12:
                if not 0 <= start < size:
                    return inf
                continue
            enter, leave = sorted((-start / way, (size - start) / way))
            first, last = max(first, enter), min(last, leave)
        # From one side of a cell to the next, wherever the beam is inside the map.
        while first < last:
            ends = [last]
            at = []
            for start, way, _ in sides:
                place = start + way * (first + 1e-9)
                cell = int(place // 1)
                at.append(cell)
                if abs(way) >= 1e-12:
                    ends.append((cell + (way > 0) - start) / way)
            column, row = at[0], self._height - 1 - at[1]
            if not (0 <= column < self._width and 0 <= row < self._height):
                return inf
            if self._cells[row][column]:
                return first * self._resolution
            first = max(min(ends), first + 1e-9)
        return inf


_MAP: Final = "use_mapfile"

#: What can be around it: the distance, by the number of the range, its angle and a constant.
SCENES: Final[dict[str, Callable[[int, float, float], float]]] = {
    "no_obstacles": lambda number, angle, constant: inf,
    "use_constant": lambda number, angle, constant: constant,
    "use_pattern": lambda number, angle, constant: number / 100.0,
    "use_square_trap": _room,
}
