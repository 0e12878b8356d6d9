"""depthimage_to_mono: depth images (pixels `dec`, in metres) as grey, the nearest brightest.

From 0.2 to 10 m grey is 255 - v * 255 / 9.8, truncated, as in C++ YARP; values nearer, farther or
not a number are 0. Either end.
"""

from __future__ import annotations

from yarpy.data.sig.image import Image
from yarpy.monitors.base import Place
from yarpy.monitors.imaging.picture import picture
from yarpy.wire.message import Message

#: metres; C++ divides by the difference without subtracting the minimum
NEAREST, FARTHEST = 0.2, 10.0


class DepthImageToMono:
    """Grey for depth."""

    def __init__(self, place: Place) -> None:
        pass

    def update(self, message: Message) -> Image:
        import numpy as np

        depth = picture(message, "dec").array.astype("f8")
        valid = (depth >= NEAREST) & (depth <= FARTHEST)
        grey = 255 - np.where(valid, depth, FARTHEST) * 255 / (FARTHEST - NEAREST)
        return Image(np.where(valid, np.clip(grey, 0, 255), 0).astype("u1"), "mono")
