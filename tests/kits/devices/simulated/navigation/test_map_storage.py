"""Maps, and what has a name in them."""

from pathlib import Path
from typing import Any

import pytest

from yarpy.errors import DecodeError
from yarpy.kits.devices.interfaces.grid import Grid
from yarpy.kits.devices.interfaces.place import Place
from yarpy.kits.devices.refusal import Refused
from yarpy.kits.devices.simulated.navigation import map_storage
from yarpy.kits.devices.simulated.navigation.map_storage import MapStorage


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


def test_files(tmp_path: Path) -> None:
    storage: Any = MapStorage(tmp_path)
    storage.store_map(Grid.of("kitchen", [[0, 0, 100]]))
    storage.store_location("door", Place("kitchen", 1.0, 2.0, 90.0))
    storage.save_maps("maps_collection.ini")
    storage.save_names("locations.ini")
    storage.save_map("kitchen", "copy.map")
    again: Any = MapStorage(tmp_path)
    assert again.map_names() == ["kitchen"] and again.map("kitchen").width == 3
    assert again.location("door") == Place("kitchen", 1.0, 2.0, 90.0)
    again.clear_maps()
    again.clear_locations()
    again.load_map("copy.map")
    assert again.map_names() == ["kitchen"]
    again.reload_maps()
    again.reload_names()
    assert again.location_names() == ["door"]


def test_without_a_folder() -> None:
    storage = MapStorage()
    for use in (storage.load_map, storage.load_maps, storage.load_names, storage.save_names):
        with pytest.raises(Refused, match="without a folder"):
            use("locations.ini")


def test_a_damaged_file_is_told_at_once(tmp_path: Path) -> None:
    (tmp_path / "locations.ini").write_text("hello\n")
    with pytest.raises(DecodeError, match=r"locations.ini: line 1"):
        MapStorage(tmp_path)
