"""The names in maps as text: places, objects, areas and paths, one a line.

    Version:
    4
    Locations:
    door lab 1.5 2.0 90.0 "the door to the yard"       name, map, x, y, angle, description
    Objects:
    cup lab 1.0 2.0 0.8 0.0 0.0 1.57 ""                ... z, roll, pitch and yaw
    Areas:
    desk lab 3 0.0 0.0 1.0 0.0 1.0 1.0 ""              ... how many corners, x and y of each
    Paths:
    tour (lab 0.0 0.0 0.0) (lab 1.0 0.0 90.0) ""       places without descriptions

    names = parse_names(text)
    text = spell_names(names)

Rules: versions 1 to 4 are read; 1 has places and areas, 2 paths, 3 descriptions, 4 objects. What is
written is as old as can be, for older programs: C++ 3.5 reads 1 and 2, 3.9 up to 3. Lengths are
metres, angles degrees, those of objects as they were stored. A name that is there twice, and a line
that is not of its section, is a DecodeError with the line.

Source: loadLocationsAndExtras of map2DStorage in C++ YARP 4.0.0.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any, Final, TypeVar

import yarpy
from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError
from yarpy.kits.devices.interfaces.place import Area, Path, Place, Thing
from yarpy.limit import MAP_NAMES

T = TypeVar("T")

NEWEST: Final = 4
_PLAIN: Final = 2  # the first version with paths
_DESCRIBED: Final = 3  # the first version with descriptions


@dataclass(slots=True)
class MapNames:
    """All that has a name in maps."""

    locations: dict[str, Place] = field(default_factory=dict)
    objects: dict[str, Thing] = field(default_factory=dict)
    areas: dict[str, Area] = field(default_factory=dict)
    paths: dict[str, Path] = field(default_factory=dict)


def parse_names(text: str) -> MapNames:
    """Return what a file says. Raises DecodeError."""
    lines = enumerate(text.splitlines(), 1)
    if _line(lines) != "Version:":
        raise DecodeError('line 1: a file of places begins with "Version:"')
    said = _line(lines)
    if said not in ("1", "2", "3", "4"):
        raise DecodeError(f"line 2: version {said[:40]!r} is not known, 1 to {NEWEST} are")
    version = int(said)
    found = MapNames()
    sections: list[tuple[str, dict[str, Any], Callable[[list[Any], int], Any]]] = [
        ("Locations:", found.locations, _place),
        ("Objects:", found.objects, _thing),
        ("Areas:", found.areas, _area),
        ("Paths:", found.paths, _path),
    ]
    if version < NEWEST:
        del sections[1]
    if version == 1:
        del sections[2:]
    titles = [title for title, _, _ in sections]
    current = -1
    for number, line in lines:
        if not line.strip():
            continue
        if current + 1 < len(titles) and line.strip() == titles[current + 1]:
            current += 1
            continue
        if current < 0:
            raise DecodeError(f'line {number}: {line[:60]!r} stands where "Locations:" should')
        title, kept, read = sections[current]
        try:
            name, *rest = Bottle.from_text(line)
            _keep(kept, str(name), read(rest, version))
        except (ValueError, IndexError, TypeError) as error:
            wanted = title.rstrip(":").lower()
            wrong = f"line {number}: {line[:60]!r} is none of the {wanted}: {error}"
            raise DecodeError(wrong) from None
    if current < len(titles) - 1:
        raise DecodeError(f'it ends without a line "{titles[current + 1]}"')
    return found


def spell_names(names: MapNames) -> str:
    """Return the file that says all this."""
    described: list[Place | Area | Path] = [*names.locations.values(), *names.areas.values()]
    described += names.paths.values()
    version = NEWEST if names.objects else _PLAIN
    if version == _PLAIN and any(each.description for each in described):
        version = _DESCRIBED

    def spelled(name: str, *values: Any, description: str) -> str:
        words = [name, *values, *([description] if version >= _DESCRIBED else [])]
        return Bottle(words).to_text()

    lines = ["Version:", str(version), "Locations:"]
    for name, place in names.locations.items():
        lines.append(spelled(name, *_where(place), description=place.description))
    if version >= NEWEST:
        lines.append("Objects:")
    for name, thing in names.objects.items():
        where = (thing.x, thing.y, thing.z, thing.roll, thing.pitch, thing.yaw)
        values = thing.map_id, *map(float, where)
        lines.append(spelled(name, *values, description=thing.description))
    lines.append("Areas:")
    for name, area in names.areas.items():
        numbers = [float(one) for point in area.points for one in point.array[:2]]
        values = area.map_id, len(area.points), *numbers
        lines.append(spelled(name, *values, description=area.description))
    lines.append("Paths:")
    for name, path in names.paths.items():
        places = (Bottle(_where(place)) for place in path.waypoints)
        lines.append(spelled(name, *places, description=path.description))
    return "".join(f"{line}\n" for line in lines)


def _line(lines: Iterator[tuple[int, str]]) -> str:
    return next(lines, (0, ""))[1].strip()


def _keep(kept: dict[str, T], name: str, value: T) -> None:
    if name in kept:
        raise ValueError(f"{name[:60]!r} is there twice")
    if len(kept) >= MAP_NAMES:
        raise ValueError(f"there are more than {MAP_NAMES}")
    kept[name] = value


def _where(place: Place) -> list[Any]:
    return [place.map_id, float(place.x), float(place.y), float(place.theta)]


def _floats(values: list[Any], count: int) -> list[float]:
    if len(values) != count or not all(isinstance(one, (int, float)) for one in values):
        raise ValueError(f"{count} numbers are needed")
    return [float(one) for one in values]


def _described(values: list[Any], version: int) -> tuple[list[Any], str]:
    """Return the values without the description, which is the last one, and that."""
    return (values[:-1], str(values[-1])) if version >= _DESCRIBED else (values, "")


def _place(values: list[Any], version: int) -> Place:
    values, description = _described(values, version)
    x, y, theta = _floats(values[1:], 3)
    return Place(str(values[0]), x, y, theta, description)


def _thing(values: list[Any], version: int) -> Thing:
    values, description = _described(values, version)
    x, y, z, roll, pitch, yaw = _floats(values[1:], 6)
    return Thing(str(values[0]), x, y, z, roll, pitch, yaw, description)


def _area(values: list[Any], version: int) -> Area:
    values, description = _described(values, version)
    count = values[1]
    if not isinstance(count, int) or count < 0:
        raise ValueError("the number of its corners is needed")
    numbers = _floats(values[2:], 2 * count)
    corners = [yarpy.Vector(numbers[at : at + 2]) for at in range(0, len(numbers), 2)]
    return Area(str(values[0]), corners, description)


def _path(values: list[Any], version: int) -> Path:
    values, description = _described(values, version)
    return Path([_place([*each], 1) for each in values], description)
