"""Where the base of a MuJoCo model is."""

from math import cos, radians, sin
from pathlib import Path

import pytest

from yarpy.kits.devices.interfaces.place import Odometry
from yarpy.kits.sim.mujoco.base import WORLD, base_of
from yarpy.kits.sim.mujoco.model import load


def put(model, x: float, y: float, degrees: float, speed: tuple[float, ...]) -> None:
    half = radians(degrees) / 2
    with model.present():
        model.data.qpos[:7] = (x, y, 0.1, cos(half), 0, 0, sin(half))
        model.data.qvel[:6] = (*speed[:2], 0, 0, 0, radians(speed[2]))


def test_place_and_odometry(rover: Path, clock) -> None:
    model = load(rover, clock)
    base = base_of(model)
    assert base is not None
    put(model, 1.0, 2.0, 90.0, (0.5, 0.25, 10.0))
    place = base.position()
    assert (place.map_id, place.x, place.y) == (WORLD, 1.0, 2.0)
    assert place.theta == pytest.approx(90.0)
    assert base.estimates() == [place] and base.localization_status() == "locy"
    expect(base.odometry(), (1.0, 2.0, 90.0), (0.25, -0.5, 10.0), (0.5, 0.25, 10.0))
    # Anew from here: ahead is what was to the left.
    base.reset_odometry()
    put(model, 1.0, 3.0, 180.0, (0.0, 0.5, 0.0))
    expect(base.odometry(), (1.0, 0.0, 90.0), (0.0, -0.5, 0.0), (0.5, 0.0, 0.0))


def expect(found: Odometry, place: tuple, seen: tuple, speed: tuple) -> None:
    values = [getattr(found, name) for name in Odometry._attributes]
    assert values == pytest.approx([*place, *seen, *speed], abs=1e-9)


def test_what_is_fixed_has_none(arm: Path, clock) -> None:
    assert base_of(load(arm, clock)) is None
