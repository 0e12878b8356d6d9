"""Pictures as JPEG files, in OpenCV's order of colours: blue, green, red."""

from __future__ import annotations

from typing import Any

import yarpy
from yarpy.data.sig import jpeg


class JpegEncoder:
    """`JpegEncoder(quality=95).encode_jpg_image(array)`; `encoder` is accepted, libjpeg does it."""

    def __init__(self, quality: int = 95, encoder: str = "opencv", **kwargs: Any) -> None:
        self.quality = quality

    def encode_jpg_image(self, img: Any, return_numpy: bool = False) -> Any:
        """The file's bytes; with `return_numpy` as an array of them."""
        import numpy as np

        code = "bgr" if img.ndim == 3 else "mono"
        data = jpeg.encode(yarpy.Image(np.ascontiguousarray(img), code), self.quality)
        return np.frombuffer(data, "u1") if return_numpy else data


def decode_jpg(data: bytes, rgb: bool) -> Any:
    """The picture of a file, (height, width, 3) as blue, green, red, or (height, width)."""
    found = yarpy.Image.from_wire(jpeg.decode(data))
    return found.converted("bgr" if rgb else "mono").array
