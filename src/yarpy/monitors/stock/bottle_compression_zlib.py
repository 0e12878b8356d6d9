"""bottle_compression_zlib: compress any message with zlib at the sender's end.

On the wire: a Bottle of the uncompressed size in bytes (int32) and a blob, the zlib stream (RFC
1950) of the message's binary spelling. C++ YARP does the same with anything that can be read as a
Bottle; between two yarpy ends anything can be sent, even a Sound.

Rules: zlib releases the GIL. `get` returns the sums of both sizes.
"""

from __future__ import annotations

import logging
import zlib

from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError
from yarpy.limit import limits
from yarpy.log import logger
from yarpy.monitors.base import Place
from yarpy.monitors.stock.zlib_limit import unpacked
from yarpy.wire.message import Message

log = logger("yarpy.monitors")


class BottleCompressionZlib:
    """Compresses at the sender's end, decompresses at the receiver's.

    `debug_compression_info`: log the sizes of every message.
    """

    def __init__(self, place: Place) -> None:
        self._place = place
        self._level = logging.INFO if place.flag("debug_compression_info") else logging.DEBUG
        self._before = self._after = 0

    def update(self, message: Message) -> Message:
        if self._place.sending:
            plain = message.to_bytes()
            packed = zlib.compress(plain)
            self._count(len(plain), len(packed))
            return message.replaced([len(plain), packed])
        pair = message.as_(Bottle)
        if len(pair) != 2:
            raise DecodeError(f"expected a size and compressed data, got a list of {len(pair)}")
        made = unpacked(pair[1], pair[0], min(self._place.limit, limits().unpacked))
        self._count(len(made), len(pair[1]))
        return message.replaced(made, binary=True)

    def _count(self, before: int, after: int) -> None:
        self._before += before
        self._after += after
        log.log(self._level, "%s: %d bytes sent as %d", self._place, before, after)

    def parameters(self) -> dict[str, object]:
        return {"uncompressed": self._before, "compressed": self._after}
