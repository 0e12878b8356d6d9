"""MapFolder: the files of a server of maps, as map2DStorage of C++ YARP has them.

    maps_collection.ini         mapfile: kitchen.map
                                mapfile: hall.map crop
    kitchen.map, ...            one map, as `interfaces/grid_file.py` says
    locations.ini               what has a name, as `interfaces/map_names.py` says

Rules: clients say which file, so it has to be one of the folder, whatever `..` and links lead to;
maps end in .map, and nothing else does. There are no more than MAP_FILES. A list is written beside
the old one, which it then replaces. `crop` leaves out borders that nobody has seen. Raises Refused
for a name that may not be, OSError, and DecodeError with the file.

Source: Map2DStorage of C++ YARP 3.9 and 4.0.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Final

from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError
from yarpy.kits.devices.interfaces.grid import UNKNOWN, Grid
from yarpy.kits.devices.interfaces.grid_file import load_grid, save_grid
from yarpy.kits.devices.interfaces.map_names import MapNames, parse_names, spell_names
from yarpy.kits.devices.refusal import Refused
from yarpy.limit import MAP_FILES, MAP_GRIDS, MAP_TEXT

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

_MAP: Final = ".map"
_PARTS: Final = (_MAP, ".yaml", ".pgm", ".ppm")  # endings of the files of a map
_FILES_OF_A_MAP: Final = 4


class MapFolder:
    """The files in `folder`, which is there."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder.resolve(strict=True)

    def has(self, name: str) -> bool:
        """Return whether there is such a file."""
        return (self._folder / name).is_file()

    def grid(self, name: str) -> Grid:
        """Return the map of a .map file."""
        return load_grid(self._map(name))

    def keep_grid(self, grid: Grid, name: str) -> None:
        """Write a map as that .map file, and three beside it that are named after the map."""
        place = self._map(name)
        self._has_room(_FILES_OF_A_MAP)
        save_grid(grid, place)

    def grids(self, name: str) -> Iterator[Grid]:
        """Yield the maps of a collection."""
        for number, line in enumerate(self._read(name).splitlines(), 1):
            if not line.strip():
                continue
            tag, *words = map(str, Bottle.from_text(line))
            if tag != "mapfile:" or not words or number > MAP_GRIDS:
                wanted = f'"mapfile: NAME.map", of which {MAP_GRIDS} may be'
                raise DecodeError(f"{name}, line {number}: {line[:60]!r} is not {wanted}")
            try:
                grid = self.grid(words[0])
            except FileNotFoundError as error:
                gone = f"{name}, line {number}: there is no file {error.filename}"
                raise DecodeError(gone) from None
            yield cropped(grid) if "crop" in words[1:] else grid

    def keep_grids(self, grids: Sequence[Grid], name: str) -> None:
        """Write maps, each as the .map file of its name, and the collection of them."""
        files = [f"{grid.name}{_MAP}" for grid in grids]
        for grid, file in zip(grids, files, strict=True):
            self.keep_grid(grid, file)
        self._write(name, "".join(f"mapfile: {Bottle([file]).to_text()}\n" for file in files))

    def names(self, name: str) -> MapNames:
        """Return what has a name in a file."""
        try:
            return parse_names(self._read(name))
        except DecodeError as error:
            raise DecodeError(f"{name}: {error}") from None

    def keep_names(self, names: MapNames, name: str) -> None:
        """Write them."""
        self._write(name, spell_names(names))

    def _file(self, name: str) -> Path:
        if not name or "\0" in name:
            raise Refused("a file needs a name")
        place = (self._folder / name).resolve()
        if self._folder not in place.parents:
            raise Refused(f"{name[:60]!r} is not in the folder of the maps")
        return place

    def _map(self, name: str) -> Path:
        place = self._file(name)
        if place.suffix != _MAP:
            raise Refused(f"the file of a map ends in {_MAP}, not as {name[:60]!r}")
        return place

    def _list(self, name: str) -> Path:
        place = self._file(name)
        if place.suffix in _PARTS:
            raise Refused(f"{name[:60]!r} is the name of a map's file")
        return place

    def _read(self, name: str) -> str:
        with self._list(name).open("rb") as file:
            data = file.read(MAP_TEXT + 1)
        if len(data) > MAP_TEXT:
            raise DecodeError(f"{name} has more than {MAP_TEXT} bytes")
        return data.decode("utf-8", "replace")

    def _write(self, name: str, text: str) -> None:
        place = self._list(name)
        self._has_room(1)
        draft = place.with_name(f".{place.name}.{os.getpid()}.new")
        draft.write_text(text, "utf-8")
        draft.replace(place)

    def _has_room(self, more: int) -> None:
        if sum(1 for _ in self._folder.iterdir()) + more > MAP_FILES:
            raise Refused(f"the folder of the maps has {MAP_FILES} files, no more are written")


def cropped(grid: Grid) -> Grid:
    """Return a map without the borders that nobody has seen; the same where all is unknown."""
    import numpy as np

    occupied, cells = grid.occupied(), grid.cells()
    rows, columns = np.nonzero(occupied != UNKNOWN)
    if not len(rows):
        return grid
    top, bottom, left, right = rows.min(), rows.max() + 1, columns.min(), columns.max() + 1
    x = grid.x + float(left) * grid.resolution
    y = grid.y + float(grid.height - bottom) * grid.resolution
    part = np.s_[top:bottom, left:right]
    return Grid.of(grid.name, occupied[part], grid.resolution, (x, y, grid.theta), cells[part])
