"""Joypad: axes, buttons, sticks, hats, trackballs and touch surfaces.

Rules: from YARP 4 on ports send structs; readers of YARP 3 get plain vectors, which are read here,
too. Those have one finger for each surface, and hats in a byte each behind the tag of two bytes.
Positions are from -1 to 1.

Source: IJoypadController of YARP 3.9 and 4.0.
"""

from __future__ import annotations

from struct import pack, unpack_from
from typing import Self

import yarpy
from yarpy.data.value import INT16, LIST
from yarpy.errors import DecodeError
from yarpy.kits.devices.network.model import Interface, call, published
from yarpy.kits.thrift.kind import i8, i16, i32
from yarpy.kits.thrift.structure import Struct, new
from yarpy.wire.message import Encoded


class Point(Struct):
    """Two numbers of a trackball, a stick or a finger."""

    x: float = 0.0
    y: float = 0.0


class Touch(Struct):
    """The fingers on a surface."""

    touches: list[Point] = new(list)


class _Many(Struct):
    """The base of what ports send: numbers, or pairs of them."""

    def older(self) -> object:
        """Return the numbers, as programs of YARP 3 have them."""
        values = self.value  # type: ignore[attr-defined]
        return yarpy.Vector([number for each in values for number in _numbers(each)])

    @classmethod
    def from_wire(cls, view: bytes | bytearray | memoryview) -> Self:
        """Read either form. DecodeError."""
        try:
            return super().from_wire(view)
        except DecodeError:
            numbers = yarpy.Vector.from_wire(view).array.tolist()
        made = cls()
        made.value = cls._of(numbers)  # type: ignore[attr-defined]
        return made

    @classmethod
    def _of(cls, numbers: list[float]) -> list[object]:
        return [*numbers]


def _numbers(each: float | Point | Touch) -> tuple[float, ...]:
    if isinstance(each, Touch):
        each = each.touches[0] if each.touches else Point()
    return (each.x, each.y) if isinstance(each, Point) else (float(each),)


def _points(numbers: list[float]) -> list[Point]:
    return [Point(x, y) for x, y in zip(numbers[::2], numbers[1::2], strict=False)]


class Numbers(_Many):
    """One for each axis or button."""

    value: list[float] = new(list)


class Hats(_Many):
    """One for each hat: 1 up, 2 right, 4 down, 8 left, or the sum of two."""

    value: list[i8] = new(list)

    def older(self) -> object:
        """Return one byte for each, as programs of YARP 3 have them."""
        values = bytes(each & 255 for each in self.value)
        return Encoded(pack("<ii", LIST + INT16, len(values)) + values)

    @classmethod
    def from_wire(cls, view: bytes | bytearray | memoryview) -> Self:
        """Read either form. DecodeError."""
        if len(view) > 8 and unpack_from("<ii", view) == (LIST + INT16, len(view) - 8):
            return cls([*view[8:]])
        return super().from_wire(view)

    @classmethod
    def _of(cls, numbers: list[float]) -> list[object]:
        return [int(each) for each in numbers]


class Points(_Many):
    """One for each stick or trackball."""

    value: list[Point] = new(list)

    @classmethod
    def _of(cls, numbers: list[float]) -> list[object]:
        return [*_points(numbers)]


class Touches(_Many):
    """One for each surface."""

    value: list[Touch] = new(list)

    @classmethod
    def _of(cls, numbers: list[float]) -> list[object]:
        return [Touch([each]) for each in _points(numbers)]


class JoypadState(Struct):
    """All that a joypad has."""

    buttons: list[float] = new(list)
    axes: list[float] = new(list)
    hats: list[i8] = new(list)
    touches: list[Touch] = new(list)
    sticks: list[Point] = new(list)
    trackballs: list[Point] = new(list)


class Joypad(Interface):
    """A joypad, gamepad or joystick."""

    NWS, NWC = "JoypadControl_nws_yarp", "JoypadControl_nwc_yarp"
    FAKE = "fakeJoypad"
    VIEW = "IJoypadController"
    RPC = "rpc:i"
    WORDS = "ok"

    @call("getAxisCount", cpp="getAxisCount", words="ijpc get axis cnt")
    def axis_count(self) -> i32:
        """Return how many axes there are."""
        raise NotImplementedError

    @call("getButtonCount", cpp="getButtonCount", words="ijpc get butn cnt")
    def button_count(self) -> i32:
        """Return how many buttons there are."""
        raise NotImplementedError

    @call("getTrackballCount", cpp="getTrackballCount", words="ijpc get trbl cnt")
    def trackball_count(self) -> i32:
        """Return how many trackballs there are."""
        raise NotImplementedError

    @call("getHatCount", cpp="getHatCount", words="ijpc get hat cnt")
    def hat_count(self) -> i32:
        """Return how many hats there are."""
        raise NotImplementedError

    @call("getTouchSurfaceCount", cpp="getTouchSurfaceCount", words="ijpc get tuch cnt")
    def surface_count(self) -> i32:
        """Return how many touch surfaces there are."""
        raise NotImplementedError

    @call("getStickCount", cpp="getStickCount", words="ijpc get stck cnt")
    def stick_count(self) -> i32:
        """Return how many sticks there are."""
        raise NotImplementedError

    @call("getStickDoF", cpp="getStickDoF", words="ijpc get sdof cnt")
    def stick_freedom(self, stick: i32) -> i32:
        """Return how many numbers a stick has."""
        raise NotImplementedError

    @call("getButton", cpp="getButton", words="ijpc get butn val")
    def button(self, button: i32) -> float:
        """Return how far a button is pressed, 0 to 1."""
        raise NotImplementedError

    @call("getTrackball", cpp="getTrackball", words="ijpc get trbl val")
    def trackball(self, trackball: i32) -> Point:
        """Return how a trackball has moved."""
        raise NotImplementedError

    @call("getHat", cpp="getHat", words="ijpc get hat val")
    def hat(self, hat: i32) -> i32:
        """Return where a hat is pressed; see `Hats`."""
        raise NotImplementedError

    @call("getAxis", cpp="getAxis", words="ijpc get axis val")
    def axis(self, axis: i32) -> float:
        """Return where an axis is."""
        raise NotImplementedError

    @call("getStick", cpp="getStick", words="ijpc get stck val mode=polr|cart")
    def stick(self, stick: i32, mode: i32 = 1) -> tuple[Point, i16]:
        """Return where a stick is, and the mode, which servers of YARP 3 do not say (0). mode: 1
        for x and y, 0 for radius and angle (radians)."""
        raise NotImplementedError

    @call("getTouch", cpp="getTouch", words="ijpc get tuch val")
    def touch(self, surface: i32) -> list[Point]:
        """Return where fingers touch a surface."""
        raise NotImplementedError

    @published("axis:o")
    def axes(self) -> Numbers:
        """Return where all axes are."""
        raise NotImplementedError

    @published("buttons:o")
    def buttons(self) -> Numbers:
        """Return how far all buttons are pressed."""
        raise NotImplementedError

    @published("hat:o")
    def hats(self) -> Hats:
        """Return where all hats are pressed."""
        raise NotImplementedError

    @published("stick:o")
    def sticks(self) -> Points:
        """Return where all sticks are."""
        raise NotImplementedError

    @published("trackball:o", also="trackballs:o")
    def trackballs(self) -> Points:
        """Return how all trackballs have moved."""
        raise NotImplementedError

    @published("touch:o")
    def touches(self) -> Touches:
        """Return where fingers touch all surfaces."""
        raise NotImplementedError

    @published("allJoyData:o")
    def everything(self) -> JoypadState:
        """Return all at once (YARP 4)."""
        raise NotImplementedError
