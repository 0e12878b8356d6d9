"""Stamp: the number and the time of a message, as they travel in its envelope.

Rules: two spellings, the text `count time` with 15 significant digits (for times of today that is
about 10 microseconds) and a Bottle of int32 and float64. The clock is the caller's.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from struct import Struct, error
from typing import Self

from yarpy.errors import DecodeError, Truncated

_WIRE = Struct("<iiiiid")
_TEXT = re.compile(
    r"\s*+([+-]?\d{1,10}+)\s++([+-]?(?:inf|nan|(?:\d++(?:\.\d*+)?|\.\d++)(?:e[+-]?\d++)?))",
    re.ASCII | re.I,
)
_MAX_COUNT = 0x7FFFFFFF


@dataclass(frozen=True, slots=True)
class Stamp:
    """Sequence number and time in seconds. `Stamp()` is the invalid one: count -1, time 0."""

    count: int = -1
    time: float = 0.0

    @property
    def valid(self) -> bool:
        return self.count >= 0

    def next(self, time: float) -> Stamp:
        """The stamp of the following message; the count starts again at 0 after 2147483647."""
        return Stamp(self.count + 1 if -1 <= self.count < _MAX_COUNT else 0, time)

    def to_text(self) -> str:
        """The spelling of envelopes: `7 1234.5`. OverflowError for a count that no reader takes."""
        if not -_MAX_COUNT - 1 <= self.count <= _MAX_COUNT:
            raise OverflowError(_beyond(self.count))
        return f"{self.count} {self.time:.15g}"

    @classmethod
    def from_text(cls, text: str | bytes) -> Self:
        """Read `count time`; what follows (the frame of a Header) is skipped."""
        line = text.decode("utf-8", "replace") if isinstance(text, bytes) else text
        match = _TEXT.match(line)
        if match is None or not -_MAX_COUNT <= int(match[1]) + 1 <= _MAX_COUNT + 1:
            raise DecodeError(f"not a stamp: {line[:60]!r} (a stamp is a count and a time: 7 12.5)")
        return cls(int(match[1]), float(match[2]))

    parse = from_text

    def to_bytes(self) -> bytes:
        """28 bytes: the Bottle of an int32 and a float64."""
        try:
            return _WIRE.pack(256, 2, 1, self.count, 10, self.time)
        except error:
            raise OverflowError(_beyond(self.count)) from None

    @classmethod
    def from_bytes(cls, data: bytes | bytearray | memoryview) -> Self:
        """Read the 28 bytes, or the longer form with a frame name behind them."""
        if len(data) < _WIRE.size:
            raise Truncated(f"a stamp takes {_WIRE.size} bytes, here are {len(data)}", _WIRE.size)
        code, length, int_tag, count, float_tag, time = _WIRE.unpack_from(data)
        if (code, int_tag, float_tag) != (256, 1, 10) or length not in (2, 3):
            raise DecodeError("not a stamp: a stamp is a list of an int32 and a float64")
        return cls(count, time)

    def to_wire(self) -> tuple[bytes]:
        return (self.to_bytes(),)

    from_wire = from_bytes


def _beyond(count: int) -> str:
    return f"a stamp cannot count to {count}: 32 bits; begin again at 0, as Stamp.next does"
