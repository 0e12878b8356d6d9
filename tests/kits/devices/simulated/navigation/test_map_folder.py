"""The files of a server of maps: which may be named, and what is in them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from yarpy.errors import DecodeError
from yarpy.kits.devices.interfaces.grid import UNKNOWN, Grid
from yarpy.kits.devices.interfaces.map_names import MapNames
from yarpy.kits.devices.interfaces.place import Place
from yarpy.kits.devices.refusal import Refused
from yarpy.kits.devices.simulated.navigation import map_folder
from yarpy.kits.devices.simulated.navigation.map_folder import MapFolder, cropped

GRID = Grid.of("kitchen", [[0, 0, 100], [UNKNOWN, 0, 0]], 0.05, (1.0, 2.0, 90.0))


@pytest.fixture
def folder(tmp_path: Path) -> MapFolder:
    (tmp_path / "maps").mkdir()
    return MapFolder(tmp_path / "maps")


def test_maps_and_their_collection(folder: MapFolder, tmp_path: Path) -> None:
    other = Grid.of("the hall", [[0]], 0.1)
    folder.keep_grids([GRID, other], "maps_collection.ini")
    assert (tmp_path / "maps" / "maps_collection.ini").read_text() == (
        'mapfile: kitchen.map\nmapfile: "the hall.map"\n'
    )
    found = [*folder.grids("maps_collection.ini")]
    assert [grid.name for grid in found] == ["kitchen", "the hall"]
    assert (found[0].x, found[0].y, found[0].resolution) == (1.0, 2.0, 0.05)
    assert (found[0].cells() == GRID.cells()).all()
    assert folder.has("kitchen.map") and not folder.has("bath.map")


def test_borders_that_nobody_has_seen() -> None:
    occupied = np.full((5, 6), UNKNOWN, "u1")
    occupied[1:3, 2:6] = 0
    occupied[2, 5] = 100
    found = cropped(Grid.of("lab", occupied, 0.5, (10.0, 20.0, 0.0)))
    assert found.occupied().tolist() == [[0, 0, 0, 0], [0, 0, 0, 100]]
    assert (found.x, found.y) == (11.0, 21.0)  # the lower left corner
    unseen = Grid.of("lab", [[UNKNOWN]])
    assert cropped(unseen) is unseen


def test_a_collection_of_cpp(folder: MapFolder, tmp_path: Path) -> None:
    folder.keep_grid(GRID, "kitchen.map")
    listed = tmp_path / "maps" / "own.ini"
    listed.write_text("mapfile: kitchen.map crop\n\n")
    assert [grid.width for grid in folder.grids("own.ini")] == [3]
    for text in ("kitchen.map\n", "mapfile:\n"):
        listed.write_text(text)
        with pytest.raises(DecodeError, match=r'own.ini, line 1: .* is not "mapfile: NAME.map"'):
            [*folder.grids("own.ini")]
    listed.write_text("mapfile: bath.map\n")
    with pytest.raises(DecodeError, match=r"own.ini, line 1: there is no file .*bath\.map"):
        [*folder.grids("own.ini")]


def test_names(folder: MapFolder, tmp_path: Path) -> None:
    folder.keep_names(MapNames(locations={"door": Place("lab", 1.0)}), "locations.ini")
    assert folder.names("locations.ini").locations == {"door": Place("lab", 1.0)}
    (tmp_path / "maps" / "locations.ini").write_text("hello")
    with pytest.raises(DecodeError, match=r"locations.ini: line 1"):
        folder.names("locations.ini")


@pytest.mark.parametrize("name", ["../x.map", "/etc/x.map", "", "a/../../x.map", ".", "x\0.map"])
def test_no_file_outside_the_folder(folder: MapFolder, name: str) -> None:
    for use in (folder.grid, folder.names, lambda name: [*folder.grids(name)]):
        with pytest.raises(Refused):
            use(name)
    with pytest.raises(Refused):
        folder.keep_grid(GRID, name)
    with pytest.raises(Refused):
        folder.keep_names(MapNames(), name)


def test_no_file_where_a_link_leads(folder: MapFolder, tmp_path: Path) -> None:
    (tmp_path / "outside").mkdir()
    try:
        (tmp_path / "maps" / "out").symlink_to(tmp_path / "outside", target_is_directory=True)
    except OSError:
        pytest.skip("this user may not make symbolic links, which Windows asks a right for")
    if not (tmp_path / "maps" / "out").is_dir():
        pytest.skip("wine 8 says that it has made a symbolic link, and has made none")
    with pytest.raises(Refused, match="not in the folder"):
        folder.keep_names(MapNames(), "out/locations.ini")


def test_no_file_is_taken_for_another_kind(folder: MapFolder) -> None:
    with pytest.raises(Refused, match=r"ends in \.map, not as 'locations.ini'"):
        folder.keep_grid(GRID, "locations.ini")
    for name in ("kitchen.map", "kitchen_grid.pgm"):
        with pytest.raises(Refused, match="is the name of a map's file"):
            folder.keep_names(MapNames(), name)


def test_neither_many_nor_large_files(
    folder: MapFolder, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(map_folder, "MAP_FILES", 4)
    folder.keep_grid(GRID, "kitchen.map")
    with pytest.raises(Refused, match="has 4 files, no more are written"):
        folder.keep_names(MapNames(), "locations.ini")
    monkeypatch.setattr(map_folder, "MAP_TEXT", 10)
    (tmp_path / "maps" / "large.ini").write_text("mapfile: kitchen.map\n")
    with pytest.raises(DecodeError, match=r"large\.ini has more than 10 bytes"):
        [*folder.grids("large.ini")]
    monkeypatch.setattr(map_folder, "MAP_TEXT", 100)
    monkeypatch.setattr(map_folder, "MAP_GRIDS", 1)
    (tmp_path / "maps" / "many.ini").write_text("mapfile: kitchen.map\nmapfile: kitchen.map\n")
    with pytest.raises(DecodeError, match="line 2"):
        [*folder.grids("many.ini")]
