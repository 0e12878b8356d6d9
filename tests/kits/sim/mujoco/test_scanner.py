"""Laser scanners of a MuJoCo model."""

from math import cos, inf, radians, sin
from pathlib import Path

import pytest

from yarpy.kits.sim.mujoco.model import load
from yarpy.kits.sim.mujoco.scanner import scanners


def test_a_room_all_around(rover: Path, clock) -> None:
    model = load(rover, clock)
    [(name, laser)] = scanners(model).items()
    assert name == "laser_front"
    assert "laser_front" in laser.info and "rover" in laser.info
    found = laser.ranges()
    assert len(found) == 360
    for degree in (0, 30, 90, 135, 180, 270):
        wall = 2.0 / max(abs(cos(radians(degree))), abs(sin(radians(degree))))
        assert found[degree] == pytest.approx(wall, abs=0.01), degree
    with model.present():
        model.data.qpos[0] = 1.0  # ahead
        model.data.qpos[3:7] = (cos(radians(45)), 0, 0, sin(radians(45)))  # to the left
        model._engine.mj_forward(model.model, model.data)
    found = laser.ranges()
    assert found[0] == pytest.approx(2.0, abs=0.01)
    assert found[90] == pytest.approx(3.0, abs=0.01)
    assert found[270] == pytest.approx(1.0, abs=0.01)


def test_nothing_there(clock, rover: Path, tmp_path: Path) -> None:
    empty = tmp_path / "empty.xml"
    site = '<body><freejoint/><geom size=".1"/><site name="Lidar"/></body>'
    empty.write_text(f"<mujoco><worldbody>{site}</worldbody></mujoco>")
    assert {*scanners(load(empty, clock))["Lidar"].ranges()} == {inf}
