"""MapGrid2D: a map of cells, as `yarpy.devices.Grid`.

Rules: a cell is a pair of numbers, x to the right and y down, from the upper left corner. Flags are
numbers of `Grid`. What is outside is False or -1.
"""

from __future__ import annotations

import math
from typing import Any

import yarpy
from yarp._log import say
from yarp._numbers import store
from yarp._portable import Portable
from yarpy.kits import devices
from yarpy.kits.devices.interfaces.grid_file import coloured, flags_of

Cell = Any  # a pair of numbers
_UNSEEN = 255


class MapGrid2D(Portable):
    """A map: `setSize_in_cells(10, 5)`, then `setMapFlag((x, y), MapGrid2D.MAP_CELL_WALL)`."""

    MAP_CELL_FREE = 0
    MAP_CELL_KEEP_OUT = 1
    MAP_CELL_TEMPORARY_OBSTACLE = 2
    MAP_CELL_ENLARGED_OBSTACLE = 3
    MAP_CELL_WALL = 4
    MAP_CELL_UNKNOWN = 5

    def __init__(self) -> None:
        import numpy as np

        self._name = "unknown_map"
        self._origin = (0.0, 0.0, 0.0)
        self._resolution = 1.0
        self._flags = np.zeros((2, 2), "u1")
        self._occupied = np.zeros((2, 2), "u1")
        self._compress = True

    def _grid(self) -> devices.Grid:
        return devices.Grid.of(
            self._name, self._occupied, self._resolution, self._origin, self._flags
        )

    def _outgoing(self) -> Any:
        return self._grid().squeezed() if self._compress else self._grid()

    def _take(self, message: yarpy.Message) -> None:
        self._be(message.as_(devices.Grid))

    def _be(self, found: devices.Grid) -> None:
        self._name, self._resolution = found.name, found.resolution
        self._origin = (found.x, found.y, found.theta)
        self._flags, self._occupied = found.cells().copy(), found.occupied().copy()

    # -- what it is ---------------------------------------------------------------------------

    def getMapName(self) -> str:
        return self._name

    def setMapName(self, map_name: str) -> bool:
        self._name = map_name
        return bool(map_name)

    def width(self) -> int:
        """Cells from left to right."""
        return int(self._flags.shape[1])

    def height(self) -> int:
        """Cells from top to bottom."""
        return int(self._flags.shape[0])

    def getSize_in_cells(self, x: Any, y: Any) -> None:
        store(x, [self.width()])
        store(y, [self.height()])

    def setSize_in_cells(self, x: int, y: int) -> bool:
        """Begin a new map of this size: free, and nobody has seen it."""
        import numpy as np

        if x < 1 or y < 1:
            return False
        self._flags = np.zeros((y, x), "u1")
        self._occupied = np.full((y, x), 255, "u1")
        return True

    def getSize_in_meters(self, x: Any, y: Any) -> None:
        store(x, [self.width() * self._resolution])
        store(y, [self.height() * self._resolution])

    def setSize_in_meters(self, x: float, y: float) -> bool:
        """Begin a new map of this size."""
        return self.setSize_in_cells(round(x / self._resolution), round(y / self._resolution))

    def getResolution(self, resolution: Any = None) -> float:
        """Metres of a cell."""
        if resolution is not None:
            store(resolution, [self._resolution])
        return self._resolution

    def setResolution(self, resolution: float) -> bool:
        if resolution <= 0:
            return False
        self._resolution = float(resolution)
        return True

    def getOrigin(self, x: Any, y: Any, theta: Any) -> None:
        """Where its lower left corner is: metres and degrees."""
        for place, value in zip((x, y, theta), self._origin, strict=True):
            store(place, [value])

    def setOrigin(self, x: float, y: float, theta: float) -> bool:
        self._origin = (float(x), float(y), float(theta))
        return True

    def enable_map_compression_over_network(self, val: bool) -> bool:
        self._compress = bool(val)
        return True

    # -- its cells ----------------------------------------------------------------------------

    def _at(self, cell: Cell) -> tuple[int, int] | None:
        x, y = (int(each) for each in (cell[0], cell[1]))
        inside = 0 <= x < self.width() and 0 <= y < self.height()
        return (y, x) if inside else None

    def getMapFlag(self, cell: Cell, flag: Any = None) -> Any:
        """Return the flag of a cell, -1 outside; with a place for it, whether it is inside."""
        at = self._at(cell)
        if flag is None:
            return -1 if at is None else int(self._flags[at])
        if at is not None:
            store(flag, [int(self._flags[at])])
        return at is not None

    def setMapFlag(self, cell: Cell, flag: int) -> bool:
        at = self._at(cell)
        if at is None or not 0 <= flag <= self.MAP_CELL_UNKNOWN:
            return False
        self._flags[at] = flag
        return True

    def getOccupancyData(self, cell: Cell, occupancy: Any = None) -> Any:
        """Return the percentage of a cell, -1 if it is unknown; as `getMapFlag` with a place."""
        at = self._at(cell)
        found = -1.0 if at is None or self._occupied[at] > 100 else float(self._occupied[at])
        if occupancy is None:
            return found
        if at is not None:
            store(occupancy, [found])
        return at is not None

    def setOccupancyData(self, cell: Cell, occupancy: float) -> bool:
        at = self._at(cell)
        if at is None or occupancy > 100:
            return False
        self._occupied[at] = 255 if occupancy < 0 else round(occupancy)
        return True

    def isFree(self, cell: Cell) -> bool:
        return bool(self.getMapFlag(cell) == self.MAP_CELL_FREE)

    def isNotFree(self, cell: Cell) -> bool:
        at = self._at(cell)
        return at is not None and self._flags[at] != self.MAP_CELL_FREE

    def isKeepOut(self, cell: Cell) -> bool:
        return bool(self.getMapFlag(cell) == self.MAP_CELL_KEEP_OUT)

    def isWall(self, cell: Cell) -> bool:
        return bool(self.getMapFlag(cell) == self.MAP_CELL_WALL)

    def clearMapTemporaryFlags(self) -> None:
        """Free the cells of temporary and enlarged obstacles."""
        flags = self._flags
        for flag in (self.MAP_CELL_TEMPORARY_OBSTACLE, self.MAP_CELL_ENLARGED_OBSTACLE):
            flags[flags == flag] = self.MAP_CELL_FREE

    def enlargeObstacles(self, size: float) -> bool:
        """Mark the free cells around what is not free, so many metres; 0 frees them again."""
        import numpy as np

        flags = self._flags
        if size <= 0:
            flags[flags == self.MAP_CELL_ENLARGED_OBSTACLE] = self.MAP_CELL_FREE
            return True
        for _ in range(math.ceil(size / self._resolution)):
            wide = np.pad(flags != self.MAP_CELL_FREE, 1)
            height, width = flags.shape
            near = [wide[y : y + height, x : x + width] for y in range(3) for x in range(3)]
            free = flags == self.MAP_CELL_FREE
            flags[free & np.logical_or.reduce(near)] = self.MAP_CELL_ENLARGED_OBSTACLE
        return True

    def crop(self, left: int, top: int, right: int, bottom: int) -> bool:
        """Keep a rectangle of cells, without the last column and row; a negative side is where
        somebody has seen something. The origin moves along."""
        import numpy as np

        rows, columns = np.nonzero(self._occupied != _UNSEEN)
        if len(rows):
            left = int(columns.min()) if left < 0 else left
            right = int(columns.max()) if right < 0 else right
            top = int(rows.min()) if top < 0 else top
            bottom = int(rows.max()) + 1 if bottom < 0 else bottom
        if not (0 <= left < right <= self.width() and 0 <= top < bottom <= self.height()):
            return False
        x, y, theta = self._origin
        below = self.height() - bottom
        self._origin = (x + left * self._resolution, y + below * self._resolution, theta)
        self._flags = self._flags[top:bottom, left:right].copy()
        self._occupied = self._occupied[top:bottom, left:right].copy()
        return True

    # -- as pictures --------------------------------------------------------------------------

    def getMapImage(self, image: Any) -> bool:
        """Become a picture of the cells: free ones white, walls black, the rest in colour."""
        image._fill(yarpy.Image(coloured(self._flags)))
        return True

    def setMapImage(self, image: Any) -> bool:
        """Take the cells of a picture of this size; what is no colour of a map is unknown."""
        picture = image._image().converted("rgb").array
        if picture.shape[:2] != self._flags.shape:
            say("ERROR", "|yarp.dev.MapGrid2D| the picture has another size: setSize_in_cells")
            return False
        self._flags = flags_of(picture)
        return True

    def getOccupancyGrid(self, image: Any) -> bool:
        """Become a picture of the percentages as they are, 255 where nobody has been."""
        image._fill(yarpy.Image(self._occupied))
        return True

    def setOccupancyGrid(self, image: Any) -> bool:
        """Take the percentages of a picture of this size."""
        picture = image._image().converted("mono").array
        if picture.shape != self._occupied.shape:
            say("ERROR", "|yarp.dev.MapGrid2D| the picture has another size: setSize_in_cells")
            return False
        self._occupied = picture.copy()
        return True

    def isIdenticalTo(self, otherMap: MapGrid2D) -> bool:
        """Return whether everything is the same."""
        mine = (self._name, self._origin, self._resolution)
        if mine != (otherMap._name, otherMap._origin, otherMap._resolution):
            return False
        pairs = ((self._flags, otherMap._flags), (self._occupied, otherMap._occupied))
        return all(a.shape == b.shape and bool((a == b).all()) for a, b in pairs)

    def loadFromFile(self, map_filename: str) -> bool:
        """Read a .map file of YARP, with the pictures that it names."""
        try:
            self._be(devices.load_grid(map_filename))
        except (OSError, yarpy.DecodeError) as error:
            say("ERROR", f"|yarp.dev.MapGrid2D| {error}")
            return False
        return True

    def saveToFile(self, map_filename: str) -> bool:
        """Write a .map file of YARP, and three beside it that are named after the map."""
        try:
            devices.save_grid(self._grid(), map_filename)
        except (OSError, ValueError) as error:
            say("ERROR", f"|yarp.dev.MapGrid2D| {error}")
            return False
        return True
