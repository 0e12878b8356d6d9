"""SimulatedCamera: a camera without hardware, fakeFrameGrabber in C++.

Rules: it has the members that `frame_grabber.interface` describes.
"""

from __future__ import annotations

from typing import Any

from yarpy import clock


class SimulatedCamera:
    """A camera that sees a white line, which goes down."""

    description = ("unknown", "fakeFrameGrabber")

    def __init__(self, width: int = 320, height: int = 240) -> None:
        self.resolution = (width, height)
        self.features = {"brightness": 0.5, "gain": 0.5}
        self._begin = clock.monotonic()

    def image(self) -> Any:
        """The picture at this time."""
        import numpy as np

        width, height = self.resolution
        picture = np.zeros((height, width, 3), "u1")
        picture[:, :, 2] = 80
        picture[int((clock.monotonic() - self._begin) * 30) % height] = 255
        return picture
