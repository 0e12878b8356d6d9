"""LLM_Message, Pose6D, Map2DObject ...: what devices exchange, structs of Thrift.

Rules: fields are plain attributes, which are checked when they are sent.
"""

from __future__ import annotations

import math
from typing import Any, ClassVar, Self, TypeVar

import yarpy
from yarp._map_grid import MapGrid2D
from yarp._map_place import Map2DArea, Map2DLocation, Map2DPath
from yarp._numbers import StdVector
from yarp._portable import Portable
from yarpy.kits import devices, thrift

T = TypeVar("T")


class _Said(thrift.Struct):
    type: str
    content: str
    parameters: list[str]
    arguments: list[str]


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


class _Corner(thrift.Struct):
    x: thrift.i32 = 0
    y: thrift.i32 = 0


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

    toString_c = toString

    def isEqual(self, other: Self) -> bool:
        return self == other

    def notEqual(self, other: Self) -> bool:
        return self != other

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
    map_id: str
    x: float
    y: float
    z: float

    def is_near_to(self, other: Map2DLocation | Map2DObject, linear_tolerance: float) -> bool:
        """Return whether a place, or another object, is within so many metres."""
        if linear_tolerance < 0 or self.map_id != other.map_id:
            return False
        height = self.z - other.z if isinstance(other, Map2DObject) else 0.0
        return math.hypot(self.x - other.x, self.y - other.y, height) <= linear_tolerance


class vertex_t(_Record):
    """`vertex_t(x, y)`: a corner of what is cut out of a picture."""

    _struct = _Corner


class OdometryData(_Record):
    """Where a base is since it began, and how fast."""

    _struct = devices.Odometry


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


# What these have in common with their bases in C++, which nobody makes by themselves.
Map2DLocationData = Map2DLocation
Map2DAreaData = Map2DArea
Map2DPathData = Map2DPath
Map2DObjectData = Map2DObject


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
