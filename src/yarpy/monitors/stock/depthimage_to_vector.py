"""depthimage_to_vector: depth images (pixels `dec`) as a Vector of float64, row by row.

As in C++ YARP, but without the row padding that C++ treats as pixels. Either end.
"""

from __future__ import annotations

from yarpy.data.sig.vector import Vector
from yarpy.monitors.base import Place
from yarpy.monitors.imaging.picture import picture
from yarpy.wire.message import Message


class DepthImageToVector:
    """Numbers for depth."""

    def __init__(self, place: Place) -> None:
        pass

    def update(self, message: Message) -> Vector:
        return Vector(picture(message, "dec").array.astype("f8").ravel())
