"""BufferedPort of each type: reads the newest message, writes what `prepare` gave.

Rules: what `prepare` returns keeps what was in it, as in C++, and may be changed again as soon as
`write` returns. What `read` returns is the caller's to keep.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any, ClassVar, Generic, TypeVar

import yarpy
from yarp._bottle import Bottle
from yarp._contactable import Contactable
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
from yarp._vector import Vector, VectorInt

T = TypeVar("T", bound=Any)


class BufferedPort(Contactable, Generic[T]):
    """The common part. `datum` is the class that is read and written."""

    datum: ClassVar[Any]

    def __init__(self, port: Any = None) -> None:
        super().__init__()
        self._strict = False
        self._prepared: T | None = None
        self._read: T | None = None
        self._replier: Any = None
        self._heard: Any = None  # who was called last,
        self._two = False  # and whether by two arguments

    def _make(self, name: str, tcp_port: int) -> Any:
        port = yarpy.BufferedPort(
            name, tcp_port=tcp_port, names=self._names(), on_connection=self._event
        )
        if self._strict:
            port.read_strictly()
        return port

    def read(self, shouldWait: bool = True) -> T | None:
        """The newest message, or None: there is none, or the port was interrupted."""
        port = self._port
        if port is None or self._pump is not None:
            return None
        while True:
            try:
                message = port.read() if shouldWait else port.poll()
            except yarpy.PortClosed:
                return None
            if message is None:
                return None
            try:
                found: T = self.datum._from(message)
            except yarpy.DecodeError:  # something else, which is not for this port
                continue
            self._last, self._read = message, found
            return found

    def lastRead(self) -> T | None:
        """Return what `read` returned last."""
        return self._read

    def getPendingReads(self) -> int:
        """Messages that came and were not read."""
        return 0 if self._port is None else self._port.waiting

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

    def setStrict(self, strict: bool = True) -> None:
        """Read every message, in order."""
        self._strict = strict
        if self._port is not None:
            self._port.read_strictly(strict)

    def isClosed(self) -> bool:
        return self._port is None

    def setTargetPeriod(self, period: float) -> None:
        """Callbacks come with the messages."""

    # -- callbacks ----------------------------------------------------------------------------

    def useCallback(self, callback: Any = None) -> None:
        """Call `callback.onRead(datum)` with each message; without one, `onRead` of this port."""
        self._stop()
        self._reader = self if callback is None else callback
        self._start()

    def disableCallback(self) -> None:
        """Read by `read` again."""
        self._stop()

    def onRead(self, datum: T, reader: Any = None) -> None:
        """Called with each message, in subclasses that say `useCallback()`."""

    def setReplier(self, reader: Any) -> None:
        """Let a reader answer questions; other messages are read as before."""
        self._replier = reader
        self.setReader(reader)

    def _hand(self, reader: Any, message: yarpy.Message) -> None:
        if not hasattr(reader, "onRead") or reader is self._replier:
            super()._hand(reader, message)
            return
        try:
            found = self.datum._from(message)
        except yarpy.DecodeError:
            return
        self._read = found
        if self._heard is not reader:
            self._heard, self._two = reader, _takes_two(reader.onRead)
        if self._two:
            reader.onRead(found, self)
        else:
            reader.onRead(found)

    def acquire(self) -> T | None:
        """Return what was read last, to keep it."""
        found, self._read = self._read, None
        return found

    def release(self, handle: Any) -> None:
        """Done with what `acquire` returned."""


def _takes_two(method: Callable[..., object]) -> bool:
    try:
        inspect.signature(method).bind(None, None)
    except TypeError:
        return False
    return True


class BufferedPortBottle(BufferedPort[Bottle]):
    datum = Bottle


class BufferedPortProperty(BufferedPort[Property]):
    datum = Property


class BufferedPortVector(BufferedPort[Vector]):
    datum = Vector


class BufferedPortVectorInt(BufferedPort[VectorInt]):
    datum = VectorInt


class BufferedPortMatrix(BufferedPort[Matrix]):
    datum = Matrix


class BufferedPortSound(BufferedPort[Sound]):
    datum = Sound


class BufferedPortImageRgb(BufferedPort[ImageRgb]):
    datum = ImageRgb


class BufferedPortImageRgba(BufferedPort[ImageRgba]):
    datum = ImageRgba


class BufferedPortImageMono(BufferedPort[ImageMono]):
    datum = ImageMono


class BufferedPortImageMono16(BufferedPort[ImageMono16]):
    datum = ImageMono16


class BufferedPortImageInt(BufferedPort[ImageInt]):
    datum = ImageInt


class BufferedPortImageFloat(BufferedPort[ImageFloat]):
    datum = ImageFloat


class BufferedPortImageRgbFloat(BufferedPort[ImageRgbFloat]):
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
