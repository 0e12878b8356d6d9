"""Numbers as other programs plot them: a Float64MultiArray of ROS 2, in CDR.

Rules: pure. A vector or matrix of float64 is there once, all others a second time as float64.
"""

from __future__ import annotations

from functools import lru_cache
from struct import Struct
from typing import Final

from yarpy.data.value import FLOAT64, LIST
from yarpy.kits.record.form.form import CDR_HEAD, Bytes, Converted, Form

_NAME: Final = "std_msgs/msg/Float64MultiArray"
_LINE: Final = "=" * 80
_DESCRIPTION: Final = f"""std_msgs/MultiArrayLayout layout
float64[] data
{_LINE}
MSG: std_msgs/MultiArrayLayout
std_msgs/MultiArrayDimension[] dim
uint32 data_offset
{_LINE}
MSG: std_msgs/MultiArrayDimension
string label
uint32 size
uint32 stride
""".encode()

NUMBERS: Final = Form("cdr", "cdr", _NAME, "ros2msg", _DESCRIPTION)
NUMBERS_BODY: Final = NUMBERS._replace(name="cdr body")
_VECTOR: Final = Struct("<ii")
_MATRIX: Final = 32  # bytes in front of its numbers
_DOUBLE: Final = 8


def _head(count: int) -> bytes:
    return CDR_HEAD.pack(0, 1, 0, 0, 0, count)


def vector(payload: Bytes) -> Converted | None:
    """Return a list of float64; None if it is empty, of other numbers, or something follows it."""
    if len(payload) < _VECTOR.size:
        return None
    tag, count = _VECTOR.unpack_from(payload)
    if tag != LIST + FLOAT64 or count <= 0 or len(payload) != _VECTOR.size + _DOUBLE * count:
        return None
    return _split(payload, _VECTOR.size, count)


def matrix(payload: Bytes) -> Converted | None:
    """Return the numbers of a matrix, row by row; None if there are none or something follows."""
    count, rest = divmod(len(payload) - _MATRIX, _DOUBLE)
    if rest or count <= 0 or _VECTOR.unpack_from(payload, 24) != (LIST + FLOAT64, count):
        return None
    return _split(payload, _MATRIX, count)


def _split(payload: Bytes, start: int, count: int) -> Converted:
    view = memoryview(payload)
    return Converted(NUMBERS_BODY, _head(count), view[start:], view[:start])


@lru_cache(64)
def _struct(count: int) -> Struct:
    return Struct(f"{CDR_HEAD.format}{count}d")


def numbers(values: tuple[float, ...], payload: Bytes) -> Converted:
    """Return a message of any numbers."""
    count = len(values)
    front = _struct(count).pack(0, 1, 0, 0, 0, count, *values)
    return Converted(NUMBERS, front, b"", payload)
