"""What navigation exchanges, as C++ writes it."""

import yarpy
from yarpy.kits.devices.interfaces.place import Area, Odometry, Path, Place, Thing, Velocity


def test_a_path_has_its_places_in_lists() -> None:
    path = Path([Place("m", 1.0)], "way")
    assert path.to_bottle() == [[["m", 1.0, 0.0, 0.0, ""]], "way"]
    assert Path.from_wire(path.to_wire()[0]) == path


def test_points_of_an_area_are_vectors() -> None:
    area = Area("m", [yarpy.Vector([1.0, 2.0])])
    data = area.to_wire()[0]
    point = bytes.fromhex("0a010000 02000000 000000000000f03f 0000000000000040")
    assert bytes.fromhex("00010000 01000000") + point in data
    assert Area.from_wire(data) == area


def test_how_many_numbers_there_are() -> None:
    assert len(Odometry().to_bottle()) == 9 and len(Velocity().to_bottle()) == 3
    assert Thing("m", 1.0, description="cup").to_bottle()[-1] == "cup"
