"""A laser scanner that stands still."""

from math import inf, sqrt

import pytest

from yarpy.kits.devices.simulated.laser import SCENES, SimulatedLaser


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
        SimulatedLaser("use_mapfile")
    assert "use_mapfile" not in SCENES
    for angles, step in (((0.0, 0.0), 1.0), ((0.0, 360.0), 0.0), ((0.0, 360.0), 1e-9)):
        with pytest.raises(ValueError, match="no scan goes from"):
            SimulatedLaser(angles=angles, step=step)
    with pytest.raises(ValueError, match=r"measures from 2\.0 to 1\.0"):
        SimulatedLaser(distances=(2.0, 1.0))
