"""Bases, localization and maps between yarpy and C++, both ways in one chain.

our client -> nws of C++ -> nwc of C++ -> our server
"""

from typing import Any

import pytest
from support.cpp import CppYarp
from support.cpp_device import cpp_device, device_host
from support.wait import wait_until

import yarpy
from yarpy.kits.devices.interfaces.grid import Grid
from yarpy.kits.devices.interfaces.localization import Localization2D
from yarpy.kits.devices.interfaces.map2d import Map2D
from yarpy.kits.devices.interfaces.navigation import Navigation2D
from yarpy.kits.devices.interfaces.place import Area, Place
from yarpy.kits.devices.interfaces.place import Path as Route
from yarpy.kits.devices.simulated.navigation.base import SimulatedBase
from yarpy.kits.devices.simulated.navigation.map_storage import MapStorage

pytestmark = pytest.mark.peer("g++")


def test_localization(network: CppYarp) -> None:
    device_host(network)
    base = SimulatedBase("kitchen")
    with (
        Localization2D.serve("/ours", base),
        cpp_device(
            network,
            "localization2D_nws_yarp",
            subdevice="localization2D_nwc_yarp",
            name="/cpp",
            local="/between",
            remote="/ours",
        ) as process,
    ):
        assert "not available" not in process.stdout
        with Localization2D.connect("/localization2D_nws_yarp") as client:
            client.locate(Place("kitchen", 1.5, 2.0, 3.0))
            assert base.position() == Place("kitchen", 1.5, 2.0, 3.0)
            wait_until(lambda: client.position() == Place("kitchen", 1.5, 2.0, 3.0))
            assert client.localization_status() == "locy"
            found, covariance = client.position_with_covariance()
            if network.version < (4, 0):  # whose server forgets what it was told
                assert found.x == 1.5 and covariance.array.shape == (3, 3)
            found = base.position()
            client.locate_with_covariance(found, yarpy.Matrix([[1.0] * 3] * 3))
            if network.version < (4, 0):  # the same
                assert client.estimates() == [base.position()]
            assert client.odometry().odom_x == base.odometry().odom_x
            client.stop_localization()
            assert base.localization_status() == "locn"


def test_navigation(network: CppYarp) -> None:
    device_host(network)
    base = SimulatedBase("kitchen")
    with (
        Localization2D.serve("/where", base),
        Map2D.serve("/maps", MapStorage()),
        Navigation2D.serve("/ours", base),
        cpp_device(
            network,
            "navigation2D_nws_yarp",
            subdevice="navigation2D_nwc_yarp",
            name="/cpp",
            local="/between",
            navigation_server="/ours",
            map_locations_server="/maps",
            localization_server="/where",
        ) as process,
    ):
        assert "not available" not in process.stdout
        with Navigation2D.connect("/navigation2D_nws_yarp") as client:
            client.go(Place("kitchen", 2.0, 0.0, 0.0))
            assert client.status() == "movg"
            assert client.target() == Place("kitchen", 2.0, 0.0, 0.0)
            assert client.target_from_here()[1:] == (0.0, 0.0)
            assert client.waypoints("glob").waypoints[0].x == 2.0
            client.suspend(60.0)
            assert base.status() == "paus"
            client.resume()
            client.stop()
            assert client.status() == "idle"
            client.apply_velocity(0.1, 0.0, 5.0, 0.2)
            assert client.last_velocity() == (0.1, 0.0, 5.0)


def test_maps(network: CppYarp) -> None:
    device_host(network)
    with (
        Map2D.serve("/ours", MapStorage()),
        cpp_device(
            network,
            "map2D_nws_yarp",
            subdevice="map2D_nwc_yarp",
            name="/cpp/rpc",
            local="/between",
            remote="/ours",
        ) as process,
    ):
        assert "not available" not in process.stdout
        with Map2D.connect("/cpp") as client:
            client.store_location("a", Place("kitchen", 1.5, 2.0, 3.0, "there"))
            assert client.location("a") == Place("kitchen", 1.5, 2.0, 3.0, "there")
            client.store_area("b", Area("kitchen", [yarpy.Vector([1.0, 2.0])] * 3, "sink"))
            assert client.area("b") == Area("kitchen", [yarpy.Vector([1.0, 2.0])] * 3, "sink")
            client.store_path("c", Route([Place("kitchen", 1.0), Place("kitchen", 2.0)]))
            assert [place.x for place in client.path("c").waypoints] == [1.0, 2.0]
            client.rename_location("a", "d")
            assert client.location_names() == ["d"] and client.area_names() == ["b"]
            grid = Grid.of("kitchen", [[0, 100, 255]] * 2, 0.05, (1.0, 2.0, 90.0))
            client.store_map(grid)
            found = client.map("kitchen")
            assert found.occupied().tolist() == grid.occupied().tolist()
            assert found.cells().tolist() == [[0, 4, 5]] * 2
            assert (found.name, found.x, found.resolution) == ("kitchen", 1.0, 0.05)
            assert client.map_names() == ["kitchen"]
            with pytest.raises(yarpy.LocalProtocolError, match='"/cpp" refuses location'):
                client.location("nowhere")
            client.delete_location("d")
            assert client.location_names() == []


def test_files_of_maps(network: CppYarp) -> None:
    """C++ begins with what we have written, and we with what it writes."""
    device_host(network)
    folder = network.home / "data" / "contexts" / "lab"
    folder.mkdir(parents=True, exist_ok=True)
    grid = Grid.of("kitchen", [[0, 100, 255]] * 2, 0.05, (1.0, 2.0, 0.0))
    (storage := MapStorage(folder)).store_map(grid)
    with Map2D.serve("/ours", storage), Map2D.connect("/ours") as client:
        client.store_location("the sink", Place("kitchen", 1.5, 2.0, 3.0))
        client.store_area("floor", Area("kitchen", [yarpy.Vector([1.0, 2.0])] * 3))
        client.store_path("tour", Route([Place("kitchen", 1.0), Place("kitchen", 2.0)]))
        client.save_maps("maps_collection.ini")
        client.save_names("locations.ini")
    served = cpp_device(
        network,
        "map2D_nws_yarp",
        subdevice="map2DStorage",  # it has a port, too, of a name of its own
        mapCollectionContext="lab",
    )
    with served as process:
        assert "not available" not in process.stdout, process.stderr
        with Map2D.connect("/map2D_nws_yarp") as client:
            found = client.map("kitchen")
            assert found.cells().tolist() == [[0, 4, 5]] * 2
            assert found.occupied().tolist() == grid.occupied().tolist()
            assert (found.x, found.y, round(found.resolution, 6)) == (1.0, 2.0, 0.05)
            assert client.location("the sink") == Place("kitchen", 1.5, 2.0, 3.0)
            assert client.area("floor").points == [yarpy.Vector([1.0, 2.0])] * 3
            assert [place.x for place in client.path("tour").waypoints] == [1.0, 2.0]
            client.delete_location("the sink")  # it could not read that name again itself
            client.store_location("door", Place("kitchen", 9.0))
            client.save_names(str(folder / "theirs.ini"))
            client.save_maps(str(folder / "their_maps.ini"))
    again: Any = MapStorage(folder, "their_maps.ini", "theirs.ini")
    assert again.location_names() == ["door"] and again.area_names() == ["floor"]
    assert again.map("kitchen").cells().tolist() == grid.cells().tolist()
