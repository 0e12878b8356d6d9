"""The picture files of C++ recordings, read: PGM, PPM, PNG, JPEG, `.float`, `.floatzip`.

Rules: the first bytes say what a file is, not its name: C++ writes PPM into files called .png and
.jpg. Sizes are checked before memory is taken. The pixels get the code that the log gives.
"""

from __future__ import annotations

import re
import zlib
from struct import error
from typing import Any, Final

import numpy as np

from yarpy.data.sig import jpeg
from yarpy.data.sig.image import Image
from yarpy.data.sig.pixel import pixel_of
from yarpy.errors import DecodeError, UnknownPlugin
from yarpy.kits.record.dumper.part import BAYER, SHAPE
from yarpy.limit import limits

_PNM: Final = re.compile(
    rb"(P[56])\s(?:#[^\n]*\n)*\s*(\d{1,6})\s+(\d{1,6})\s+(\d{1,5})\s", re.ASCII
)
_FLOAT: Final = 4  # bytes


def read_picture(data: bytes, name: str, code: str) -> Image:
    """Return the picture of a file called `name` with pixels `code`, "" for what it looks like.
    DecodeError if it is none; UnknownPlugin where a library is missing."""
    if data[:2] in (b"P5", b"P6"):
        return _coded(_pnm(data), code)
    if data[:8] == b"\x89PNG\r\n\x1a\n":
        return _coded(_png(data), code)
    if data[:2] == b"\xff\xd8":
        return _coded(_jpeg(data), code)
    if name.endswith(".floatzip"):
        return _floats(data[: SHAPE.size] + _unzipped(data), name)
    if name.endswith(".float"):
        return _floats(data, name)
    raise DecodeError(f"{name} is no picture that C++ writes")


def _pnm(data: bytes) -> Any:
    match = _PNM.match(data)
    if match is None or int(match[4]) != 255:
        raise DecodeError("a PGM or PPM file with another head than C++ writes")
    width, height, depth = int(match[2]), int(match[3]), 3 if match[1] == b"P6" else 1
    size = width * height * depth
    if len(data) - match.end() < size or size > limits().picture:
        raise DecodeError(f"a picture of {width} times {height} in a file of {len(data)} bytes")
    array = np.frombuffer(data, "u1", size, match.end())
    return array.reshape((height, width, 3) if depth == 3 else (height, width))


def _png(data: bytes) -> Any:
    try:
        import cv2
    except ImportError:
        raise UnknownPlugin('pictures as PNG need OpenCV: pip install "yarpy[vision]"') from None
    from yarpy.data.sig import png

    grey = data[25:26] in (b"\0", b"\4")  # the kind of colour in its head
    return png.decode(cv2, data, "mono" if grey else "rgb", limits().picture).array


def _jpeg(data: bytes) -> Any:
    wire = jpeg.decode(data, limits().picture)
    return Image.from_wire(wire).array


def _floats(data: bytes, name: str) -> Image:
    """The rows may be padded to 8 bytes where the width is odd, which C++ counts as pixels."""
    try:
        height, width = SHAPE.unpack_from(data)
    except error:
        raise DecodeError(f"{name} ends in its head") from None
    size = height * width * _FLOAT
    if size > limits().picture or len(data) - SHAPE.size < size:
        raise DecodeError(f"{name}: {width} times {height} numbers in {len(data)} bytes")
    array = np.frombuffer(data, "<f4", height * width, SHAPE.size)
    return Image(array.reshape(height, width), "dec")


def _unzipped(data: bytes) -> bytes:
    try:
        height, width = SHAPE.unpack_from(data)
        size = height * width * _FLOAT
        if size > limits().picture:
            raise DecodeError(f"a picture of {width} times {height}")
        return zlib.decompressobj().decompress(data[SHAPE.size :], size) if size else b""
    except (error, zlib.error) as problem:
        raise DecodeError(f"a .floatzip file that cannot be unpacked: {problem}") from None


def _coded(array: Any, code: str) -> Image:
    """Return the pixels of a file as those that were recorded."""
    found = Image(array)
    if not code or code == str(found.code):
        return found
    if code == "bgr" and array.ndim == 3:
        return Image(np.ascontiguousarray(array[:, :, ::-1]), "bgr")
    if code in BAYER and array.ndim == 2:
        return Image(array, code)
    try:
        return found.converted(pixel_of(code).code)
    except ValueError:
        return found
