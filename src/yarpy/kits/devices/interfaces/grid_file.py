"""Maps of cells in files, as YARP's own map server reads and writes them.

    kitchen.map                     MapName kitchen
                                    YarpMapData kitchen_yarpflags.ppm
                                    RosMapData kitchen_grid.yaml
    kitchen_yarpflags.ppm           a picture: the colour of a cell says what it is
    kitchen_grid.yaml, .pgm         a map of ROS: where it is, and in grey how occupied cells are

    grid = load_grid("kitchen.map")
    save_grid(grid, "copy/kitchen.map")

Rules: one of the two pictures is enough, the other one follows from it. The .map may say
`resolution` and `origin (x y degrees)` itself, which then count. Pictures are PPM and PGM in binary
form. The angle of a map of ROS is in radians; C++ reads radians and writes degrees. Grey is read in
a hundred steps, where C++ knows free and occupied alone. Raises OSError, and DecodeError for what
is no map.

Source: MapGrid2D of YARP 3.9 and 4.0 (whose .map files have no colons; both are read).
"""

from __future__ import annotations

import math
import re
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError
from yarpy.kits.devices.interfaces.grid import CELLS, UNKNOWN, Grid
from yarpy.limit import limits

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: Red, green and blue of `CELLS`.
COLOURS: Final = (
    (254, 254, 254),
    (255, 0, 0),
    (100, 100, 200),
    (255, 200, 0),
    (0, 0, 0),
    (205, 205, 205),
)
_WALL: Final = CELLS.index("wall")
_UNSEEN: Final = CELLS.index("unknown")
#: What is read of a picture: the colours of obstacles that pass are unknown, as to C++.
_READ: Final = (CELLS.index("free"), CELLS.index("keep out"), _WALL, _UNSEEN)
_GREY_UNKNOWN: Final = 205
_GREY_FREE: Final = 254
_TEXT: Final = 65536  # bytes of a .map or .yaml: they have a few lines
_PICTURE: Final = re.compile(rb"(P[56])" + rb"(?>(?:\s++|#[^\n]*\n)+)(\d{1,9})" * 3 + rb"\s")


def coloured(cells: Any) -> NDArray[Any]:
    """Return a picture of cells, (height, width, 3)."""
    import numpy as np

    found: NDArray[Any] = np.array(COLOURS, "u1")[np.minimum(cells, _UNSEEN)]
    return found


def flags_of(picture: Any) -> NDArray[Any]:
    """Return the cells that a picture means; what is no colour of a map is unknown."""
    import numpy as np

    found = np.full(picture.shape[:2], _UNSEEN, "u1")
    for cell in _READ:
        found[(picture == COLOURS[cell]).all(axis=2)] = cell
    return found


def load_grid(path: str | PathLike[str]) -> Grid:
    """Read a map. Raises OSError, DecodeError."""
    import numpy as np

    place = Path(path)
    facts = _facts(place)
    if "MapName" not in facts:
        raise DecodeError(f"{place}: a map needs a line MapName")
    cells = occupied = None
    resolution, origin = 1.0, (0.0, 0.0, 0.0)
    if "YarpMapData" in facts:
        cells = flags_of(_picture(place.parent / _word(facts, "YarpMapData", place), 3))
    if "RosMapData" in facts:
        ros = place.parent / _word(facts, "RosMapData", place)
        said = _facts(ros)
        resolution = _numbers(said, "resolution", ros, 1)[0]
        x, y, angle = _numbers(said, "origin", ros, 3)
        origin = (x, y, math.degrees(angle))
        grey = _picture(ros.parent / _word(said, "image", ros), 1)
        free = np.minimum(grey, _GREY_FREE).astype("i4")
        percent = ((_GREY_FREE - free) * 100 + _GREY_FREE // 2) // _GREY_FREE
        unknown = (grey == _GREY_UNKNOWN) | (grey > _GREY_FREE)
        occupied = np.where(unknown, UNKNOWN, percent).astype("u1")
    if cells is None and occupied is None:
        raise DecodeError(f"{place}: a map needs a line YarpMapData or RosMapData")
    if occupied is None:
        occupied = np.select([cells == _WALL, cells == _UNSEEN], [100, UNKNOWN], 0).astype("u1")
    elif cells is not None and cells.shape != occupied.shape:
        raise DecodeError(f"{place}: its pictures are of {cells.shape} and {occupied.shape} cells")
    if "resolution" in facts:
        resolution = _numbers(facts, "resolution", place, 1)[0]
    if "origin" in facts:
        x, y, theta = _numbers(facts, "origin", place, 3)
        origin = (x, y, theta)
    if not resolution > 0:
        raise DecodeError(f"{place}: a resolution of {resolution} m")
    return Grid.of(_word(facts, "MapName", place), occupied, resolution, origin, cells)


def save_grid(grid: Grid, path: str | PathLike[str]) -> None:
    """Write a map: the file `path`, and beside it three that are named after the map. Raises
    OSError, DecodeError; ValueError for a name that is none of a file."""
    import numpy as np

    if not re.fullmatch(r"[^/\\\0\n]+", grid.name) or grid.name.startswith("."):
        raise ValueError(f"a map called {grid.name!r} cannot be in files of that name")
    cells, occupied = grid.cells(), grid.occupied()
    place = Path(path)
    flags, yaml, image = (
        f"{grid.name}{end}" for end in ("_yarpflags.ppm", "_grid.yaml", "_grid.pgm")
    )
    lines = (("MapName", grid.name), ("YarpMapData", flags), ("RosMapData", yaml))
    place.write_text("".join(f"{Bottle(line).to_text()}\n" for line in lines), "utf-8")
    where = f"[ {grid.x!r} {grid.y!r} {math.radians(grid.theta)!r} ]"
    (place.parent / yaml).write_text(
        f"image: {image}\nresolution: {grid.resolution!r}\norigin: {where}\n"
        "negate: 0\noccupied_thresh: 0.8\nfree_thresh: 0.2\n",
        "utf-8",
    )
    steps = _GREY_FREE - occupied.astype("i4") * _GREY_FREE // 100
    grey = np.where(occupied > 100, _GREY_UNKNOWN, steps).astype("u1")
    size = f"{grid.width} {grid.height}\n255\n".encode()
    (place.parent / image).write_bytes(b"P5\n" + size + grey.tobytes())
    (place.parent / flags).write_bytes(b"P6\n" + size + coloured(cells).tobytes())


def _facts(path: Path) -> dict[str, list[Any]]:
    """Return the values of each line `key value` or `key: value`."""
    with path.open("rb") as file:
        data = file.read(_TEXT + 1)
    if len(data) > _TEXT:
        raise DecodeError(f"{path} is too large for the description of a map")
    found: dict[str, list[Any]] = {}
    for line in data.decode("utf-8", "replace").splitlines():
        line = line.partition("#")[0].replace(",", " ").replace("[", "(").replace("]", ")")
        key, *values = Bottle.from_text(line) or [""]
        found[str(key).rstrip(":")] = values
    return found


def _word(facts: dict[str, list[Any]], key: str, path: Path) -> str:
    found = " ".join(map(str, facts.get(key, [])))
    if not found or "\0" in found:
        raise DecodeError(f"{path}: a map needs a line {key}")
    return found


def _numbers(facts: dict[str, list[Any]], key: str, path: Path, count: int) -> list[float]:
    values = facts.get(key, [])
    if len(values) == 1 and isinstance(values[0], list):
        values = values[0]
    numbers = [float(value) for value in values if isinstance(value, (int, float))]
    if len(numbers) != count or not all(map(math.isfinite, numbers)):
        raise DecodeError(f"{path}: {key} {Bottle(values).to_text()[:60]} is not {count} numbers")
    return numbers


def _picture(path: Path, channels: int) -> NDArray[Any]:
    """Return a picture, of one channel or of three."""
    import numpy as np

    kind = {1: b"P5", 3: b"P6"}[channels]
    with path.open("rb") as file:
        head = file.read(1024)
        found = _PICTURE.match(head)
        if found is None or found[1] != kind or int(found[4]) != 255:
            name = "PGM (P5)" if channels == 1 else "PPM (P6)"
            raise DecodeError(f"{path} is no {name} of 8 bits: convert it, with ImageMagick say")
        width, height = int(found[2]), int(found[3])
        size = width * height * channels
        if not 0 < size <= limits().unpacked:
            raise DecodeError(f"{path}: a map of {width} x {height} cells")
        file.seek(found.end())
        data = file.read(size)
    if len(data) != size:
        raise DecodeError(f"{path} ends after {len(data)} of {size} bytes of its picture")
    shape = (height, width) if channels == 1 else (height, width, 3)
    return np.frombuffer(data, "u1").reshape(shape)
