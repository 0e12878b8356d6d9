"""The header of a PointCloud, which is no Bottle: is this one, and how long is the message?

    i32 width, i32 height, i32 kind, i8 dense, i32 266, i32 points

Rules: pure and cheap, for it is asked of messages of every kind. A width may be the code of a list,
so all of the header decides: the kind is a known one, 266 stands where it belongs, and the points
are as many as width and height say.
"""

from __future__ import annotations

from struct import Struct
from typing import Final

from yarpy.data.value import FLOAT64, LIST, Buffer

HEAD: Final = Struct("<iiibii")
#: in place of a list of the points
POINTS: Final = LIST + FLOAT64
#: code of a kind of points -> bytes of one of them
SIZES: Final = {
    1: 8,
    2: 16,
    10: 32,
    18: 32,
    16777318: 48,
    33554438: 32,
    33554528: 32,
    33554530: 48,
}
_PLACE: Final = 13  # of the 266
_WORD: Final = POINTS.to_bytes(4, "little")
_CODES: Final = tuple(code.to_bytes(4, "little") for code in SIZES)
_ENOUGH: Final = 16  # bytes: up to where all but the highest byte of the 266 is there

_i32 = Struct("<i").unpack_from


def cloud_size(view: Buffer) -> int:
    """Return how many bytes the PointCloud takes with which `view` begins; 0 if it is none, or its
    header is not all there.

    >>> cloud_size(HEAD.pack(3, 1, 2, 1, POINTS, 3))
    69
    """
    if len(view) < HEAD.size or _i32(view, _PLACE)[0] != POINTS:
        return 0
    width, height, code, dense, _, count = HEAD.unpack_from(view)
    size = SIZES.get(code, 0)
    if not size or dense not in (0, 1) or width < 0 or height < 0 or count != width * height:
        return 0
    return HEAD.size + size * int(count)


def may_be_cloud(view: Buffer) -> bool:
    """Return whether the beginning of a message, from 9 bytes on, can be that of such a header."""
    size = len(view)
    if size < 12:
        begun = bytes(view[8:])
        return any(code.startswith(begun) for code in _CODES)
    if _i32(view, 8)[0] not in SIZES or (size > 12 and view[12] not in (0, 1)):
        return False
    there = bytes(view[_PLACE : _PLACE + 4])
    return _WORD.startswith(there)


def is_likely_cloud(view: Buffer) -> bool:
    """Return whether an unfinished header is hardly anything else, though it might be a Bottle's
    beginning: nearly all of the 266 is there."""
    return len(view) >= _ENOUGH and may_be_cloud(view)
