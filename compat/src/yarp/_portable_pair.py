"""PortablePair and its base: two objects in one message, as a list of two.

Rules: objects that are lists of Bottles themselves, such as Bottles, vectors and images, keep their
form; others are refused.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any

import yarpy
from yarp._memory import encoded
from yarp._portable import Portable, PortReader, PortWriter

if TYPE_CHECKING:
    from yarp._connection import ConnectionReader, ConnectionWriter


class PortablePairBase(Portable):
    """`writePair(connection, head, body)` in a `write`, `readPair` in a `read`."""

    @staticmethod
    def writePair(connection: Any, head: PortWriter, body: PortWriter) -> bool:
        """Write two objects; False, if one of them cannot be in a list."""
        parts = [bytes(encoded(each._outgoing())) for each in (head, body)]
        try:
            for each in parts:
                yarpy.Bottle.from_bytes(each)
        except yarpy.DecodeError:
            return False
        connection.appendBlock(struct.pack("<2i", _LIST, len(parts)) + b"".join(parts))
        return True

    @staticmethod
    def readPair(connection: Any, head: PortReader, body: PortReader) -> bool:
        """Read two objects; False, if something else came."""
        try:
            found = connection._message.as_(yarpy.Bottle)
            if len(found) != 2:
                return False
            for reader, value in zip((head, body), found, strict=True):
                if not isinstance(value, list | tuple):
                    return False
                reader._take(yarpy.Message("D", encoded(yarpy.Bottle(value))))
        except (yarpy.DecodeError, struct.error):
            return False
        return True


class PortablePair(PortablePairBase):
    """Two objects, `head` and `body`; Bottles, if nothing else is given."""

    def __init__(self, head: Portable | None = None, body: Portable | None = None) -> None:
        from yarp._bottle import Bottle

        self.head: Any = Bottle() if head is None else head
        self.body: Any = Bottle() if body is None else body

    def write(self, writer: ConnectionWriter) -> bool:
        """Write both."""
        return PortablePairBase.writePair(writer, self.head, self.body)

    def read(self, reader: ConnectionReader) -> bool:
        """Read both."""
        return PortablePairBase.readPair(reader, self.head, self.body)


_LIST = 256
