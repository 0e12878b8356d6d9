"""MapStorage: keeps maps and what has a name in them; map2DStorage in C++.

    storage = MapStorage()                  in memory alone
    storage = MapStorage("maps")            with the files of a folder, which may be C++'s

Rules: anybody can store something, so there is a limit for each. Clients may name files of the
folder alone, where C++ takes those of the whole computer; without a folder the members with files
refuse. What is read comes to what is kept, and takes its place where the names are the same.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import Any, Final, Generic, TypeVar

from yarpy.kits.devices.interfaces.grid import CELLS, Grid
from yarpy.kits.devices.interfaces.map_names import MapNames
from yarpy.kits.devices.refusal import Refused
from yarpy.kits.devices.simulated.navigation.map_folder import MapFolder
from yarpy.limit import MAP_GRIDS, MAP_NAMES

T = TypeVar("T")

#: What `clear_obstacles` forgets.
_TEMPORARY: Final = (CELLS.index("temporary obstacle"), CELLS.index("enlarged obstacle"))


class _Table(Generic[T]):
    """The named things of one kind."""

    def __init__(self, what: str, most: int) -> None:
        self._what, self._most = what, most
        self._lock = threading.Lock()  # renaming looks and then changes
        self._kept: dict[str, T] = {}

    def store(self, name: str, value: T) -> None:
        with self._lock:
            if name not in self._kept and len(self._kept) >= self._most:
                raise Refused(f"{self._most} of {self._what} are kept, no more")
            self._kept[name] = value

    def get(self, name: str) -> T:
        found = self._kept.get(name)
        if found is None:
            raise Refused(f"no {self._what} is called {name[:60]!r}")
        return found

    def names(self) -> list[str]:
        return [*self._kept]

    def all(self) -> list[T]:
        return [*self._kept.values()]

    def named(self) -> dict[str, T]:
        return dict(self._kept)

    def rename(self, name: str, new_name: str) -> None:
        with self._lock:
            value = self.get(name)
            if new_name in self._kept:
                raise Refused(f"there is a {self._what} called {new_name[:60]!r}")
            self._kept = {new_name if each == name else each: v for each, v in self._kept.items()}
            assert value is self._kept[new_name]

    def delete(self, name: str) -> None:
        self.get(name)
        self._kept.pop(name, None)

    def clear(self) -> None:
        self._kept.clear()


class MapStorage:
    """Every member of `interfaces.map2d.Map2D`.

    folder: where the files are. collection: the list of its maps, one a line as
    `mapfile: kitchen.map`, with `crop` behind it to leave out borders that nobody has seen; names:
    what has a name in them. Both are read now, if they are there. Raises OSError, DecodeError.
    """

    def __init__(
        self,
        folder: str | PathLike[str] = "",
        collection: str = "maps_collection.ini",
        names: str = "locations.ini",
    ) -> None:
        self._maps: _Table[Grid] = _Table("map", MAP_GRIDS)
        self._compress = False
        self.map_names, self.remove_map = self._maps.names, self._maps.delete
        self.clear_maps = self._maps.clear
        self._tables: dict[str, _Table[Any]] = {}
        for one, many in _KINDS:
            table = self._tables[many] = _Table(one, MAP_NAMES)
            members: dict[str, Callable[..., Any]] = {
                f"store_{one}": table.store,
                one: table.get,
                f"{one}_names": table.names,
                many: table.all,
                f"rename_{one}": table.rename,
                f"delete_{one}": table.delete,
                f"clear_{many}": table.clear,
            }
            self.__dict__.update(members)
        self._collection, self._names = collection, names
        self._folder = MapFolder(Path(folder)) if folder else None
        if self._folder is not None:
            if self._folder.has(collection):
                self.reload_maps()
            if self._folder.has(names):
                self.reload_names()

    def store_map(self, grid: Grid) -> None:
        """Keep a map under its name. Raises DecodeError: its cells are no map."""
        plain = Grid.of(
            grid.name,
            grid.occupied(),
            grid.resolution,
            (grid.x, grid.y, grid.theta),
            grid.cells(),
        )
        self._maps.store(grid.name, plain)

    def map(self, name: str) -> Grid:
        """Return a map."""
        found = self._maps.get(name)
        return found.squeezed() if self._compress else found

    def compress_maps(self, enable: bool) -> None:
        """Hand them out compressed, or not."""
        self._compress = enable

    def clear_obstacles(self, name: str) -> None:
        """Forget the temporary obstacles in a map."""
        import numpy as np

        grid = self._maps.get(name)
        cells = grid.cells()
        free = np.where(np.isin(cells, _TEMPORARY), 0, cells)
        origin = (grid.x, grid.y, grid.theta)
        self._maps.store(name, Grid.of(name, grid.occupied(), grid.resolution, origin, free))

    def clear_all_obstacles(self) -> None:
        """Forget the temporary obstacles in all maps."""
        for name in self._maps.names():
            self.clear_obstacles(name)

    def load_map(self, file: str) -> None:
        """Read a .map file of the folder."""
        self.store_map(self._files.grid(file))

    def save_map(self, name: str, file: str) -> None:
        """Write a map as that .map file, and three beside it that are named after the map."""
        self._files.keep_grid(self._maps.get(name), file)

    def load_maps(self, file: str) -> None:
        """Read all maps of a collection."""
        for grid in self._files.grids(file):
            self.store_map(grid)

    def save_maps(self, file: str) -> None:
        """Write all maps, and the collection of them."""
        self._files.keep_grids(self._maps.all(), file)

    def reload_maps(self) -> None:
        """Read the collection of the folder again."""
        self.load_maps(self._collection)

    def load_names(self, file: str) -> None:
        """Read what has a name in a file."""
        found = self._files.names(file)
        for many, table in self._tables.items():
            for name, value in getattr(found, many).items():
                table.store(name, value)

    def save_names(self, file: str) -> None:
        """Write all that has a name."""
        found = MapNames(**{many: table.named() for many, table in self._tables.items()})
        self._files.keep_names(found, file)

    def reload_names(self) -> None:
        """Read the file of names of the folder again."""
        self.load_names(self._names)

    @property
    def _files(self) -> MapFolder:
        if self._folder is None:
            raise Refused("it was started without a folder for its maps")
        return self._folder


#: What has a name, one and many.
_KINDS: Final = (
    ("location", "locations"),
    ("area", "areas"),
    ("path", "paths"),
    ("object", "objects"),
)
