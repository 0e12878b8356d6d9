"""depthimage_compression_zlib: compress depth images (pixels `dec`) with zlib when sending.

On the wire, as from C++ YARP: a Bottle of width, height, compressed size, uncompressed size (int32)
and a blob, the zlib stream (RFC 1950) of the rows.

Rules: rows are sent padded to 8 bytes, as C++ sends them. C++ receivers refuse padded rows, which
images of an odd width have; this one accepts both.
"""

from __future__ import annotations

import zlib
from typing import TYPE_CHECKING

from yarpy.data.bottle import Bottle
from yarpy.data.sig.image import QUANTUM, Image
from yarpy.errors import DecodeError
from yarpy.limit import limits
from yarpy.monitors.base import Place
from yarpy.monitors.imaging.picture import picture
from yarpy.monitors.stock.zlib_limit import unpacked
from yarpy.wire.message import Message

if TYPE_CHECKING:
    from numpy.typing import NDArray

_PIXEL = 4  # bytes


class DepthZlib:
    """Compresses at the sender's end, decompresses at the receiver's."""

    def __init__(self, place: Place) -> None:
        self._sending = place.sending
        self._limit = place.limit

    def update(self, message: Message) -> Message:
        return message.replaced(self._packed(message) if self._sending else self._image(message))

    def _packed(self, message: Message) -> list[object]:
        image = picture(message, "dec")
        if not image.top_down or image.quantum != QUANTUM:
            image = Image(image.array, "dec")
        rows = b"".join(image.to_wire()[1:])
        packed = zlib.compress(rows)
        return [image.width, image.height, len(packed), len(rows), packed]

    def _image(self, message: Message) -> Image:
        import numpy as np

        match message.as_(Bottle):
            case [int(width), int(height), int(), int(size), bytes(data)]:
                row = -(-width * _PIXEL // QUANTUM) * QUANTUM
                if width < 0 or height < 0 or size not in (width * height * _PIXEL, row * height):
                    raise DecodeError(f"{width} x {height} pixels do not take {size} bytes")
                made = unpacked(data, size, min(self._limit, limits().picture))
                rows: NDArray[np.float32] = np.frombuffer(made, "<f4")
                return Image(rows.reshape(height, -1 if size else width)[:, :width], "dec")
        raise DecodeError("this is not a compressed depth image: does the sender compress them?")
