"""Payload: a question or an answer as bytes; and the words that every service knows.

Rules: as text, a payload is the value of its bytes.
"""

from __future__ import annotations

from struct import Struct as Packing
from typing import Final

from yarpy.data.value import LIST, STRING, VOCAB32, Buffer
from yarpy.kits.thrift.kind import TEXT
from yarpy.kits.thrift.wire.cursor import Cursor
from yarpy.kits.thrift.wire.extent import Ending
from yarpy.kits.thrift.wire.reader import get

_MANY: Final = 0x796E616D

#: asks for the version of an interface, and of YARP (3.12 and later)
VERSION: Final = "getRemoteProtocolVersion"
#: asks why the last call failed (yarpy)
FAILURE: Final = "help_failure"


class Payload:
    """Bytes to send. `reply_end`, of a question, finds the end of a reply that is no Bottle."""

    __slots__ = ("data", "reply_end")

    def __init__(self, data: Buffer, reply_end: Ending | None = None) -> None:
        self.data = data
        self.reply_end = reply_end

    def to_wire(self) -> tuple[Buffer, ...]:
        """The bytes."""
        return (self.data,)


def many(lines: list[str]) -> bytes:
    """`[many]` and a list of strings, each with its tag, as C++ writes them."""
    pieces = [Packing("<iiiiii").pack(LIST, 2, VOCAB32, _MANY, LIST, len(lines))]
    for line in lines:
        data = line.encode("utf-8", "surrogateescape")
        pieces += (Packing("<ii").pack(STRING, len(data)), data)
    return b"".join(pieces)


def word_at(cursor: Cursor, what: str) -> str:
    """The word that a cursor stands at: a string or a vocab. DecodeError names `what` it is."""
    found: str = get(TEXT, cursor, what)
    return found
