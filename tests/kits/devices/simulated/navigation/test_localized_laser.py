"""A laser scanner in a map that another program moves."""

from __future__ import annotations

from math import inf
from typing import Any

import pytest
from support.wait import wait_until

import yarpy
from yarpy import Property
from yarpy.kits import devices
from yarpy.kits.devices.simulated import plugin
from yarpy.kits.devices.simulated.navigation.localized_laser import LocalizedLaser
from yarpy.nameserver.local import LocalNames

# Ten metres of corridor; a wall at its end.
GRID = devices.Grid.of("corridor", [[0] * 9 + [100]], 1.0)
LOOK: dict[str, Any] = {"grid": GRID, "angles": (0.0, 90.0), "step": 90.0, "distances": (0.1, 20)}


def test_a_port_says_where_it_is(names: LocalNames, caplog: pytest.LogCaptureFixture) -> None:
    with (
        LocalizedLaser(port="/laser/location:i", names=names, **LOOK) as laser,
        yarpy.Port("/me", names=names) as port,
    ):
        port.connect("/laser/location:i")
        port.write(yarpy.Bottle([1.5, 0.5, 0.0]))
        wait_until(lambda: laser.place == (1.5, 0.5, 0.0))
        assert laser.ranges() == [pytest.approx(7.5)]
        for nothing in ([1.0], ["here", 1, 2]):
            port.write(yarpy.Bottle(nothing))
        port.write(yarpy.Bottle([2.5, 0.5, 180.0]))
        wait_until(lambda: laser.place == (2.5, 0.5, 180.0))
        assert laser.ranges() == [inf]
    assert "a place is x, y in metres" in caplog.text
    assert names.query("/laser/location:i") is None


def test_a_localization_server_is_asked(names: LocalNames) -> None:
    base = devices.SimulatedBase("corridor")
    with (
        devices.Localization2D.serve("/where", base, names=names),
        LocalizedLaser(server="/where", names=names, **LOOK) as laser,
    ):
        base.locate(devices.Place("corridor", 4.0, 0.5, 0.0))
        assert laser.ranges() == [pytest.approx(5.0)]


def test_in_the_file_of_a_robot(tmp_path: Any, names: LocalNames) -> None:
    devices.save_grid(GRID, tmp_path / "corridor.map")
    options = Property(
        test="use_mapfile",
        map_file=str(tmp_path / "corridor.map"),
        localization_port="/laser/location:i",
    )
    laser: Any = plugin.laser(options, names=names)
    assert isinstance(laser, LocalizedLaser)
    assert names.query("/laser/location:i") is not None
    laser.close()


def test_somebody_must_say_where_it_is() -> None:
    with pytest.raises(ValueError, match="who says where"):
        LocalizedLaser(**LOOK)
