"""Map2DLocation, Map2DPath and Map2DArea: places in a map.

Rules: fields are plain attributes, which are checked when they are sent. What YARP 3.5 sends has no
description yet.
"""

from __future__ import annotations

import math
import random
from typing import Any

import yarpy
from yarp._iterator import SwigPyIterator
from yarp._point import Vector2D, Vector2DVector
from yarp._portable import Portable
from yarpy.kits import devices, thrift


class _OlderPlace(thrift.Struct):
    map_id: str = ""
    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0


class _Place(_OlderPlace):
    description: str = ""


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

    def isEqual(self, other: Map2DLocation) -> bool:
        return self == other

    def notEqual(self, other: Map2DLocation) -> bool:
        return self != other

    def toString(self) -> str:
        return (
            f"map_id:{self.map_id} x:{self.x:g} y:{self.y:g} theta:{self.theta:g}"
            f"desc:{self.description}"
        )

    toString_c = toString

    def __eq__(self, other: object) -> bool:
        """Return whether it is the same place, however it is described."""
        if not isinstance(other, Map2DLocation):
            return NotImplemented
        mine = (self.map_id, self.x, self.y, self.theta)
        return mine == (other.map_id, other.x, other.y, other.theta)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<yarp.Map2DLocation {self.toString()}>"


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

    def begin(self) -> SwigPyIterator:
        """Return the place in the list where it begins."""
        return SwigPyIterator(self, 0)

    def end(self) -> SwigPyIterator:
        """Return the place in the list behind its end."""
        return SwigPyIterator(self, len(self.waypoints))

    cbegin = begin
    cend = end

    def isEqual(self, other: Map2DPath) -> bool:
        """Return whether it goes through the same places, however it is described."""
        return self.waypoints == other.waypoints

    def notEqual(self, other: Map2DPath) -> bool:
        return not self.isEqual(other)

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

    toString_c = toString


class Map2DArea(Portable):
    """A polygon in a map: `Map2DArea(map_id, corners, description)`, each a Map2DLocation or a pair
    of numbers. `points` are a Vector2DVector; whoever replaces them may take any pairs."""

    def __init__(self, map_name: str = "", area_points: Any = (), desc: str = "") -> None:
        self.map_id, self.description = map_name, desc
        self.points: Any = Vector2DVector(
            (each.x, each.y) if isinstance(each, Map2DLocation) else each for each in area_points
        )

    def _outgoing(self) -> Any:
        corners = [yarpy.Vector([float(x), float(y)]) for x, y in self.points]
        return devices.Area(self.map_id, corners, self.description)

    def _take(self, message: yarpy.Message) -> None:
        found = message.as_(devices.Area)
        self.map_id, self.description = found.map_id, found.description
        try:
            self.points = Vector2DVector(each.array[:2] for each in found.points)
        except ValueError:
            raise yarpy.DecodeError("a corner of an area has two numbers") from None

    def __getitem__(self, index: int) -> Vector2D:
        return Vector2DVector(self.points)[index]

    def clear(self) -> None:
        """Remove all corners."""
        self.map_id, self.points, self.description = "", Vector2DVector(), ""

    def isValid(self) -> bool:
        """Return whether it has three corners."""
        return len(self.points) >= 3

    def checkLocationInsideArea(self, loc: Map2DLocation) -> bool:
        """Return whether a place is in it."""
        return loc.map_id == self.map_id and self.isValid() and self._has(loc.x, loc.y)

    def checkObjectInsideArea(self, obj: Any) -> bool:
        """Return whether an object is in it."""
        return obj.map_id == self.map_id and self.isValid() and self._has(obj.x, obj.y)

    def _has(self, x: float, y: float) -> bool:
        inside = False
        corners = [*self.points]
        for (x1, y1), (x2, y2) in zip(corners, corners[1:] + corners[:1], strict=True):
            crosses = (y1 > y) != (y2 > y)
            if crosses and x < (x2 - x1) * (y - y1) / (y2 - y1) + x1:
                inside = not inside
        return inside

    def findAreaBounds(self, lt: Map2DLocation, rb: Map2DLocation) -> bool:
        """Store the smallest x and y of its corners, and the largest."""
        if not self.isValid():
            return False
        for place, choose in ((lt, min), (rb, max)):
            place.map_id = self.map_id
            place.x = choose(x for x, _ in self.points)
            place.y = choose(y for _, y in self.points)
        return True

    def getCentroid(self, cent: Map2DLocation) -> bool:
        """Store the middle of its bounds."""
        least, most = Map2DLocation(), Map2DLocation()
        if not self.findAreaBounds(least, most):
            return False
        cent.map_id = self.map_id
        cent.x, cent.y = (least.x + most.x) / 2, (least.y + most.y) / 2
        return True

    def getRandomLocation(self, loc: Map2DLocation) -> bool:
        """Store some place in it; False if none was found in a hundred tries."""
        least, most = Map2DLocation(), Map2DLocation()
        if not self.findAreaBounds(least, most):
            return False
        for _ in range(100):
            x, y = random.uniform(least.x, most.x), random.uniform(least.y, most.y)
            if self._has(x, y):
                loc.map_id, loc.x, loc.y, loc.theta = self.map_id, x, y, 0.0
                return True
        return False

    def isEqual(self, other: Map2DArea) -> bool:
        """Return whether it is the same polygon, however it is described."""
        mine, others = (Vector2DVector(each.points) for each in (self, other))
        return self.map_id == other.map_id and [*mine] == [*others]

    def notEqual(self, other: Map2DArea) -> bool:
        return not self.isEqual(other)

    def toString(self) -> str:
        """The map and the corners."""
        corners = "".join(f"({x:g} {y:g})" for x, y in self.points)
        return f"map_id:{self.map_id} {corners} desc:{self.description}"

    toString_c = toString
