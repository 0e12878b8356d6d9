"""TypedReader of each type: what a BufferedPort reads, and hands to callbacks.

Rules: what `read` returns is the caller's to keep.
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
from yarp._matrix import Matrix
from yarp._property import Property
from yarp._sound import Sound
from yarp._vector import Vector, VectorInt

T = TypeVar("T", bound=Any)


class TypedReader(Contactable, Generic[T]):
    """The reading part of a BufferedPort. `datum` is the class that is read."""

    datum: ClassVar[Any]

    def __init__(self) -> None:
        super().__init__()
        self._strict = False
        self._read: T | None = None
        self._replier: Any = None
        self._heard: Any = None  # who was called last,
        self._two = False  # and whether by two arguments

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


class TypedReaderBottle(TypedReader[Bottle]):
    datum = Bottle


class TypedReaderProperty(TypedReader[Property]):
    datum = Property


class TypedReaderVector(TypedReader[Vector]):
    datum = Vector


class TypedReaderVectorInt(TypedReader[VectorInt]):
    datum = VectorInt


class TypedReaderMatrix(TypedReader[Matrix]):
    datum = Matrix


class TypedReaderSound(TypedReader[Sound]):
    datum = Sound


class TypedReaderImageRgb(TypedReader[ImageRgb]):
    datum = ImageRgb


class TypedReaderImageRgba(TypedReader[ImageRgba]):
    datum = ImageRgba


class TypedReaderImageMono(TypedReader[ImageMono]):
    datum = ImageMono


class TypedReaderImageMono16(TypedReader[ImageMono16]):
    datum = ImageMono16


class TypedReaderImageInt(TypedReader[ImageInt]):
    datum = ImageInt


class TypedReaderImageFloat(TypedReader[ImageFloat]):
    datum = ImageFloat


class TypedReaderImageRgbFloat(TypedReader[ImageRgbFloat]):
    datum = ImageRgbFloat
