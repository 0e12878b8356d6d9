"""Renderer: what a camera sees of a scene, as pixels, with numpy alone.

    renderer = Renderer(room(), 320, 240)
    pixels = renderer.render(pose, time)             # (240, 320, 3) uint8

Rules: surfaces are painted from back to front, without a depth buffer: the background is behind
everything, solids do not touch each other. Static surfaces are repainted only if the camera has
moved. One thread at a time.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from yarpy.kits.sim.head import Pose
from yarpy.kits.sim.render.lens import NEAR, NOWHERE, Box, Lens, Spans, around
from yarpy.kits.sim.render.picture import Colour
from yarpy.kits.sim.render.scene import Ball, Scene
from yarpy.kits.sim.render.texture_mapper import TextureMapper
from yarpy.kits.sim.rotation import Vector, seen_from

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array: TypeAlias = NDArray[Any]

SHADES: Final = 64  # shades of each colour of a ball
LIGHT: Final = (-0.45, 0.35, 0.82)  # where it comes from, in the world

_QUARTER: Final = 0x3F3F3F  # what is left of r, g, b after a shift by two


class Renderer:
    """Pictures of `scene`, `width` times `height` pixels.

    focal: the focal length in pixels; default: the view of an iCub's eye, 64 degrees wide.
    """

    def __init__(
        self, scene: Scene, width: int = 320, height: int = 240, focal: float = 0.0
    ) -> None:
        import numpy as np

        self.scene = scene
        self.lens = Lens(width, height, focal or 0.8 * width)
        surfaces = [s for faces in (scene.background, *scene.solids) for s in faces]
        self._corner = np.array([s.corner for s in surfaces], float)
        self._u = np.array([s.u for s in surfaces], float)
        self._v = np.array([s.v for s in surfaces], float)
        self._normal = np.cross(self._u, self._v)
        self._mapper = TextureMapper([s.texels for s in surfaces], width, height)
        self._shades = {ball: _shades(ball.colours) for ball in scene.balls}
        sizes = [len(scene.background), *map(len, scene.solids)]
        self._solid = np.repeat(np.arange(len(sizes)), sizes)  # which body a surface is part of
        middles = self._corner + (self._u + self._v) / 2
        ends = np.cumsum(sizes)
        self._middles = [middles[e - n : e].mean(0) for n, e in zip(sizes, ends, strict=True)]
        self._x = np.arange(width, dtype="f4")
        self._y = np.arange(height, dtype="f4")[:, None]
        self._still, self._frame = np.zeros((2, height, width), "u4")
        self._background = np.zeros((height, width, 3), "u1")  # `_still` as bytes
        self._seen: Pose | None = None  # the pose for which it was painted
        self._changed: list[Box] = []  # where `_frame` differs from `_still`
        # The faces of solids visible from there, the farthest first, and their distances.
        self._faces: tuple[Array, Array, Spans, Array] | None = None

    def render(self, pose: Pose, time: float) -> NDArray[Any]:
        """Return the view of a camera at `pose` at `time` (seconds): (height, width, 3), a new
        array."""
        import numpy as np

        with np.errstate(all="ignore"):  # for pixels whose ray runs along a surface
            if pose != self._seen:
                self._paint_still(pose)
                self._frame[...] = self._still
                self._unpack(self._frame, self._background)
                self._seen = pose
            for box in self._changed:
                box.of(self._frame)[...] = box.of(self._still)
            self._changed = [self._paint_ball(pose, ball, time) for ball in self.scene.balls]
        pixels = self._background.copy()
        for box in self._changed:
            self._unpack(box.of(self._frame), box.of(pixels))
        return pixels

    def _unpack(self, texels: Array, pixels: Array) -> None:
        """Write texels (h, w) as bytes (h, w, 3)."""
        bytes_ = texels.view("u1").reshape(*texels.shape, 4)
        for channel in range(3):
            pixels[..., channel] = bytes_[..., channel]

    # -- what stands still --------------------------------------------------------------------

    def _paint_still(self, pose: Pose) -> None:
        """Paint background and solids, and remember where the solids are."""
        import numpy as np

        away = self._corner - pose.position
        numbers = ((away * self._normal).sum(1) < -1e-9).nonzero()[0]
        distances = np.array([math.dist(m, pose.position) for m in self._middles])
        distances[0] = np.inf  # of the background
        order = np.argsort(-distances[self._solid[numbers]], kind="stable")
        numbers = numbers[order]
        matrices = self.lens.matrices(pose, self._u[numbers], self._v[numbers], away[numbers])
        chosen = self.lens.candidates(matrices)
        numbers = numbers[chosen]
        inverses = np.linalg.inv(matrices[chosen])
        spans = self.lens.spans(inverses)
        inverses[:, :2] *= self._mapper.sizes[numbers][:, :, None]
        inverses = inverses.astype("f4")
        count = int((self._solid[numbers] == 0).sum())
        first = next((k for k in range(count) if not spans.boxes[k].empty), 0)
        for k in range(count):
            if not spans.boxes[k].empty:
                number = int(numbers[k])
                left, right = spans.left[k], spans.right[k]
                self._mapper.fill(
                    self._still, number, inverses[k], left, right, spans.boxes[k], first=k == first
                )
        of_solids = Spans(spans.left[count:], spans.right[count:], spans.boxes[count:])
        self._faces = (
            numbers[count:], inverses[count:], of_solids, distances[self._solid[numbers[count:]]],
        )  # fmt: skip
        self._mapper.sprinkle(
            self._still, numbers[count:], inverses[count:], of_solids.left, of_solids.right
        )

    # -- what moves ---------------------------------------------------------------------------

    def _paint_ball(self, pose: Pose, ball: Ball, time: float) -> Box:
        """Paint a ball, its shadow, and again the solids in front of them; returns that box."""
        place = ball.place(time)
        painted = around(
            self._paint_shadow(pose, ball, place), self._paint_sphere(pose, ball, place, time)
        )
        if painted.empty or self._faces is None:
            return painted
        numbers, inverses, spans, distances = self._faces
        distance = math.dist(place, pose.position)
        in_front = [
            k
            for k, box in enumerate(spans.boxes)
            if distances[k] < distance and not painted.common(box).empty
        ]
        if in_front:
            part = Spans(spans.left[in_front], spans.right[in_front], ())
            self._mapper.sprinkle(
                self._frame, numbers[in_front], inverses[in_front], *part.within(painted)
            )
        return painted

    def _paint_shadow(self, pose: Pose, ball: Ball, place: Vector) -> Box:
        """Darken the ground below a ball; the higher the ball, the larger its shadow."""
        import numpy as np

        x, y, z = place
        radius = ball.radius + 0.15 * (z - ball.radius - ball.ground)
        away = np.array([(x - radius, y - radius, ball.ground)]) - pose.position
        if away[0, 2] > -1e-3:
            return NOWHERE  # the ground is not visible from below
        u, v = np.array([[(2 * radius, 0, 0)], [(0, 2 * radius, 0)]])
        matrix = self.lens.matrices(pose, u, v, away)[0]
        box = self.lens.bounds(matrix)
        if box.empty:
            return box
        u, v, _ = self._mapper.places(np.linalg.inv(matrix).astype("f4"), box)
        for part in (u, v):
            part -= 0.5
            part *= part
        u += v
        frame = box.of(self._frame)
        for size in (0.25, 0.14):
            np.copyto(frame, frame - ((frame >> 2) & _QUARTER), where=u < size)
        return box

    def _paint_sphere(self, pose: Pose, ball: Ball, place: Vector, time: float) -> Box:
        """Paint a ball, lit from `LIGHT`."""
        import numpy as np

        x, y, depth = self.lens.point(pose, place)
        if depth < NEAR + ball.radius:
            return NOWHERE
        radius = self.lens.focal * ball.radius / depth
        box = self.lens.box(x - radius, y - radius, x + radius, y + radius)
        if box.empty:
            return box
        across = (self._x[box.left : box.right] - x) / radius
        along = (self._y[box.top : box.bottom] - y) / radius
        flat = across * across + along * along
        towards = -np.sqrt(np.maximum(1 - flat, 0))
        a, b, c = seen_from(pose.rotation, LIGHT)
        light = np.clip(across * a + along * b + towards * c, 0, 1)
        shade = (light * (SHADES - 1)).astype(np.intp)
        a, b, c = seen_from(pose.rotation, ball.axis(time))
        shade[across * a + along * b + towards * c > 0] += SHADES
        np.copyto(box.of(self._frame), self._shades[ball][shade], where=flat < 1)
        return box


def _shades(colours: Sequence[Colour]) -> Array:
    """The colours from darkest to brightest, as texels."""
    import numpy as np

    light = np.linspace(0, 1, SHADES)[:, None]
    shades = [np.array(c) * (0.30 + 0.75 * light) + 0.6 * light**40 for c in colours]
    bytes_ = (np.clip(np.concatenate(shades), 0, 1) * 255).astype("u4")
    packed: Array = bytes_[:, 0] | bytes_[:, 1] << 8 | bytes_[:, 2] << 16
    return packed
