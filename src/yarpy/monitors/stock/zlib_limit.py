"""A limit for zlib: data are unpacked to the announced size, and never to more.

Rules: memory is taken for what comes out, not for what is announced, and never for more than the
limit. Whatever is wrong is a DecodeError.
"""

from __future__ import annotations

import zlib

from yarpy.errors import DecodeError


def unpacked(data: object, size: object, limit: int) -> bytes:
    """The `size` bytes that `data` were compressed from, at most `limit`. Raises DecodeError."""
    if not isinstance(data, bytes) or not isinstance(size, int):
        raise DecodeError(
            "this is not compressed data: does the same monitor ride on the sender's end?"
        )
    if not 0 <= size <= limit:
        raise DecodeError(f"compressed data announce {size} bytes, the limit is {limit}")
    stream = zlib.decompressobj()
    try:
        made = stream.decompress(data, size + 1)  # one more: 0 would mean without limit
    except zlib.error as error:
        raise DecodeError(f"compressed data are damaged: {error}") from error
    if len(made) != size or not stream.eof:
        raise DecodeError(f"compressed data do not make the {size} bytes that they announce")
    return made
