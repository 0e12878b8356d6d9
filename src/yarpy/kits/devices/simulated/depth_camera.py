"""SimulatedDepthCamera: a camera that sees a ball in front of a wall; fakeDepthCamera in C++.

Rules: the ball goes round by the clock that the camera is given. Its features are brightness and
gain. Its lens is that of a pinhole camera.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final

import yarpy
from yarpy import clock
from yarpy.data.value import Vocab
from yarpy.kits.devices.frame_grabber.interface import FEATURES
from yarpy.kits.devices.interfaces.media import Configuration, When
from yarpy.kits.devices.refusal import Refused

#: Metres from the camera to the wall and to the ball, and the ball's radius.
WALL: Final = 3.0
BALL: Final = 1.5
RADIUS: Final = 0.3
_IN_USE: Final = 2


class SimulatedDepthCamera:
    """Most members of `interfaces.depth.DepthCamera`: all but what it has no feature for."""

    def __init__(
        self, width: int = 320, height: int = 240, clock: Callable[[], float] = clock.monotonic
    ) -> None:
        self._clock = clock
        self._size = width, height
        self._angles = 60.0, 45.0
        self._mirrored = False
        self._planes = 0.2, 10.0
        self._accuracy = 0.001
        self._features = {FEATURES.index("brightness"): 0.5, FEATURES.index("gain"): 0.5}

    def colour(self) -> yarpy.Image:
        """Return a red ball, on grey."""
        import numpy as np

        ball = self._ball()
        picture = np.full((*ball.shape, 3), 90, "u1")
        picture[ball] = (200, 30, 30)
        return yarpy.Image(picture)

    def depth(self) -> yarpy.Image:
        """Return the distances."""
        import numpy as np

        near, far = self._planes
        found = np.where(self._ball(), BALL, WALL).astype("f4")
        found[(found < near) | (found > far)] = 0.0
        return yarpy.Image(found)

    def extrinsics(self) -> yarpy.Matrix:
        """Return the identity: both are one."""
        import numpy as np

        return yarpy.Matrix(np.eye(4))

    def last_error(self) -> tuple[str, When]:
        """Return that nothing went wrong."""
        return "", When()

    def status(self) -> int:
        """Return that it is in use."""
        return _IN_USE

    def width(self) -> int:
        """Return the width."""
        return self._size[0]

    def height(self) -> int:
        """Return the height."""
        return self._size[1]

    def resolution(self) -> tuple[int, int]:
        """Return width and height."""
        return self._size

    def resize(self, width: int, height: int) -> None:
        """Change them."""
        if not (0 < width <= 4096 and 0 < height <= 4096):
            raise Refused(f"pictures are 1 to 4096 pixels wide and high, not {width} x {height}")
        self._size = width, height

    def configurations(self) -> list[Configuration]:
        """Return the present one."""
        return [Configuration(*self._size, 30.0, Vocab("rgb").code)]

    def field_of_view(self) -> tuple[float, float]:
        """Return the angles."""
        return self._angles

    def widen(self, horizontal: float, vertical: float) -> None:
        """Change them."""
        if not (0.0 < horizontal < 180.0 and 0.0 < vertical < 180.0):
            raise Refused(f"angles are between 0 and 180 degrees, not {horizontal}, {vertical}")
        self._angles = horizontal, vertical

    def intrinsics(self) -> yarpy.Property:
        """Return the parameters of a pinhole."""
        width, height = self._size
        across, down = self._focal_lengths()
        return yarpy.Property(
            {
                "physFocalLength": 0.0,
                "focalLengthX": across,
                "focalLengthY": down,
                "principalPointX": width / 2,
                "principalPointY": height / 2,
                "distortionModel": "none",
            }
        )

    def mirrored(self) -> bool:
        """Return what was said."""
        return self._mirrored

    def mirror(self, mirror: bool) -> None:
        """Exchange left and right."""
        self._mirrored = mirror

    colour_width = depth_width = width
    colour_height = depth_height = height
    colour_resolution = depth_resolution = resolution
    resize_colour = resize_depth = resize
    colour_field_of_view = depth_field_of_view = field_of_view
    widen_colour = widen_depth = widen
    colour_intrinsics = depth_intrinsics = intrinsics
    colour_mirrored = depth_mirrored = mirrored
    mirror_colour = mirror_depth = mirror

    def accuracy(self) -> float:
        """Return what was said."""
        return self._accuracy

    def change_accuracy(self, accuracy: float) -> None:
        """Keep the value; pictures stay as they are."""
        self._accuracy = accuracy

    def clip_planes(self) -> tuple[float, float]:
        """Return between which distances it measures."""
        return self._planes

    def change_clip_planes(self, near: float, far: float) -> None:
        """Measure between others; the rest is 0."""
        self._planes = near, far

    def description(self) -> tuple[int, str]:
        """Return that it is simulated."""
        return 0, "fakeDepthCamera"

    def has_feature(self, feature: int) -> bool:
        """Return whether it is one of two."""
        return feature in self._features

    def feature(self, feature: int) -> float:
        """Return its value."""
        return self._features[self._known(feature)]

    def change_feature(self, feature: int, value: float) -> None:
        """Change it."""
        self._features[self._known(feature)] = value

    def has_switch(self, feature: int) -> bool:
        """Return False."""
        return False

    has_automatic = has_one_push = has_switch

    def has_manual(self, feature: int) -> bool:
        """Return whether it has the feature."""
        return feature in self._features

    def _known(self, feature: int) -> int:
        if feature not in self._features:
            raise Refused(f"there is no feature {feature}")
        return feature

    def _focal_lengths(self) -> tuple[float, float]:
        (width, height), (across, down) = self._size, self._angles
        return (
            width / 2 / math.tan(math.radians(across) / 2),
            height / 2 / math.tan(math.radians(down) / 2),
        )

    def _ball(self) -> Any:
        """Return the mask of the pixels that show the ball."""
        import numpy as np

        width, height = self._size
        fx, fy = self._focal_lengths()
        angle = self._clock()
        x = width / 2 + fx * 0.4 * math.cos(angle) / BALL
        y = height / 2 + fy * 0.3 * math.sin(angle) / BALL
        rows, columns = np.ogrid[:height, :width]
        if self._mirrored:
            columns = width - 1 - columns
        return ((columns - x) / fx) ** 2 + ((rows - y) / fy) ** 2 < (RADIUS / BALL) ** 2
