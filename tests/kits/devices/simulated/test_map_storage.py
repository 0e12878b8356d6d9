"""Maps, and what has a name in them."""

from typing import Any

import pytest

from yarpy.errors import DecodeError
from yarpy.kits.devices.interfaces.grid import Grid
from yarpy.kits.devices.interfaces.place import Place
from yarpy.kits.devices.refusal import Refused
from yarpy.kits.devices.simulated import map_storage
from yarpy.kits.devices.simulated.map_storage import MapStorage


def test_names(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(map_storage, "MAP_NAMES", 2)
    storage: Any = MapStorage()
    storage.store_location("a", Place("kitchen", 1.0))
    storage.store_location("b", Place("kitchen", 2.0))
    storage.store_location("b", Place("kitchen", 3.0))
    with pytest.raises(Refused, match="no more"):
        storage.store_location("c", Place())
    storage.rename_location("a", "c")
    assert storage.location_names() == ["c", "b"]
    assert [place.x for place in storage.locations()] == [1.0, 3.0]
    with pytest.raises(Refused, match="there is a location"):
        storage.rename_location("c", "b")
    storage.delete_location("b")
    with pytest.raises(Refused, match="no location is called 'b'"):
        storage.location("b")
    storage.clear_locations()
    assert storage.locations() == [] and storage.area_names() == []


def test_maps() -> None:
    storage = MapStorage()
    storage.store_map(Grid.of("kitchen", [[0, 0, 100]], cells=[[2, 1, 4]]).squeezed())
    assert storage.map_names() == ["kitchen"] and not storage.map("kitchen").compressed
    storage.compress_maps(True)
    assert storage.map("kitchen").compressed
    storage.clear_all_obstacles()
    assert storage.map("kitchen").cells().tolist() == [[0, 1, 4]]
    with pytest.raises(DecodeError):
        storage.store_map(Grid(2, 2))
    storage.clear_maps()
    assert storage.map_names() == []
