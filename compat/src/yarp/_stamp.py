"""Stamp: number and time of a message; it travels in the envelope."""

from __future__ import annotations

from typing import Any

import yarpy
from yarp._portable import Portable


class Stamp(Portable):
    """`Stamp(count, time)`, or an invalid one; `update` goes on to the next."""

    def __init__(self, count: int = -1, time: float = 0.0) -> None:
        self._stamp = yarpy.Stamp(count, float(time))

    def getCount(self) -> int:
        return self._stamp.count

    def getTime(self) -> float:
        return self._stamp.time

    def getMaxCount(self) -> int:
        return (1 << 31) - 1

    def isValid(self) -> bool:
        return self._stamp.valid

    def update(self, time: float | None = None) -> None:
        """The next number, at the time of now or the one given."""
        self._stamp = self._stamp.next(yarpy.clock.now() if time is None else float(time))

    def _outgoing(self) -> Any:
        return self._stamp

    def _take(self, message: yarpy.Message) -> None:
        self._stamp = message.as_(yarpy.Stamp)

    def _take_text(self, text: str) -> bool:
        """Fill this from an envelope; what is none leaves an invalid stamp."""
        try:
            self._stamp = yarpy.Stamp.from_text(text)
        except yarpy.DecodeError:
            self._stamp = yarpy.Stamp()
            return False
        return True
