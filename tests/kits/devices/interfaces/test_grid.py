"""Maps of cells."""

import zlib

import pytest

from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError
from yarpy.kits.devices.interfaces.grid import Grid


def test_a_map() -> None:
    grid = Grid.of("kitchen", [[0, 49, 50], [100, 101, 255]], 0.05, (1.0, 2.0, 90.0))
    assert grid.cells().tolist() == [[0, 0, 4], [4, 5, 5]]
    assert grid.occupied().tolist() == [[0, 49, 50], [100, 101, 255]]
    assert (grid.width, grid.height, grid.x, grid.theta) == (3, 2, 1.0, 90.0)
    own = Grid.of("kitchen", [[0, 0]], cells=[[1, 2]])
    assert own.cells().tolist() == [[1, 2]]
    assert Bottle.from_bytes(grid.to_wire()[0])[8:] == [grid.occupancy, grid.flags]


def test_what_is_no_map() -> None:
    with pytest.raises(ValueError, match="height, width"):
        Grid.of("kitchen", [1, 2])
    with pytest.raises(ValueError, match="of shape"):
        Grid.of("kitchen", [[1, 2]], cells=[[1]])


def test_compressed() -> None:
    grid = Grid.of("kitchen", [[0, 50]] * 100)
    small = grid.squeezed()
    assert small.compressed and small.squeezed() is small
    assert small.occupied().tolist() == [[0, 50]] * 100
    assert len(small.flags) < len(grid.flags)


@pytest.mark.parametrize(
    ("grid", "why"),
    [
        (Grid(-1, 2), "of -1 x 2"),
        (Grid(1 << 20, 1 << 20), "too large"),
        (Grid(2, 2, occupancy=b"123"), "3 bytes of cells, not 4"),
        (Grid(2, 2, compressed=1, occupancy=b"123"), "the cells of the map"),
        (Grid(2, 2, compressed=1, occupancy=zlib.compress(bytes(3))), "3 bytes"),
        (Grid(2, 2, compressed=1, occupancy=zlib.compress(bytes(5))), "more than"),
    ],
)
def test_what_peers_make_of_it(grid: Grid, why: str) -> None:
    with pytest.raises(DecodeError, match=why):
        grid.occupied()
