"""Maps in files: written and read again, those of C++ and of ROS, and what is no map."""

import math
from pathlib import Path

import pytest

from yarpy.errors import DecodeError
from yarpy.kits.devices.interfaces.grid import CELLS, Grid
from yarpy.kits.devices.interfaces.grid_file import COLOURS, load_grid, save_grid


def test_written_and_read_again(tmp_path: Path) -> None:
    values = [[*range(101)], [255] * 101]
    cells = [[0, 1, 4, 5] * 25 + [0], [5] * 101]
    grid = Grid.of("my kitchen", values, 0.05, (1.5, -2.25, 90.0), cells)
    save_grid(grid.squeezed(), tmp_path / "any.map")
    again = load_grid(tmp_path / "any.map")
    assert again.occupied().tolist() == values and again.cells().tolist() == cells
    assert (again.name, again.resolution) == ("my kitchen", 0.05)
    assert (again.x, again.y) == (1.5, -2.25) and math.isclose(again.theta, 90.0)
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "any.map",
        "my kitchen_grid.pgm",
        "my kitchen_grid.yaml",
        "my kitchen_yarpflags.ppm",
    ]
    assert len(COLOURS) == len(CELLS)


def test_obstacles_that_pass_are_unknown_in_a_file(tmp_path: Path) -> None:
    save_grid(Grid.of("a", [[0, 0]], cells=[[2, 3]]), tmp_path / "a.map")
    assert load_grid(tmp_path / "a.map").cells().tolist() == [[5, 5]]


PPM = b"P6\n# a comment\n2 1\n255\n\x00\x00\x00\xfe\xfe\xfe"
PGM = b"P5 2 1 255\n\x00\xcd"
YAML = "image: b.pgm\nresolution: 0.1\norigin: [1.0, 2, 3.141592653589793]\nnegate: 0\n"


@pytest.fixture
def place(tmp_path: Path) -> Path:
    (tmp_path / "a.ppm").write_bytes(PPM)
    (tmp_path / "b.pgm").write_bytes(PGM)
    (tmp_path / "b.yaml").write_text(YAML)
    return tmp_path / "a.map"


def test_a_map_of_ros(place: Path) -> None:
    place.write_text("MapName: a\nRosMapData: b.yaml\n", encoding="utf-8")
    grid = load_grid(str(place))
    assert (grid.name, grid.resolution, grid.x, grid.y) == ("a", 0.1, 1.0, 2.0)
    assert math.isclose(grid.theta, 180.0)
    assert grid.occupied().tolist() == [[100, 255]] and grid.cells().tolist() == [[4, 5]]


def test_a_map_of_yarp(place: Path) -> None:
    place.write_text("MapName a\nYarpMapData a.ppm\n", encoding="utf-8")
    grid = load_grid(place)
    assert grid.occupied().tolist() == [[100, 0]] and grid.cells().tolist() == [[4, 0]]
    assert (grid.resolution, grid.x) == (1.0, 0.0)
    place.write_text(
        f"{place.read_text(encoding='utf-8')}RosMapData b.yaml\nresolution 0.5\norigin (7 8 9.5)\n",
        encoding="utf-8",
    )
    grid = load_grid(place)
    assert grid.occupied().tolist() == [[100, 255]] and grid.cells().tolist() == [[4, 0]]
    assert (grid.resolution, grid.x, grid.y, grid.theta) == (0.5, 7.0, 8.0, 9.5)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("YarpMapData a.ppm", "needs a line MapName"),
        ("MapName a", "needs a line YarpMapData or RosMapData"),
        ("MapName a\nYarpMapData b.pgm", r"no PPM \(P6\)"),
        ("MapName a\nYarpMapData short.ppm", "ends after 3 of 6 bytes"),
        ("MapName a\nYarpMapData large.ppm", "a map of 999999999 x 999999999"),
        ("MapName a\nYarpMapData a.map", "is no PPM"),
        ("MapName a\nYarpMapData tall.ppm\nRosMapData b.yaml", "its pictures are of"),
        ("MapName a\nRosMapData a.map", "resolution .* is not 1 numbers"),
        ("MapName a\nYarpMapData a.ppm\norigin (1 2)", "origin 1 2 is not 3 numbers"),
        ("MapName a\nYarpMapData a.ppm\nresolution 0", "a resolution of 0"),
        ("MapName a\nYarpMapData a\0.ppm", "needs a line YarpMapData"),
        ("MapName a\nRosMapData odd.yaml", "needs a line image"),
        ("x" * 70000, "too large"),
    ],
)
def test_what_is_no_map(place: Path, text: str, why: str) -> None:
    (place.parent / "short.ppm").write_bytes(PPM[:-3])
    (place.parent / "large.ppm").write_bytes(b"P6 999999999 999999999 255\n")
    (place.parent / "tall.ppm").write_bytes(b"P6 1 2 255\n" + bytes(6))
    (place.parent / "odd.yaml").write_text("resolution: 1\norigin: [0, 0, 0]\n")
    place.write_text(text, encoding="utf-8")
    with pytest.raises(DecodeError, match=why):
        load_grid(place)


def test_what_cannot_be_read_or_written(place: Path) -> None:
    with pytest.raises(FileNotFoundError):
        load_grid(place)
    for name in ("", "../a", ".a", "a\nb"):
        with pytest.raises(ValueError, match="cannot be in files"):
            save_grid(Grid.of(name, [[0]]), place)
    assert not place.exists()
