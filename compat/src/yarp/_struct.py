"""Map2DLocation and LLM_Message: what navigation and language models exchange, structs of Thrift.

Rules: fields are plain attributes, which are checked when they are sent. What YARP 3.5 sends has no
description yet.
"""

from __future__ import annotations

import math
from typing import Any, ClassVar, TypeVar

import yarpy
from yarp._numbers import StdVector
from yarp._portable import Portable
from yarpy.idl import thrift

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
        """Whether another place is within so many metres and degrees."""
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
        """Whether it is the same place, however it is described."""
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
