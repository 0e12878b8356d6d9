"""PNG: compress an Image without loss, and decompress it.

Rules: OpenCV does the work; the caller passes it in. The size of a picture is checked before memory
is allocated for its pixels, and so are its checksums, since libpng makes a picture even from half a
file. Anything wrong with it is a DecodeError.
"""

from __future__ import annotations

import zlib
from typing import Any, Final

from yarpy.data.sig.image import Image
from yarpy.errors import DecodeError
from yarpy.limit import limits

#: pixel codes that a PNG can hold; Bayer patterns as the grey images they are
CODES: Final = (
    *("mono", "rgb", "rgba", "bgr", "bgra", "grbg", "gbrg", "rggb", "bggr"),
    *("mo16", "gr16", "gb16", "rg16", "bg16"),
)
_ORDERED: Final = {"rgb": "bgr", "rgba": "bgra"}  # OpenCV's order of colours
_START: Final = b"\x89PNG\r\n\x1a\n"


def encode(cv2: Any, image: Image) -> bytes:
    """The picture as a PNG file; ValueError for one without pixels."""
    import numpy as np

    if not image.width or not image.height:
        raise ValueError("an image without pixels cannot be a PNG")
    code = str(image.code)
    array = image.converted(_ORDERED.get(code, code)).array
    _, data = cv2.imencode(".png", np.ascontiguousarray(array))
    return bytes(data)


def decode(cv2: Any, data: bytes, code: str, limit: int) -> Image:
    """The picture of a PNG file as an image of pixels `code`.

    DecodeError if it is not a PNG of such pixels, is damaged, or may take more bytes than `limit`
    or YARPY_MAX_PICTURE.
    """
    import numpy as np

    _check(data, min(limit, limits().picture))
    try:
        array = cv2.imdecode(np.frombuffer(data, "u1"), cv2.IMREAD_UNCHANGED)
        if array is None:
            raise DecodeError("not a readable PNG")
        return Image(array, _ORDERED.get(code, code)).converted(code)
    except (ValueError, cv2.error) as error:
        raise DecodeError(f"not a PNG of pixels {code}: {error}") from error


def _check(data: bytes, limit: int) -> None:
    """Check that the file is whole and not too large."""
    width, height = (int.from_bytes(data[at : at + 4], "big") for at in (16, 20))
    if not data.startswith(_START + b"\0\0\0\rIHDR"):
        raise DecodeError("not a PNG: it does not begin like one")
    if width * height * 8 > limit:  # four channels of 16 bits
        raise DecodeError(
            f"a PNG of {width} x {height} pixels; the limit is {limit} bytes (the port's, or "
            "YARPY_MAX_PICTURE)"
        )
    at = len(_START)
    while at + 12 <= len(data):
        end = at + 12 + int.from_bytes(data[at : at + 4], "big")
        if zlib.crc32(data[at + 4 : end - 4]) != int.from_bytes(data[end - 4 : end], "big"):
            raise DecodeError("the PNG is damaged: its checksums do not match")
        if data[at + 4 : at + 8] == b"IEND":
            return
        at = end
    raise DecodeError("the PNG is cut off")
