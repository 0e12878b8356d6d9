"""A limit for zlib: data is unpacked to the announced size, and never to more.

Rules: memory is allocated for the actual output, not for the announced size, and never beyond the
limit. Anything wrong is a DecodeError.
"""

from __future__ import annotations

import zlib

from yarpy.errors import DecodeError


def unpacked(data: object, size: object, limit: int) -> bytes:
    """The `size` bytes that `data` unpacks to, at most `limit`. Raises DecodeError."""
    if not isinstance(data, bytes) or not isinstance(size, int):
        raise DecodeError(
            "this is not compressed data: is the same monitor attached at the sender's end?"
        )
    if not 0 <= size <= limit:
        raise DecodeError(f"compressed data announces {size} bytes, the limit is {limit}")
    stream = zlib.decompressobj()
    try:
        made = stream.decompress(data, size + 1)  # one more, because 0 would mean no limit
    except zlib.error as error:
        raise DecodeError(f"compressed data is damaged: {error}") from error
    if len(made) != size or not stream.eof:
        raise DecodeError(f"compressed data does not unpack to the {size} bytes it announces")
    return made
