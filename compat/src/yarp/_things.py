"""Things: whatever a port carries, seen as what it may be; DummyConnector: a connection to itself.

Rules: what came is read as the first kind that is asked for; what is not of that kind is None.
"""

from __future__ import annotations

from typing import Any, TypeVar

import yarpy
from yarp._bottle import Bottle
from yarp._connection import ConnectionReader, ConnectionWriter
from yarp._image import FlexImage, Image, ImageMono, ImageRgb
from yarp._matrix import Matrix
from yarp._memory import encoded
from yarp._portable import PortReader, PortWriter
from yarp._property import Property
from yarp._value import Value
from yarp._vector import Vector

T = TypeVar("T")


class Things:
    """Holds a writer, a reader, or a message that has come."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Hold nothing."""
        self._writer: Any = None
        self._reader: Any = None
        self._connection: ConnectionReader | None = None
        self._came: Any = None

    def setPortWriter(self, writer: PortWriter) -> None:
        self._writer = writer

    def getPortWriter(self) -> Any:
        return self._writer

    def setPortReader(self, reader: PortReader) -> None:
        self._reader = reader

    def getPortReader(self) -> Any:
        return self._reader

    def setConnectionReader(self, reader: ConnectionReader) -> bool:
        """Hold what has come over a connection."""
        self.reset()
        self._connection = reader
        return True

    def hasBeenRead(self) -> bool:
        """Return whether what came was read."""
        return self._came is not None

    def write(self, connection: ConnectionWriter) -> bool:
        """Write what is held; False if that is nothing."""
        held = self._writer or self._came or self._reader
        if held is not None:
            return bool(held.write(connection))
        if self._connection is None:
            return False
        connection.appendBlock(bytes(self._connection._message.to_bytes()))
        return True

    def _as(self, kind: type[T]) -> T | None:
        held = self._writer if self._writer is not None else self._reader
        if held is None and self._came is None and self._connection is not None:
            made: Any = kind()
            if made.read(self._connection):
                self._came = made
        held = self._came if held is None else held
        return held if isinstance(held, kind) else None

    def asBottle(self) -> Bottle | None:
        return self._as(Bottle)

    def asProperty(self) -> Property | None:
        return self._as(Property)

    def asValue(self) -> Value | None:
        return self._as(Value)

    def asVector(self) -> Vector | None:
        return self._as(Vector)

    def asMatrix(self) -> Matrix | None:
        return self._as(Matrix)

    def asImage(self) -> Image | None:
        """Return a picture with whatever pixels it has."""
        if isinstance(self._writer or self._reader or self._came, Image):
            return self._as(Image)
        return self._as(FlexImage)

    def asImageOfPixelRgb(self) -> ImageRgb | None:
        return self._as(ImageRgb)

    def asImageOfPixelMono(self) -> ImageMono | None:
        return self._as(ImageMono)

    def asImageOfPixelBgr(self) -> FlexImage | None:
        """Return a picture that has the pixels BGR."""
        found = self._as(FlexImage)
        code = yarpy.Vocab("bgr").code
        return found if found is not None and found.getPixelCode() == code else None


class DummyConnector:
    """A pair of ends: the reader `getReader()` gets the values of the writer `getWriter()`."""

    def __init__(self) -> None:
        self._writer = ConnectionWriter()
        self._text = False

    def setTextMode(self, textmode: bool) -> None:
        """Hand over text instead of bytes."""
        self._text = textmode

    def getWriter(self) -> ConnectionWriter:
        """Return where one writes; more goes behind what is there."""
        return self._writer

    def getCleanWriter(self) -> ConnectionWriter:
        """Return where one writes, empty."""
        self.reset()
        return self._writer

    def getReader(self, parentConnectionReader: Any = None) -> ConnectionReader:
        """Return a reader of all that was written."""
        native = self._writer._outgoing()
        data = encoded(native)
        if self._text:
            line = yarpy.Bottle.from_bytes(data).to_text() + "\n"
            found = yarpy.Message("D", line.encode(), spelling="text")
        else:
            found = yarpy.Message("D", data)
        reader = ConnectionReader(found, self._writer._reference)
        reader.setParentConnectionReader(parentConnectionReader)
        return reader

    def reset(self) -> None:
        """Forget what was written."""
        self._writer = ConnectionWriter()
