"""Map2DLocation, Map2DPath, LLM_Message ...: what devices exchange, structs of Thrift.

Rules: fields are plain attributes, which are checked when they are sent. What YARP 3.5 sends has no
description yet.
"""

from __future__ import annotations

import math
from typing import Any, ClassVar, TypeVar

import yarpy
from yarp._map_grid import MapGrid2D
from yarp._numbers import StdVector
from yarp._portable import Portable
from yarpy.kits import devices, thrift

T = TypeVar("T")


class _OlderPlace(thrift.Struct):
    map_id: str = ""
    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0


class _Place(_OlderPlace):
    description: str = ""


class _Said(thrift.Struct):
    type: str
    content: str
    parameters: list[str]
    arguments: list[str]


class Map2DLocation(Portable):
    """A place in a map: metres, and where one looks, in degrees."""

    map_id: str
    x: float
    y: float
    theta: float
    description: str

    def __init__(
        self,
        map_name: str | Map2DLocation = "",
        inX: float = 0.0,
        inY: float = 0.0,
        inT: float = 0.0,
        desc: str = "",
    ) -> None:
        if isinstance(map_name, Map2DLocation):
            self.__dict__.update(map_name.__dict__)
            return
        self.map_id = map_name
        self.x, self.y, self.theta = inX, inY, inT
        self.description = desc

    def _outgoing(self) -> Any:
        x, y, theta = float(self.x), float(self.y), float(self.theta)
        return _Place(self.map_id, x, y, theta, self.description)

    def _take(self, message: yarpy.Message) -> None:
        try:
            found = message.as_(_Place)
        except yarpy.DecodeError:
            older = message.as_(_OlderPlace)
            found = _Place(older.map_id, older.x, older.y, older.theta)
        self.map_id, self.x, self.y, self.theta = found.map_id, found.x, found.y, found.theta
        self.description = found.description

    def is_near_to(
        self, other_loc: Map2DLocation, linear_tolerance: float, angular_tolerance: float
    ) -> bool:
        """Return whether another place is within so many metres and degrees."""
        if linear_tolerance < 0 or angular_tolerance < 0 or self.map_id != other_loc.map_id:
            return False
        if math.hypot(self.x - other_loc.x, self.y - other_loc.y) > linear_tolerance:
            return False
        turn = math.remainder(other_loc.theta - self.theta, 360.0)
        return abs(turn) <= angular_tolerance

    def toString(self) -> str:
        return (
            f"map_id:{self.map_id} x:{self.x:g} y:{self.y:g} theta:{self.theta:g}"
            f"desc:{self.description}"
        )

    def __eq__(self, other: object) -> bool:
        """Return whether it is the same place, however it is described."""
        if not isinstance(other, Map2DLocation):
            return NotImplemented
        mine = (self.map_id, self.x, self.y, self.theta)
        return mine == (other.map_id, other.x, other.y, other.theta)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<yarp.Map2DLocation {self.toString()}>"


class LLM_Message(Portable):
    """A line of a conversation; `type` is whose: `user`, `assistant`, `function` ..."""

    def __init__(
        self, type: str = "", content: str = "", parameters: Any = (), arguments: Any = ()
    ) -> None:
        self.type, self.content = type, content
        self.parameters, self.arguments = [*parameters], [*arguments]

    def _outgoing(self) -> Any:
        return _Said(self.type, self.content, [*self.parameters], [*self.arguments])

    def _take(self, message: yarpy.Message) -> None:
        found = message.as_(_Said)
        self.type, self.content = found.type, found.content
        self.parameters, self.arguments = found.parameters, found.arguments

    def toString(self) -> str:
        """YARP's notation."""
        words: yarpy.Bottle = self._outgoing().to_bottle()
        return words.to_text()

    toString_c = toString

    def __repr__(self) -> str:
        return f"<yarp.LLM_Message {self.toString()}>"


class _Record(Portable):
    """A struct of `yarpy.devices` whose fields are plain attributes."""

    _struct: ClassVar[type[Any]]

    def __init__(self, *values: Any) -> None:
        self._fill(self._struct(*values))

    def _fill(self, found: Any) -> None:
        for name in self._struct._attributes:
            setattr(self, name, getattr(found, name))

    def _outgoing(self) -> Any:
        return self._struct(*(getattr(self, name) for name in self._struct._attributes))

    def _take(self, message: yarpy.Message) -> None:
        self._fill(message.as_(self._struct))

    def toString(self) -> str:
        """YARP's notation."""
        words: str = self._outgoing().to_text()
        return words

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and bool(self._outgoing() == other._outgoing())

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<yarp.{type(self).__name__} {self.toString()}>"


class Pose6D(_Record):
    """`Pose6D(x, y, z, roll, pitch, yaw)`: metres and radians."""

    _struct = devices.Pose


class ColorRGB(_Record):
    """`ColorRGB(r, g, b)`: each from 0 to 255."""

    _struct = devices.Colour


class Map2DObject(_Record):
    """`Map2DObject(map_id, x, y, z, roll, pitch, yaw, description)`."""

    _struct = devices.Thing


class OdometryData(_Record):
    """Where a base is since it began, and how fast."""

    _struct = devices.Odometry


class Map2DPath(Portable):
    """Places, one after the other: `Map2DPath(waypoints, description)`."""

    def __init__(self, waypoints: Any = (), desc: str = "") -> None:
        self.waypoints: list[Map2DLocation] = [Map2DLocation(each) for each in waypoints]
        self.description = desc

    def _outgoing(self) -> Any:
        return devices.Path([each._outgoing() for each in self.waypoints], self.description)

    def _take(self, message: yarpy.Message) -> None:
        found = message.as_(devices.Path)
        self.waypoints = [
            Map2DLocation(each.map_id, each.x, each.y, each.theta, each.description)
            for each in found.waypoints
        ]
        self.description = found.description

    def push_back(self, loc: Map2DLocation) -> None:
        """Add a place."""
        self.waypoints.append(Map2DLocation(loc))

    def clear(self) -> None:
        """Remove all places."""
        self.waypoints, self.description = [], ""

    def size(self) -> int:
        return len(self.waypoints)

    __len__ = size

    def __getitem__(self, index: int) -> Map2DLocation:
        return self.waypoints[index]

    def isOnSingleMap(self) -> bool:
        """Return whether all places are in one map."""
        return len({each.map_id for each in self.waypoints}) <= 1

    def getLength(self) -> float:
        """Metres, straight from place to place."""
        pairs = zip(self.waypoints, self.waypoints[1:], strict=False)
        return sum((math.hypot(a.x - b.x, a.y - b.y) for a, b in pairs), 0.0)

    def toString(self) -> str:
        """The places."""
        return "".join(f"({each.toString()})" for each in self.waypoints)


class Map2DArea(Portable):
    """A polygon in a map: `Map2DArea(map_id, corners, description)`, each a Map2DLocation or a pair
    of numbers. `points` are pairs."""

    def __init__(self, map_name: str = "", area_points: Any = (), desc: str = "") -> None:
        self.map_id, self.description = map_name, desc
        self.points: list[tuple[float, float]] = [
            (each.x, each.y) if isinstance(each, Map2DLocation) else (each[0], each[1])
            for each in area_points
        ]

    def _outgoing(self) -> Any:
        corners = [yarpy.Vector([float(x), float(y)]) for x, y in self.points]
        return devices.Area(self.map_id, corners, self.description)

    def _take(self, message: yarpy.Message) -> None:
        found = message.as_(devices.Area)
        self.map_id, self.description = found.map_id, found.description
        try:
            self.points = [(float(each.array[0]), float(each.array[1])) for each in found.points]
        except IndexError:
            raise yarpy.DecodeError("a corner of an area has two numbers") from None

    def __getitem__(self, index: int) -> tuple[float, float]:
        return self.points[index]

    def clear(self) -> None:
        """Remove all corners."""
        self.map_id, self.points, self.description = "", [], ""

    def isValid(self) -> bool:
        """Return whether it has three corners."""
        return len(self.points) >= 3

    def checkLocationInsideArea(self, loc: Map2DLocation) -> bool:
        """Return whether a place is in it."""
        if loc.map_id != self.map_id or not self.isValid():
            return False
        inside = False
        for (x1, y1), (x2, y2) in zip(self.points, self.points[1:] + self.points[:1], strict=True):
            crosses = (y1 > loc.y) != (y2 > loc.y)
            if crosses and loc.x < (x2 - x1) * (loc.y - y1) / (y2 - y1) + x1:
                inside = not inside
        return inside

    def toString(self) -> str:
        """The map and the corners."""
        corners = "".join(f"({x:g} {y:g})" for x, y in self.points)
        return f"map_id:{self.map_id} {corners} desc:{self.description}"


class _StructVector(StdVector[T]):
    """A list in which every new element is one of its own."""

    _of: ClassVar[Any]

    def __init__(self, size: Any = 0, value: Any = None) -> None:
        blanks = isinstance(size, int) and value is None
        super().__init__([self._of() for _ in range(size)] if blanks else size, value)

    def _kind(self, value: Any) -> Any:  # type: ignore[override]
        if not isinstance(value, self._of):
            raise TypeError(f"a {self._of.__name__} is needed, not {value!r}")
        return value

    def resize(self, new_size: int, x: Any = None) -> None:
        """Cut, or fill up with blank ones or `x`."""
        del self._items[new_size:]
        while len(self._items) < new_size:
            self._items.append(self._of() if x is None else self._kind(x))


class LLMVector(_StructVector[LLM_Message]):
    """A conversation."""

    _of = LLM_Message


class Map2DLocationVector(_StructVector[Map2DLocation]):
    """Places."""

    _of = Map2DLocation


#: The classes here for structs of `yarpy.devices`, by the names of those.
STRUCTS: dict[str, Any] = {
    "Area": Map2DArea,
    "Colour": ColorRGB,
    "Grid": MapGrid2D,
    "Line": LLM_Message,
    "Odometry": OdometryData,
    "Path": Map2DPath,
    "Place": Map2DLocation,
    "Pose": Pose6D,
    "Thing": Map2DObject,
}


def vector_of(of: Any, items: list[Any]) -> Any:
    """Return a vector of such objects; a list where the bindings have none."""
    kinds: dict[Any, Any] = {Map2DLocation: Map2DLocationVector, LLM_Message: LLMVector}
    return kinds[of](items) if of in kinds else items
