"""Grid: a map of cells, each free, a wall, or something else; MapGrid2D in C++.

    grid = Grid.of("kitchen", occupied, resolution=0.05)        occupied: (height, width), percent
    grid.cells(), grid.occupied()

Rules: the first row is the one at the top. On the wire the cells may be compressed by zlib, to no
more than what the map announces; C++ sends them so.
"""

from __future__ import annotations

import zlib
from typing import TYPE_CHECKING, Any, Final, Self

from yarpy.errors import DecodeError
from yarpy.kits.thrift.kind import i8, i32
from yarpy.kits.thrift.structure import Struct
from yarpy.limit import limits

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

#: What a cell is; the index here is the number on the wire.
CELLS: Final = ("free", "keep out", "temporary obstacle", "enlarged obstacle", "wall", "unknown")
#: The occupancy of a cell that nobody has seen.
UNKNOWN: Final = 255


class Grid(Struct):
    """A map. `x`, `y`, `theta`: where its lower left corner is, metres and degrees; `resolution`:
    metres of a cell. The last two are the bytes of the wire."""

    width: i32 = 0
    height: i32 = 0
    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0
    resolution: float = 1.0
    name: str = ""
    compressed: i8 = 0
    occupancy: bytes = b""
    flags: bytes = b""

    @classmethod
    def of(
        cls,
        name: str,
        occupied: ArrayLike,
        resolution: float = 1.0,
        origin: tuple[float, float, float] = (0.0, 0.0, 0.0),
        cells: ArrayLike | None = None,
    ) -> Self:
        """A map of percentages, (height, width), `UNKNOWN` for what nobody has seen.

        cells: numbers of `CELLS`; by default walls are where it is at least 50. ValueError if the
        shapes differ.
        """
        import numpy as np

        values = np.asarray(occupied, "u1")
        if values.ndim != 2:
            raise ValueError(f"a map is (height, width), not of shape {values.shape}")
        if cells is None:
            kinds = np.where(values < 50, 0, 4).astype("u1")
            kinds[values > 100] = 5
        else:
            kinds = np.asarray(cells, "u1")
        if kinds.shape != values.shape:
            raise ValueError(f"cells are of shape {kinds.shape}, the map of {values.shape}")
        height, width = values.shape
        x, y, theta = origin
        return cls(
            width, height, x, y, theta, resolution, name, 0, values.tobytes(), kinds.tobytes()
        )

    def occupied(self) -> NDArray[Any]:
        """Return the percentages, uint8 of (height, width). DecodeError."""
        return self._image(self.occupancy)

    def cells(self) -> NDArray[Any]:
        """Return the numbers of `CELLS`, uint8 of (height, width). DecodeError."""
        return self._image(self.flags)

    def squeezed(self) -> Grid:
        """Return the same map, compressed."""
        if self.compressed:
            return self
        facts = (self.width, self.height, self.x, self.y, self.theta, self.resolution, self.name)
        return Grid(*facts, 1, zlib.compress(self.occupancy), zlib.compress(self.flags))

    def _image(self, data: bytes) -> NDArray[Any]:
        import numpy as np

        if self.width < 0 or self.height < 0:
            raise DecodeError(f"a map of {self.width} x {self.height} cells")
        size = self.width * self.height
        if size > limits().unpacked:
            raise DecodeError(f"a map of {self.width} x {self.height} cells is too large")
        if self.compressed:
            try:
                data = zlib.decompressobj().decompress(data, size + 1)
            except zlib.error as error:
                raise DecodeError(f"the cells of the map {self.name!r}: {error}") from None
        if len(data) > size:
            raise DecodeError(f"the map {self.name!r} has more than {size} bytes of cells")
        if len(data) != size:
            raise DecodeError(
                f"the map {self.name!r} has {len(data)} bytes of cells, not {size} for "
                f"{self.width} x {self.height}"
            )
        return np.frombuffer(data, "u1").reshape(self.height, self.width)
