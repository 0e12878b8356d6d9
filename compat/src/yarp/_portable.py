"""Portable: what ports write and read; ConnectionReader and ConnectionWriter hand it over.

Rules: a subclass says what it sends in `_outgoing`, an object that yarpy ports take, and fills
itself in `_take`; that may raise DecodeError, which means that something else came.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any, ClassVar, Self

import yarpy
from yarp._type import Type

if TYPE_CHECKING:
    from yarp._connection import ConnectionReader, ConnectionWriter


class PortWriter:
    """An object that can be written."""

    def _outgoing(self) -> Any:
        """Return what is sent: for subclasses written by users, what their `write` appends."""
        from yarp._connection import ConnectionWriter

        writer = ConnectionWriter()
        self.write(writer)
        return writer._outgoing()

    def write(self, writer: ConnectionWriter) -> bool:
        """Write to a connection."""
        writer._put(self)
        return True

    def getWriteType(self) -> Type:
        """Return the type of what is written."""
        return Type.anon()

    def onCommencement(self) -> None:
        """Called before a message leaves in the background."""

    def onCompletion(self) -> None:
        """Called when it has left."""


class PortReader:
    """An object that can be read. Subclasses define `read`."""

    def _take(self, message: yarpy.Message) -> None:
        from yarp._connection import ConnectionReader

        self.read(ConnectionReader(message))

    def _take_text(self, text: str) -> bool:
        """Fill this from an envelope; whether that is one."""
        from yarp._memory import encoded

        try:
            self._take(yarpy.Message("D", encoded(yarpy.Bottle.from_text(text))))
        except yarpy.DecodeError:
            return False
        return True

    @classmethod
    def _from(cls, message: yarpy.Message) -> Self:
        """A new one, filled by a message."""
        self = cls()
        self._take(message)
        return self

    def read(self, reader: ConnectionReader) -> bool:
        """Read from a connection."""
        return reader._fill(self)

    def getReadType(self) -> Type:
        """Return the type of what is read."""
        return Type.anon()


class Portable(PortReader, PortWriter):
    """An object that can be written and read."""

    #: how C++ calls its type; "" for those that have no name
    _type: ClassVar[str] = ""

    def getType(self) -> Type:
        """Return the type of the object."""
        return Type.byName(self._type) if self._type else Type.anon()

    def getReadType(self) -> Type:
        return self.getType()

    def getWriteType(self) -> Type:
        return self.getType()

    @staticmethod
    def copyPortable(writer: PortWriter, reader: PortReader) -> bool:
        """Fill `reader` with what `writer` writes."""
        try:
            reader._take(message_of(writer))
        except (yarpy.DecodeError, struct.error):
            return False
        return True


def message_of(writer: PortWriter) -> yarpy.Message:
    """A message that holds what `writer` writes, with memory of its own."""
    from yarp._memory import encoded

    return yarpy.Message("D", encoded(writer._outgoing()))


class PortReaderCreator:
    """Makes a reader (`Port.setReaderCreator`): subclasses define `create`."""

    def create(self) -> PortReader:
        """Return a reader."""
        raise NotImplementedError(f"{type(self).__name__} has to define create")
