"""Lines of a log, as programs of YARP hand them on: `foxglove.Log`.

Rules: pure. The levels are Foxglove's: TRACE is DEBUG there.
"""

from __future__ import annotations

from typing import Final

from yarpy.errors import YarpError
from yarpy.kits.record.envelope import SECOND
from yarpy.kits.record.form.form import Bytes, Converted
from yarpy.kits.record.form.protobuf import encode, timestamp
from yarpy.kits.record.form.sensor import form_of
from yarpy.port.keep.log_line import LogLine, read_message
from yarpy.wire.message import DATA, Message

LINE: Final = form_of("foxglove.Log")
LEVELS: Final = {"TRACE": 1, "DEBUG": 1, "INFO": 2, "WARNING": 3, "ERROR": 4, "FATAL": 5}
_BEGINNING: Final = (256 + 4).to_bytes(4, "little") + (2).to_bytes(4, "little")  # two strings
_HEADER: Final = (b"[/", b"[]")  # of a port that hands lines on
_AT: Final = 12  # where the first string begins


def read_line(payload: Bytes, port: str) -> LogLine | None:
    """Return what a message of that port says to a log; None for what is no line of one."""
    if payload[:8] != _BEGINNING or payload[_AT : _AT + 2] not in _HEADER:
        return None
    message = Message(DATA, payload, "")
    message.source = port
    try:
        found = read_message(message)
    except YarpError:
        return None
    return found if found is not None and found.level else None


def line(payload: Bytes, sent: int, port: str) -> Converted | None:
    """Return a line of a log; None for what is none."""
    found = read_line(payload, port)
    if found is None:
        return None
    more = found.more
    values = {
        "timestamp": timestamp(round(found.time * SECOND) or sent),
        "level": LEVELS[found.level],
        "message": found.text,
        "name": found.component or found.origin,
        "file": _text(more.get("filename")),
        "line": _count(more.get("line")),
    }
    return Converted(LINE, encode(LINE.schema, values), b"", payload)


def _text(value: object) -> str:
    return str(value) if isinstance(value, str) else ""


def _count(value: object) -> int:
    return value if type(value) is int and 0 <= value < 1 << 32 else 0
