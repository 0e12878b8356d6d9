"""The type of a message, by its first bytes: `yarp/image`, `yarp/vector` ...

Rules: pure, and cheap enough for each message; nothing behind the first 40 bytes is looked at. What
is of no type of its own is `yarp/bottle`.
"""

from __future__ import annotations

from struct import Struct
from typing import Final

from yarpy.data.value import FLOAT32, FLOAT64, INT32, LIST, VOCAB32

BOTTLE: Final = "yarp/bottle"
_IMAGE: Final = (LIST, 4, VOCAB32, int.from_bytes(b"mat\0", "little"))
_SOUND: Final = (LIST, 4, 0)
_FOUR: Final = Struct("<iiii")
_MATRIX: Final = Struct("<8i")
_CLOUD: Final = Struct("<iiibii")  # width, height, kind of points, dense, list of floats, count


def kind_of(payload: bytes | bytearray | memoryview) -> str:
    """Return the type of a message in its binary spelling."""
    if len(payload) < _FOUR.size:
        return "yarp/vector" if payload[:4] in _VECTORS else BOTTLE
    head = _FOUR.unpack_from(payload)
    if head[0] == LIST:
        if head == _IMAGE:
            return "yarp/image"
        if head[:3] == _SOUND:
            return "yarp/sound"
        return "yarp/matrix" if head[:3] == (LIST, 3, INT32) and _is_matrix(payload) else BOTTLE
    if payload[:4] in _VECTORS:
        return "yarp/vector"
    return "yarp/pointcloud" if _is_cloud(payload) else BOTTLE


_VECTORS: Final = [(LIST + tag).to_bytes(4, "little") for tag in (FLOAT64, FLOAT32)]


def _is_matrix(payload: bytes | bytearray | memoryview) -> bool:
    """Return whether it is a list of rows, columns and as many numbers."""
    if len(payload) < _MATRIX.size:
        return False
    _, _, _, rows, tag, columns, numbers, count = _MATRIX.unpack_from(payload)
    return (tag, numbers, count) == (INT32, LIST + FLOAT64, rows * columns)


def _is_cloud(payload: bytes | bytearray | memoryview) -> bool:
    """Return whether it begins with the header of a point cloud."""
    if len(payload) < _CLOUD.size:
        return False
    width, height, _, _, numbers, count = _CLOUD.unpack_from(payload)
    return bool(numbers == LIST + FLOAT64 and count == width * height and width > 0)
