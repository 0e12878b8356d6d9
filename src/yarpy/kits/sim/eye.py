"""Eye: a camera of a head, for `yarpy.devices.FrameGrabberServer`.

The eyes of a head share a shutter: pictures taken at about the same time show the same moment and
have the same time stamp, like those of two cameras with a common trigger.
"""

from __future__ import annotations

import threading
from math import atan, degrees
from typing import Any, Final

from yarpy.data.sig.image import Image
from yarpy.kits.sim.body import Body
from yarpy.kits.sim.head import Side, eye_pose
from yarpy.kits.sim.joint import Joint
from yarpy.kits.sim.render.renderer import Renderer
from yarpy.kits.sim.render.scene import Scene

LARGEST: Final = 2048  # pixels, either way
PAIR: Final = 0.015  # most seconds between the two pictures of a pair


class Shutter:
    """Shows each eye a moment once, and the other eye the same moment if it looks soon after."""

    def __init__(self, body: Body[Joint]) -> None:
        self._body = body
        self._lock = threading.Lock()  # each eye has its own thread
        self._angles: list[float] = []
        self._seen: set[Side] = set()
        self.time = body.time

    def open(self, side: Side) -> tuple[list[float], float]:
        """The angles of the joints in degrees, and their time."""
        with self._lock, self._body.present() as joints:
            now = self._body.time
            if side in self._seen or not 0 <= now - self.time <= PAIR or not self._angles:
                self._angles = [joint.position for joint in joints]
                self.time = now
                self._seen.clear()
            self._seen.add(side)
            return self._angles, self.time


class Eye:
    """One eye of a head, looking at `scene`; `width` times `height` pixels."""

    def __init__(
        self, shutter: Shutter, scene: Scene, side: Side, width: int = 320, height: int = 240
    ) -> None:
        self._shutter = shutter
        self._scene = scene
        self._side: Side = side
        self._renderer = Renderer(scene, width, height)
        self._time = shutter.time

    def image(self) -> Image:
        """Return the picture that the eye sees now, as rgb in its own memory."""
        angles, self._time = self._shutter.open(self._side)
        return Image(self._renderer.render(eye_pose(angles, self._side), self._time))

    def timestamp(self) -> float:
        """The moment that the last image shows."""
        return self._time

    @property
    def resolution(self) -> tuple[int, int]:
        """Width and height in pixels; changing them keeps the field of view."""
        lens = self._renderer.lens
        return lens.width, lens.height

    @resolution.setter
    def resolution(self, size: tuple[int, int]) -> None:
        width, height = size
        if not (16 <= width <= LARGEST and 16 <= height <= LARGEST):
            raise ValueError(f"{width} x {height} pixels: each side must be 16 to {LARGEST}")
        self._renderer = Renderer(self._scene, width, height)

    @property
    def field_of_view(self) -> tuple[float, float]:
        """Horizontal and vertical, degrees."""
        lens = self._renderer.lens
        return (
            degrees(2 * atan(lens.width / 2 / lens.focal)),
            degrees(2 * atan(lens.height / 2 / lens.focal)),
        )

    @property
    def intrinsics(self) -> dict[str, Any]:
        """Return the parameters of a pinhole camera, in pixels."""
        lens = self._renderer.lens
        return {
            "physFocalLength": 0.0,
            "focalLengthX": lens.focal,
            "focalLengthY": lens.focal,
            "principalPointX": lens.centre[0],
            "principalPointY": lens.centre[1],
            "distortionModel": "plumb_bob",
            "k1": 0.0,
            "k2": 0.0,
            "t1": 0.0,
            "t2": 0.0,
            "k3": 0.0,
        }
