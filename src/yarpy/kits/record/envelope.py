"""Envelopes in a recording: kept as numbers where these give the same text again.

    STAMP   `7 1234.5`: a count and seconds, which a message of a file has fields for
    NONE    no envelope
    TEXT    any other: its length in four bytes and its text stand in front of the message

Rules: pure. What is played has the envelope that was recorded, to the letter.
"""

from __future__ import annotations

import re
from struct import Struct
from typing import Final, Literal, TypeAlias

from yarpy.data.stamp import Stamp
from yarpy.errors import DecodeError

Form: TypeAlias = Literal["stamp", "none", "text"]

SECOND: Final = 1_000_000_000  # nanoseconds
LENGTH: Final = Struct("<I")  # of the text in front of a message
# As `stamp_text` writes them: no zero more than it takes.
_STAMP: Final = re.compile(r"(0|[1-9]\d{0,9}) (0|[1-9]\d{0,10})(?:\.(\d{0,8}[1-9]))?", re.ASCII)
_LAST_COUNT: Final = (1 << 32) - 1
_LAST_TIME: Final = (1 << 64) - 1


def fields_of(envelope: str, received: int, number: int) -> tuple[Form, int, int]:
    """Return the form of an envelope, the sequence number and the time of sending, in nanoseconds.

    Where the envelope says nothing, these are `number` and `received`.
    """
    if not envelope:
        return "none", number & _LAST_COUNT, received
    match = _STAMP.fullmatch(envelope)
    if match is not None:
        count = int(match[1])
        sent = int(match[2] + (match[3] or "").ljust(9, "0"))
        if count <= _LAST_COUNT and sent <= _LAST_TIME:
            return "stamp", count, sent
    try:
        stamp = Stamp.from_text(envelope)
        sent = round(stamp.time * SECOND)
    except (DecodeError, ValueError, OverflowError):
        return "text", number & _LAST_COUNT, received
    if 0 <= sent <= _LAST_TIME and stamp.valid:
        return "text", stamp.count, sent
    return "text", number & _LAST_COUNT, received


def stamp_text(count: int, sent: int) -> str:
    """Return the envelope of that count and time, in nanoseconds.

    >>> stamp_text(7, 1234_500_000_000)
    '7 1234.5'
    """
    seconds, rest = divmod(sent, SECOND)
    return f"{count} {seconds}.{rest:09}".rstrip("0") if rest else f"{count} {seconds}"


def envelope_of(form: str, sequence: int, sent: int, data: memoryview) -> tuple[str, memoryview]:
    """Return the envelope of a message in a file, and its payload. DecodeError if the text in
    front of it is longer than the message."""
    if form == "stamp":
        return stamp_text(sequence, sent), data
    if form != "text":
        return "", data
    if len(data) < LENGTH.size:
        raise DecodeError("a message that ends within its envelope")
    start = LENGTH.size + LENGTH.unpack_from(data)[0]
    if start > len(data):
        raise DecodeError("an envelope that is longer than its message")
    return str(data[LENGTH.size : start], "utf-8", "replace"), data[start:]
