"""BufferedPort of each type: reads the newest message, writes what `prepare` gave.

Rules: what `prepare` returns keeps what was in it, as in C++, and may be changed again as soon as
`write` returns. What `read` returns is the caller's to keep.
"""

from __future__ import annotations

from typing import Any, Generic, TypeVar

import yarpy
from yarp._bottle import Bottle
from yarp._image import (
    ImageFloat,
    ImageInt,
    ImageMono,
    ImageMono16,
    ImageRgb,
    ImageRgba,
    ImageRgbFloat,
)
from yarp._log import say
from yarp._matrix import Matrix
from yarp._property import Property
from yarp._sound import Sound
from yarp._typed_reader import (
    TypedReader,
    TypedReaderBottle,
    TypedReaderImageFloat,
    TypedReaderImageInt,
    TypedReaderImageMono,
    TypedReaderImageMono16,
    TypedReaderImageRgb,
    TypedReaderImageRgba,
    TypedReaderImageRgbFloat,
    TypedReaderMatrix,
    TypedReaderProperty,
    TypedReaderSound,
    TypedReaderVector,
    TypedReaderVectorInt,
)
from yarp._vector import Vector, VectorInt

T = TypeVar("T", bound=Any)


class BufferedPort(TypedReader[T], Generic[T]):
    """The common part. `datum` is the class that is read and written."""

    def __init__(self, port: Any = None) -> None:
        super().__init__()
        self._prepared: T | None = None

    def _make(self, name: str, tcp_port: int) -> Any:
        port = yarpy.BufferedPort(
            name, tcp_port=tcp_port, names=self._names(), on_connection=self._event
        )
        if self._strict:
            port.read_strictly()
        return port

    def prepare(self) -> T:
        """Return what the next `write` sends, to be filled."""
        if self._prepared is None:
            made: T = self.datum()
            self._prepared = made
            return made
        return self._prepared

    def unprepare(self) -> bool:
        """Do not send what was prepared."""
        found, self._prepared = self._prepared, None
        return found is not None

    def write(self, forceStrict: bool = False) -> None:
        """Send what was prepared; a reader that is still busy with the one before misses it, unless
        `forceStrict`."""
        port = self._port
        if port is None:
            return
        port.strict = forceStrict
        try:
            port.write(self._leaving(self.prepare()), self._envelope)
        except yarpy.PortClosed:
            pass
        except (ValueError, OverflowError) as error:  # too deep, too large
            say("ERROR", f"|yarp.os.BufferedPort| {self._name}: {error}")

    def writeStrict(self) -> None:
        """Send what was prepared; nobody misses it."""
        self.write(True)

    def waitForWrite(self) -> None:
        """Wait until everything has left."""
        if self._port is not None:
            self._port.flush(10.0)


class BufferedPortBottle(BufferedPort[Bottle], TypedReaderBottle):
    datum = Bottle


class BufferedPortProperty(BufferedPort[Property], TypedReaderProperty):
    datum = Property


class BufferedPortVector(BufferedPort[Vector], TypedReaderVector):
    datum = Vector


class BufferedPortVectorInt(BufferedPort[VectorInt], TypedReaderVectorInt):
    datum = VectorInt


class BufferedPortMatrix(BufferedPort[Matrix], TypedReaderMatrix):
    datum = Matrix


class BufferedPortSound(BufferedPort[Sound], TypedReaderSound):
    datum = Sound


class BufferedPortImageRgb(BufferedPort[ImageRgb], TypedReaderImageRgb):
    datum = ImageRgb


class BufferedPortImageRgba(BufferedPort[ImageRgba], TypedReaderImageRgba):
    datum = ImageRgba


class BufferedPortImageMono(BufferedPort[ImageMono], TypedReaderImageMono):
    datum = ImageMono


class BufferedPortImageMono16(BufferedPort[ImageMono16], TypedReaderImageMono16):
    datum = ImageMono16


class BufferedPortImageInt(BufferedPort[ImageInt], TypedReaderImageInt):
    datum = ImageInt


class BufferedPortImageFloat(BufferedPort[ImageFloat], TypedReaderImageFloat):
    datum = ImageFloat


class BufferedPortImageRgbFloat(BufferedPort[ImageRgbFloat], TypedReaderImageRgbFloat):
    datum = ImageRgbFloat


class Callback:
    """The argument of `useCallback`: subclasses define `onRead`."""

    def onRead(self, datum: Any, reader: Any = None) -> None:
        """Called with each message."""


class BottleCallback(Callback):
    """Of a BufferedPortBottle."""


class PropertyCallback(Callback):
    """Of a BufferedPortProperty."""


class VectorCallback(Callback):
    """Of a BufferedPortVector."""


class VectorIntCallback(Callback):
    """Of a BufferedPortVectorInt."""


class MatrixCallback(Callback):
    """Of a BufferedPortMatrix."""


class SoundCallback(Callback):
    """Of a BufferedPortSound."""


class ImageRgbCallback(Callback):
    """Of a BufferedPortImageRgb."""


class ImageRgbaCallback(Callback):
    """Of a BufferedPortImageRgba."""


class ImageMonoCallback(Callback):
    """Of a BufferedPortImageMono."""


class ImageMono16Callback(Callback):
    """Of a BufferedPortImageMono16."""


class ImageIntCallback(Callback):
    """Of a BufferedPortImageInt."""


class ImageFloatCallback(Callback):
    """Of a BufferedPortImageFloat."""


class ImageRgbFloatCallback(Callback):
    """Of a BufferedPortImageRgbFloat."""


# The names of YARP before 3.12.1.
TypedReaderCallbackVector = VectorCallback
TypedReaderCallbackVectorInt = VectorIntCallback
TypedReaderCallbackSound = SoundCallback
TypedReaderCallbackImageRgb = ImageRgbCallback
TypedReaderCallbackImageRgba = ImageRgbaCallback
TypedReaderCallbackImageMono = ImageMonoCallback
TypedReaderCallbackImageMono16 = ImageMono16Callback
TypedReaderCallbackImageInt = ImageIntCallback
TypedReaderCallbackImageFloat = ImageFloatCallback
TypedReaderCallbackImageRgbFloat = ImageRgbFloatCallback
