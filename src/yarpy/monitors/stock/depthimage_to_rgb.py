"""depthimage_to_rgb: depth images (pixels `dec`, in metres) as colours from blue to black.

The colours of C++ YARP: v / 9.8 runs through blue, green, yellow, red and black; values nearer than
0.2 m, farther than 10 m or not a number are black. Either end.
"""

from __future__ import annotations

from yarpy.data.sig.image import Image
from yarpy.monitors.base import Place
from yarpy.monitors.imaging.picture import picture
from yarpy.monitors.stock.depthimage_to_mono import FARTHEST, NEAREST
from yarpy.wire.message import Message

_KNOTS = ((0, 0, 1), (0, 1, 0), (1, 1, 0), (1, 0, 0), (0, 0, 0))


class DepthImageToRgb:
    """Colours for depth."""

    def __init__(self, place: Place) -> None:
        pass

    def update(self, message: Message) -> Image:
        import numpy as np

        depth = picture(message, "dec").array
        valid = (depth >= NEAREST) & (depth <= FARTHEST)
        share = (np.where(valid, depth, FARTHEST).astype("f8") / (FARTHEST - NEAREST)).astype("f4")
        scaled = np.minimum(share, np.float32(1)) * np.float32(len(_KNOTS) - 1)
        below = np.minimum(scaled.astype("i4"), len(_KNOTS) - 2)
        part = (scaled - below.astype("f4"))[..., None]
        knots = np.array(_KNOTS, "f4")
        colour = ((knots[below + 1] - knots[below]) * part + knots[below]) * np.float32(255)
        return Image((colour * valid[..., None]).astype("u1"), "rgb")
