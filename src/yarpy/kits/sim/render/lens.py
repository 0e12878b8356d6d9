"""Lens: where points and surfaces of the world appear in a picture.

A flat surface and its picture are related by a 3 x 3 matrix: with K the camera, R and p its pose,
M = K R' [u v corner-p] maps (a, b, 1), a point on the surface with a and b from 0 to 1, to the
pixel (x z, y z, z). The inverse of M maps a pixel (x, y, 1) to (a/z, b/z, 1/z): three linear
functions of x and y, which is all that painting a surface needs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from yarpy.kits.sim.head import Pose
from yarpy.kits.sim.rotation import Vector, seen_from

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array: TypeAlias = NDArray[Any]

NEAR: Final = 0.02  # metres; a ball that comes closer is not seen

_ENDS: Final = ((0.0, 1.0, 0.0, 1.0), (0.0, 0.0, 1.0, 1.0), (1.0, 1.0, 1.0, 1.0))  # of a surface


@dataclass(frozen=True, slots=True)
class Box:
    """A part of the picture, in pixels; the ends are exclusive."""

    left: int
    top: int
    right: int
    bottom: int

    @property
    def empty(self) -> bool:
        return self.left >= self.right or self.top >= self.bottom

    def common(self, other: Box) -> Box:
        """The intersection; it may be empty."""
        return Box(
            max(self.left, other.left),
            max(self.top, other.top),
            min(self.right, other.right),
            min(self.bottom, other.bottom),
        )

    def of(self, picture: Array) -> Array:
        """This part of a picture, as a view."""
        part: Array = picture[self.top : self.bottom, self.left : self.right]
        return part


NOWHERE: Final = Box(0, 0, 0, 0)


def around(one: Box, other: Box) -> Box:
    """The smallest box that contains both."""
    if one.empty or other.empty:
        return one if other.empty else other
    return Box(
        min(one.left, other.left),
        min(one.top, other.top),
        max(one.right, other.right),
        max(one.bottom, other.bottom),
    )


@dataclass(frozen=True, slots=True)
class Spans:
    """The pixels that show each surface: one span per row, as surfaces are convex.

    left, right: its first pixel and the one after its last, (n, height) int16. boxes: one for each
    surface, empty if it is not in the picture.
    """

    left: Array
    right: Array
    boxes: Sequence[Box]

    def within(self, box: Box) -> tuple[Array, Array]:
        """The spans clipped to a box."""
        import numpy as np

        left, right = np.full_like(self.left, 0), np.full_like(self.right, 0)
        rows = slice(box.top, box.bottom)
        left[:, rows] = np.maximum(self.left[:, rows], box.left)
        right[:, rows] = np.minimum(self.right[:, rows], box.right)
        return left, right


class Lens:
    """A camera without distortion: `width` times `height` pixels, focal length in pixels."""

    def __init__(self, width: int, height: int, focal: float) -> None:
        import numpy as np

        self.width, self.height, self.focal = width, height, focal
        self.centre = (width - 1) / 2, (height - 1) / 2
        self._pixels = np.array(
            [[focal, 0, self.centre[0]], [0, focal, self.centre[1]], [0, 0, 1.0]]
        )
        self._rows = np.arange(height, dtype="f4")

    def matrices(self, pose: Pose, u: Array, v: Array, away: Array) -> Array:
        """M for surfaces with sides `u` and `v` and a corner `away` from the camera, each (n, 3)
        in the world: (n, 3, 3)."""
        import numpy as np

        basis = np.empty((len(u), 3, 3))
        basis[:, :, 0], basis[:, :, 1], basis[:, :, 2] = u, v, away
        found: Array = (self._pixels @ np.array(pose.rotation).T) @ basis
        return found

    def candidates(self, matrices: Array) -> Array:
        """The numbers of the surfaces that may be in the picture; the others cannot be."""
        import numpy as np

        x, y, z = (matrices @ _ENDS).transpose(1, 0, 2)
        sides = np.stack((z, x, y, z * (self.width - 1) - x, z * (self.height - 1) - y))
        found: Array = np.flatnonzero((sides.max(2) > 0).all(0))
        return found

    def spans(self, inverses: Array) -> Spans:
        """Return the pixels where surfaces are visible, given the inverses of their matrices (n, 3,
        3).

        A pixel (x, y) is on a surface if 0 <= a <= 1 and 0 <= b <= 1: four inequalities, linear
        in x.
        """
        import numpy as np

        edges = np.empty((4, len(inverses), 3))
        edges[0], edges[1], depth = inverses.transpose(1, 0, 2)
        np.subtract(depth, edges[:2], out=edges[2:])
        slope = edges[:, :, 0]
        # An edge parallel to the rows gets a tiny slope instead of none, so that it ends far
        # outside on either side.
        slope[abs(slope) < 1e-12] = 1e-12
        edges[:, :, 1:] /= -slope[:, :, None]
        of_y, rest = edges[:, :, 1:].astype("f4").transpose(2, 0, 1)
        ends = of_y[:, :, None] * self._rows
        # Rising edges bound spans on the left, the others on the right.
        rising = slope > 0
        left = (ends + np.where(rising, rest, -np.inf)[:, :, None]).max(0)
        right = (ends + np.where(rising, np.inf, rest + 1)[:, :, None]).min(0)
        left = np.ceil(np.clip(left, 0, self.width)).astype("i2")
        right = np.clip(right, 0, self.width).astype("i2")
        return Spans(left, right, self._boxes(left, right))

    def _boxes(self, left: Array, right: Array) -> list[Box]:
        import numpy as np

        shown = left < right
        found = zip(
            np.where(shown, left, self.width).min(1).tolist(),
            shown.argmax(1).tolist(),
            (right * shown).max(1).tolist(),
            (self.height - shown[:, ::-1].argmax(1)).tolist(),
            strict=True,
        )
        return [Box(*each) if each[0] < each[2] else NOWHERE for each in found]

    def bounds(self, matrix: Array) -> Box:
        """A box around one surface, given its matrix; empty if part of it is behind the camera."""
        x, y, z = (matrix @ _ENDS).tolist()
        if min(z) < NEAR:
            return NOWHERE
        x, y = ([value / z for value, z in zip(part, z, strict=True)] for part in (x, y))
        return self.box(min(x), min(y), max(x), max(y))

    def box(self, left: float, top: float, right: float, bottom: float) -> Box:
        """The pixels between these positions, clipped to the picture."""
        width, height = self.width, self.height
        return Box(
            int(min(max(left, 0), width)),
            int(min(max(top, 0), height)),
            int(min(max(right + 1, 0), width)),
            int(min(max(bottom + 1, 0), height)),
        )

    def point(self, pose: Pose, place: Vector) -> Vector:
        """Pixel x, y and the depth in metres of a point in the world."""
        p, q, r = pose.position
        x, y, depth = seen_from(pose.rotation, (place[0] - p, place[1] - q, place[2] - r))
        scale = self.focal / max(depth, 1e-9)
        return x * scale + self.centre[0], y * scale + self.centre[1], depth
