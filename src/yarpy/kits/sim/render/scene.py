"""Scene: the room around the simulated robot, and what moves in it.

World: x forward, y to the left, z up, metres; the neck of the robot is above the origin.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, pi, sin
from typing import TYPE_CHECKING, Any, Final

from yarpy.kits.sim.render.picture import Colour, Picture
from yarpy.kits.sim.rotation import Vector

if TYPE_CHECKING:
    from numpy.typing import NDArray

TABLE: Final = 0.72  # height of its top
NEAR, FAR, SIDE = 0.62, 1.62, 0.75  # where it begins and ends, and half its width

_LEFT, _RIGHT, _FRONT, _BACK, _HIGH = 2.2, -2.2, 3.4, -2.0, 2.6  # the walls
_RED: Final = (0.82, 0.12, 0.10)
_CREAM: Final = (0.97, 0.92, 0.80)


@dataclass(frozen=True, slots=True)
class Surface:
    """A rectangle in space: from `corner` along `u` (columns of texels) and `v` (rows).

    It is visible from the side to which u x v points.
    """

    corner: Vector
    u: Vector
    v: Vector
    texels: NDArray[Any]


@dataclass(frozen=True, slots=True)
class Ball:
    """A ball that bounces along a circle, in two colours so that its rotation is visible."""

    radius: float = 0.055
    colours: tuple[Colour, Colour] = (_RED, _CREAM)
    centre: tuple[float, float] = (1.12, 0.0)
    reach: tuple[float, float] = (0.20, 0.30)
    ground: float = TABLE
    lap: float = 8.0  # seconds for a circle
    bounce: float = 0.5  # seconds from bounce to bounce

    def place(self, time: float) -> Vector:
        """Return the centre of the ball."""
        turn, fall = 2 * pi * (time / self.lap % 1), time / self.bounce % 1
        height = 9.81 / 2 * self.bounce**2 * fall * (1 - fall)
        x = self.centre[0] - self.reach[0] * cos(turn)
        y = self.centre[1] + self.reach[1] * sin(turn)
        return x, y, self.ground + self.radius + height

    def axis(self, time: float) -> Vector:
        """Return the direction of the middle of the first colour."""
        turn = 2 * pi * (time / 1.7 % 1)
        return cos(turn), 0.4 * sin(turn), 0.9 * sin(turn)


@dataclass(frozen=True, slots=True)
class Scene:
    """Everything visible.

    background: surfaces all around the camera, each in front of those before it. solids: the faces
    of convex bodies that stand in front of it and do not touch each other.
    """

    background: Sequence[Surface]
    solids: Sequence[Sequence[Surface]]
    balls: Sequence[Ball]


def room() -> Scene:
    """A room with a table, three boxes on it, and a ball."""
    table = block((NEAR, -SIDE, 0.0), (FAR, SIDE, TABLE), (0.66, 0.48, 0.31), _table_top())
    on = TABLE
    solids = [
        block((1.06, -0.06, on), (1.18, 0.06, on + 0.20), (0.16, 0.42, 0.74)),
        block((1.30, 0.36, on), (1.44, 0.56, on + 0.12), (0.24, 0.60, 0.33)),
        block((1.26, -0.58, on), (1.38, -0.46, on + 0.28), (0.93, 0.68, 0.16)),
        block((0.80, -0.52, on), (0.90, -0.36, on + 0.06), (0.55, 0.30, 0.62)),
    ]
    return Scene((*_walls(), *table), solids, (Ball(),))


def block(
    low: Vector, high: Vector, colour: Colour, top: NDArray[Any] | None = None
) -> list[Surface]:
    """An axis-aligned box, lit from above: all faces except the bottom."""
    (x, y, z), (a, b, c) = low, high
    wide, deep, tall = a - x, b - y, c - z

    def side(width: float, light: float) -> NDArray[Any]:
        face = Picture(width, tall, _times(colour, light), 128)
        face.gradient(0.78, 1.0)  # darker near the ground
        return face.texels()

    if top is None:
        lid = Picture(wide, deep, _times(colour, 1.12), 128)
        lid.frame(0.006, _times(colour, 1.3))
        top = lid.texels()
    return [
        Surface((x, y, c), (wide, 0, 0), (0, deep, 0), top),
        Surface((x, b, z), (0, -deep, 0), (0, 0, tall), side(deep, 0.88)),  # towards the robot
        Surface((a, y, z), (0, deep, 0), (0, 0, tall), side(deep, 0.60)),
        Surface((x, y, z), (wide, 0, 0), (0, 0, tall), side(wide, 0.66)),  # to the right
        Surface((a, b, z), (-wide, 0, 0), (0, 0, tall), side(wide, 0.76)),
    ]


def _table_top() -> NDArray[Any]:
    top = Picture(FAR - NEAR, 2 * SIDE, (0.80, 0.62, 0.43), 160)
    top.grain(0.025, 24, seed=3)
    for y in (0.375, 0.75, 1.125):
        top.rectangle(0, y - 0.003, FAR - NEAR, y + 0.003, (0.62, 0.46, 0.30))
    top.frame(0.012, (0.70, 0.52, 0.35))
    for x, y, a, b in ((1.06, -0.06, 1.18, 0.06), (1.30, 0.36, 1.44, 0.56)):
        top.shade(x - NEAR, y + SIDE, a - NEAR, b + SIDE, 0.45, 0.08)
    for x, y, a, b in ((1.26, -0.58, 1.38, -0.46), (0.80, -0.52, 0.90, -0.36)):
        top.shade(x - NEAR, y + SIDE, a - NEAR, b + SIDE, 0.45, 0.08)
    return top.texels()


def _walls() -> list[Surface]:
    deep, wide = _FRONT - _BACK, _LEFT - _RIGHT
    floor = Picture(deep, wide, (0.86, 0.84, 0.80))
    floor.checker(0.5, (0.52, 0.56, 0.62))
    floor.grain(0.015, 2)
    floor.shade(NEAR - _BACK, -SIDE - _RIGHT, FAR - _BACK, SIDE - _RIGHT, 0.6, 0.45)
    floor.shade(0, 0, deep, 0.0, 0.35, 0.5)
    floor.shade(0, wide, deep, wide, 0.35, 0.5)
    floor.shade(deep, 0, deep, wide, 0.35, 0.5)
    floor.shade(0, 0, 0, wide, 0.35, 0.5)
    ceiling = Picture(deep, wide, (0.93, 0.93, 0.91))
    for x in (1.0, 3.2):
        for y in (0.9, 2.7):
            ceiling.shade(x, y, x + 0.9, y + 0.8, -0.08, 0.5)
            ceiling.rectangle(x, y, x + 0.9, y + 0.8, (1.0, 1.0, 0.97))
    ceiling.shade(deep, 0, deep, wide, 0.25, 0.6)
    return [
        Surface((_BACK, _RIGHT, 0), (deep, 0, 0), (0, wide, 0), floor.texels()),
        Surface((_BACK, _LEFT, _HIGH), (deep, 0, 0), (0, -wide, 0), ceiling.texels()[::-1]),
        Surface((_FRONT, _LEFT, 0), (0, -wide, 0), (0, 0, _HIGH), _front()),
        Surface((_BACK, _RIGHT, 0), (0, wide, 0), (0, 0, _HIGH), _back()),
        Surface((_BACK, _LEFT, 0), (deep, 0, 0), (0, 0, _HIGH), _left()),
        Surface((_FRONT, _RIGHT, 0), (-deep, 0, 0), (0, 0, _HIGH), _right()),
    ]


def _wall(width: float, colour: Colour) -> Picture:
    """Plaster, darker in the corners, with a skirting board; rows run upwards."""
    wall = Picture(width, _HIGH, colour)
    wall.grain(0.008)
    wall.shade(0, 0, 0, _HIGH, 0.28, 0.5)
    wall.shade(width, 0, width, _HIGH, 0.28, 0.5)
    wall.shade(0, 0, width, 0, 0.30, 0.6)
    wall.shade(0, _HIGH, width, _HIGH, 0.16, 0.4)
    wall.rectangle(0, 0, width, 0.10, (0.92, 0.91, 0.88))
    wall.rectangle(0, 0.10, width, 0.12, (0.70, 0.69, 0.66))
    return wall


def _front() -> NDArray[Any]:
    """A window, and a picture of coloured fields."""
    wall = _wall(_LEFT - _RIGHT, (0.83, 0.86, 0.88))
    wall.window(0.55, 0.95, 2.05, 2.15)
    wall.rectangle(2.75, 1.10, 3.85, 1.95, (0.25, 0.23, 0.22))
    wall.rectangle(2.79, 1.14, 3.81, 1.91, (0.96, 0.95, 0.92))
    for x, y, a, b, colour in (
        (2.83, 1.18, 3.13, 1.55, (0.85, 0.20, 0.16)),
        (2.83, 1.58, 3.13, 1.87, (0.13, 0.29, 0.55)),
        (3.16, 1.18, 3.77, 1.38, (0.95, 0.77, 0.20)),
        (3.16, 1.41, 3.45, 1.87, (0.93, 0.91, 0.86)),
        (3.48, 1.41, 3.77, 1.87, (0.18, 0.50, 0.45)),
    ):
        wall.rectangle(x, y, a, b, colour)
    return wall.texels()


def _left() -> NDArray[Any]:
    """Shelves with books."""
    import numpy as np

    wall = _wall(_FRONT - _BACK, (0.90, 0.83, 0.72))
    chance = np.random.default_rng(7)
    left, right = 2.6, 4.6
    wall.rectangle(left - 0.04, 0.12, right + 0.04, 2.08, (0.42, 0.29, 0.19))
    for low in (0.18, 0.66, 1.14, 1.62):
        wall.rectangle(left, low, right, low + 0.42, (0.23, 0.16, 0.11))
        x = left + 0.02
        while x < right - 0.08:
            thick, tall = chance.uniform(0.03, 0.07), chance.uniform(0.24, 0.38)
            if chance.random() < 0.9:
                hue = chance.choice(len(_BOOKS))
                wall.rectangle(x, low, x + thick - 0.008, low + tall, _BOOKS[hue])
                wall.rectangle(
                    x, low + 0.05, x + thick - 0.008, low + 0.08, _times(_BOOKS[hue], 1.5)
                )
            x += thick
    return wall.texels()


def _right() -> NDArray[Any]:
    """A door."""
    wall = _wall(_FRONT - _BACK, (0.74, 0.82, 0.76))
    wall.rectangle(1.10, 0, 2.10, 2.10, (0.95, 0.94, 0.91))
    wall.rectangle(1.17, 0, 2.03, 2.03, (0.55, 0.36, 0.25))
    for low, high in ((0.20, 0.95), (1.10, 1.85)):
        wall.rectangle(1.30, low, 1.90, high, (0.47, 0.30, 0.21))
        wall.rectangle(1.33, low + 0.03, 1.87, high - 0.03, (0.58, 0.39, 0.27))
    wall.rectangle(1.22, 1.00, 1.28, 1.06, (0.90, 0.80, 0.45))
    wall.window(3.2, 0.95, 4.5, 2.05)
    return wall.texels()


def _back() -> NDArray[Any]:
    """A chessboard pattern, as used to calibrate cameras."""
    wall = _wall(_LEFT - _RIGHT, (0.85, 0.78, 0.78))
    wall.rectangle(1.5, 0.9, 2.9, 1.9, (0.98, 0.98, 0.98))
    for row in range(8):
        for column in range(12):
            if (row + column) % 2:
                x, y = 1.6 + column * 0.1, 1.0 + row * 0.1
                wall.rectangle(x, y, x + 0.1, y + 0.1, (0.08, 0.08, 0.08))
    return wall.texels()


_BOOKS: Final = (
    (0.60, 0.16, 0.14),
    (0.16, 0.30, 0.48),
    (0.20, 0.42, 0.30),
    (0.78, 0.62, 0.26),
    (0.40, 0.24, 0.42),
    (0.85, 0.81, 0.70),
    (0.22, 0.22, 0.26),
)


def _times(colour: Colour, light: float) -> Colour:
    red, green, blue = (min(1.0, part * light) for part in colour)
    return red, green, blue
