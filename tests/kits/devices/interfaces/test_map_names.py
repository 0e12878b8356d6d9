"""Files of what has a name in maps, of every version."""

from __future__ import annotations

import pytest

from yarpy.errors import DecodeError
from yarpy.kits.devices.interfaces import map_names
from yarpy.kits.devices.interfaces.map_names import MapNames, parse_names, spell_names
from yarpy.kits.devices.interfaces.place import Area, Path, Place, Thing

NEWEST = """\
Version:
4
Locations:
door lab 1.5 2 90 "to the yard"
"two words" lab 0 0 0 ""
Objects:
cup lab 1 2 0.75 0 0 1.5 "mine"
Areas:
desk lab 3 0 0 1 0 1 1 "brown"
Paths:
tour ( lab 0 0 0) ( lab 1 0 90) "round"
"""


def corners(area: Area) -> list[list[float]]:
    return [[*map(float, point.array)] for point in area.points]


def test_as_cpp_writes_it() -> None:
    found = parse_names(NEWEST)
    assert found.locations == {
        "door": Place("lab", 1.5, 2.0, 90.0, "to the yard"),
        "two words": Place("lab"),
    }
    assert found.objects == {"cup": Thing("lab", 1.0, 2.0, 0.75, 0.0, 0.0, 1.5, "mine")}
    assert corners(found.areas["desk"]) == [[0, 0], [1, 0], [1, 1]]
    assert (found.areas["desk"].map_id, found.areas["desk"].description) == ("lab", "brown")
    assert found.paths == {"tour": Path([Place("lab"), Place("lab", 1.0, 0.0, 90.0)], "round")}


@pytest.mark.parametrize(
    ("version", "text"),
    [
        (1, "Locations:\ndoor lab 1.5 2 90\nAreas:\ndesk lab 1 3 4\n"),
        (2, "Locations:\ndoor lab 1.5 2 90\nAreas:\ndesk lab 1 3 4\nPaths:\ntour (lab 1 0 90)\n"),
        (
            3,
            'Locations:\ndoor lab 1.5 2 90 ""\nAreas:\ndesk lab 1 3 4 "here"\n'
            'Paths:\ntour (lab 1 0 90) ""\n',
        ),
    ],
)
def test_older_versions(version: int, text: str) -> None:
    found = parse_names(f"Version:\n{version}\n{text}")
    assert found.locations == {"door": Place("lab", 1.5, 2.0, 90.0)} and not found.objects
    assert corners(found.areas["desk"]) == [[3, 4]]
    assert found.areas["desk"].description == ("here" if version == 3 else "")
    tour = {"tour": Path([Place("lab", 1.0, 0.0, 90.0)])}
    assert found.paths == ({} if version == 1 else tour)


def test_what_is_written_is_read_again() -> None:
    names = parse_names(NEWEST)
    names.locations['"quoted"\nname'] = Place("a map", -1e-7, 1e20, 0.1, 'line\n"break"')
    names.areas["none"] = Area("lab")
    names.paths["nowhere"] = Path()
    found = parse_names(spell_names(names))
    assert (found.locations, found.objects, found.paths) == (
        names.locations,
        names.objects,
        names.paths,
    )
    assert [*map(corners, found.areas.values())] == [*map(corners, names.areas.values())]
    assert parse_names(spell_names(MapNames())) == MapNames()


def test_older_programs_can_read_what_they_have_words_for() -> None:
    names = MapNames({"door": Place("lab", 1.0)}, paths={"tour": Path([Place("lab")])})
    assert spell_names(names) == (
        "Version:\n2\nLocations:\ndoor lab 1.0 0.0 0.0\nAreas:\nPaths:\ntour (lab 0.0 0.0 0.0)\n"
    )
    names.paths["tour"].description = "round"
    assert spell_names(names).startswith('Version:\n3\nLocations:\ndoor lab 1.0 0.0 0.0 ""\nAreas')
    assert parse_names(spell_names(names)) == names
    names.objects["cup"] = Thing("lab")
    assert spell_names(names).startswith("Version:\n4\n")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", 'line 1: a file of places begins with "Version:"'),
        ("Version:\n5\n", "line 2: version '5' is not known, 1 to 4 are"),
        ("Version:\n4\ndoor lab 0 0 0 ''\n", 'stands where "Locations:" should'),
        ("Version:\n4\nLocations:\n", 'it ends without a line "Objects:"'),
        ("Version:\n4\nLocations:\ndoor lab 1 2\n", "line 4: .* none of the locations: 3 numbers"),
        ("Version:\n4\nLocations:\ndoor lab x 1 2 ''\n", "none of the locations: 3 numbers"),
        ("Version:\n1\nLocations:\nAreas:\ndesk lab 2 3 4\n", "none of the areas: 4 numbers"),
        ("Version:\n1\nLocations:\nAreas:\ndesk lab x\n", "the number of its corners"),
        ("Version:\n1\nLocations:\nAreas:\ndesk\n", "none of the areas"),
        ("Version:\n2\nLocations:\nAreas:\nPaths:\ntour 4\n", "none of the paths"),
        ("Version:\n1\nLocations:\na m 0 0 0\na m 0 0 0\nAreas:\n", "'a' is there twice"),
        ("Version:\n1\nLocations:\n(((\nAreas:\n", "none of the locations"),
    ],
)
def test_what_is_wrong_is_told(text: str, said: str) -> None:
    with pytest.raises(DecodeError, match=said):
        parse_names(text)


def test_no_more_than_a_server_keeps(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(map_names, "MAP_NAMES", 2)
    with pytest.raises(DecodeError, match=r"line 6: .* there are more than 2"):
        parse_names("Version:\n1\nLocations:\na m 0 0 0\nb m 0 0 0\nc m 0 0 0\nAreas:\n")
