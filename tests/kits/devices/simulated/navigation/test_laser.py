"""A laser scanner without hardware, in scenes and in a map."""

from math import inf, sqrt

import pytest

from yarpy.kits.devices.interfaces.grid import Grid
from yarpy.kits.devices.simulated.navigation.laser import SCENES, SimulatedLaser


def test_scenes() -> None:
    assert SimulatedLaser("no_obstacles").ranges() == [inf] * 360
    assert SimulatedLaser("use_constant", distance=0.5, step=90.0).ranges() == [0.5] * 4
    assert SimulatedLaser("use_constant", distance=9.0, step=90.0).ranges() == [inf] * 4
    seen = SimulatedLaser("use_square_trap", step=45.0).ranges()
    assert seen == pytest.approx([1.5, 1.5 * sqrt(2)] * 4)
    pattern = SimulatedLaser(angles=(-90.0, 90.0), step=10.0, distances=(0.05, 8.0))
    assert pattern.ranges() == [inf] * 5 + [number / 100 for number in range(5, 18)]
    assert pattern.condition() == "in use"


def test_what_makes_no_scan_is_refused() -> None:
    with pytest.raises(ValueError, match="no_obstacles, use_constant, use_pattern"):
        SimulatedLaser("use_nothing")
    with pytest.raises(ValueError, match='"use_mapfile" needs a map'):
        SimulatedLaser("use_mapfile")
    assert "use_mapfile" not in SCENES
    for angles, step in (((0.0, 0.0), 1.0), ((0.0, 360.0), 0.0), ((0.0, 360.0), 1e-9)):
        with pytest.raises(ValueError, match="no scan goes from"):
            SimulatedLaser(angles=angles, step=step)
    with pytest.raises(ValueError, match=r"measures from 2\.0 to 1\.0"):
        SimulatedLaser(distances=(2.0, 1.0))


def room(theta: float = 0.0, corner: tuple[float, float] = (0.0, 0.0)) -> Grid:
    """A room of 4 x 3 metres in cells of half a metre, a wall of one cell around it, and in it a
    cell at the right that nobody may enter."""
    cells = [[4] * 10, *([4, *[0] * 8, 4] for _ in range(6)), [4] * 10]
    cells[3][7] = 1
    return Grid.of("room", [[0] * 10] * 8, 0.5, (*corner, theta), cells)


def test_in_a_map() -> None:
    laser = SimulatedLaser("use_mapfile", grid=room(), step=45.0, distances=(0.1, 9.0))
    laser.place = (1.5, 1.75, 0.0)
    # Below the cell that nobody may enter, then at its height.
    assert laser.ranges()[::2] == pytest.approx([3.0, 1.75, 1.0, 1.25])
    assert laser.ranges()[1] == pytest.approx(1.75 * sqrt(2))
    laser.place = (1.5, 2.25, 0.0)
    assert laser.ranges()[::2] == pytest.approx([2.0, 1.25, 1.0, 1.75])
    laser.place = (1.5, 2.25, 90.0)
    assert laser.ranges()[::2] == pytest.approx([1.25, 1.0, 1.75, 2.0])
    short = SimulatedLaser("use_mapfile", grid=room(), step=90.0, distances=(0.1, 1.5))
    short.place = (1.5, 2.25, 0.0)
    assert short.ranges() == pytest.approx([inf, 1.25, 1.0, inf])


def test_in_a_map_that_lies_elsewhere() -> None:
    laser = SimulatedLaser("use_mapfile", grid=room(90.0, (10.0, 20.0)), step=90.0)
    laser.place = (10.0 - 2.25, 20.0 + 1.5, 90.0)
    assert laser.ranges() == pytest.approx([2.0, 1.25, 1.0, 1.75])
    laser.place = (10.0 - 2.25, 20.0 - 1.0, 90.0)  # outside, in front of the left wall
    assert laser.ranges() == pytest.approx([1.0, inf, inf, inf])
    empty = SimulatedLaser("use_mapfile", grid=Grid.of("a", [[0]], 0.5), step=90.0)
    assert empty.ranges() == [inf] * 4
