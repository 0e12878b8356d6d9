"""The attachment of every message, question and answer of ROS 2: 33 bytes.

    int64 number | int64 nanoseconds since 1970 | 10 | 16 bytes that say who sent it (GID)

Rules: little-endian; numbers count from 1, and a gap is a message that was lost. Nodes of the first
versions of the RMW send something longer, which is refused.
"""

from __future__ import annotations

from struct import Struct
from typing import Final

from yarpy.errors import DecodeError

GID_SIZE: Final = 16
_LAYOUT: Final = Struct("<qqB16s")
SIZE: Final = _LAYOUT.size
#: what `attachment` and `parse_attachment` are made of, for what is done with each message
PACK: Final = _LAYOUT.pack
UNPACK: Final = _LAYOUT.unpack
GID_SIZE_AT: Final = 16


def attachment(number: int, time: int, gid: bytes) -> bytes:
    """Return the bytes of an attachment."""
    return _LAYOUT.pack(number, time, GID_SIZE, gid)


def parse_attachment(data: bytes) -> tuple[int, int, bytes]:
    """Return number, time in nanoseconds and GID from the bytes of an attachment. Raises
    DecodeError."""
    if len(data) != SIZE:
        why = (
            "the sender's rmw_zenoh is older than 0.1.2 (Humble), 0.2.4 (Jazzy) or 0.6.0 (Kilted): "
            "update it"
            if len(data) > SIZE
            else "it does not come from a node of ROS 2"
        )
        raise DecodeError(f"an attachment of {len(data)} bytes, where {SIZE} are expected: {why}")
    number, time, size, gid = _LAYOUT.unpack(data)
    if size != GID_SIZE:
        raise DecodeError(
            f"an attachment with a GID of {size} bytes, where {GID_SIZE} are expected"
        )
    return number, time, gid
