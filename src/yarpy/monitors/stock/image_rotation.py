"""image_rotation: turn or mirror images, at either end.

Parameters, as in C++ YARP 4: `options_rotate` is rotate_cw, rotate_ccw (a quarter turn), rotate_180
or rotate_none, `options_flip` is flip_x (upside down), flip_y (left to right), flip_xy or
flip_none. Rotation comes first. Without parameters this rotates clockwise, as C++ YARP 3 does.

Rules: every pixel type except patterns of several pixels (Bayer, yuv), which a rotation would
break.
"""

from __future__ import annotations

from yarpy.data.sig.image import Image
from yarpy.errors import LocalProtocolError
from yarpy.monitors.base import Place
from yarpy.monitors.imaging.picture import picture
from yarpy.wire.message import Message

_TURNS = {"rotate_cw": -1, "rotate_ccw": 1, "rotate_180": 2, "rotate_none": 0}
_FLIPS: dict[str, tuple[int, ...]] = {
    "flip_x": (0,),
    "flip_y": (1,),
    "flip_xy": (0, 1),
    "flip_none": (),
}
_CODES = (
    *("mono", "mo16", "int", "sign", "dec", "rgb", "rgba", "bgr", "bgra", "hsv"),
    *("rgb-", "rgbi", "rgb.", "hsv."),
)


class ImageRotation:
    """Rotates and mirrors every image."""

    def __init__(self, place: Place) -> None:
        flip = place.text("options_flip", "flip_none")
        turn = place.text("options_rotate", "rotate_cw" if flip == "flip_none" else "rotate_none")
        for key, value, known in (("rotate", turn, _TURNS), ("flip", flip, _FLIPS)):
            if value not in known:
                raise LocalProtocolError(
                    f'"options_{key}" must be one of {", ".join(known)}, not "{value}"'
                )
        self._turn = _TURNS[turn]
        self._flip = _FLIPS[flip]

    def update(self, message: Message) -> Image:
        import numpy as np

        image = picture(message, *_CODES)
        turned = np.flip(np.rot90(image.array, self._turn), self._flip)
        return Image(np.ascontiguousarray(turned), str(image.code), image.quantum)
