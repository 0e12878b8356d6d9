"""Lines of a log, as programs of YARP hand them on: `foxglove.Log`.

Rules: pure. The levels are Foxglove's: TRACE is DEBUG there.
"""

from __future__ import annotations

from typing import Final

from yarpy.errors import YarpError
from yarpy.kits.record.envelope import SECOND
from yarpy.kits.record.form.form import Bytes, Spelled
from yarpy.kits.record.form.protobuf import encode, timestamp
from yarpy.kits.record.form.sensor import form_of
from yarpy.port.keep.log_line import read_message
from yarpy.wire.message import DATA, Message

LINE: Final = form_of("foxglove.Log")
LEVELS: Final = {"TRACE": 1, "DEBUG": 1, "INFO": 2, "WARNING": 3, "ERROR": 4, "FATAL": 5}
_BEGINNING: Final = (256 + 4).to_bytes(4, "little") + (2).to_bytes(4, "little")  # two strings
_HEADER: Final = (b"[/", b"[]")  # of a port that hands lines on
_AT: Final = 12  # where the first string begins


def line(payload: Bytes, sent: int, port: str) -> Spelled | None:
    """Return a line of a log; None for what is none."""
    if payload[:8] != _BEGINNING or payload[_AT : _AT + 2] not in _HEADER:
        return None
    message = Message(DATA, payload, "")
    message.source = port
    try:
        found = read_message(message)
    except YarpError:
        return None
    if found is None or not found.level:
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
    return Spelled(LINE, encode(LINE.schema, values), b"", payload)


def _text(value: object) -> str:
    return str(value) if isinstance(value, str) else ""


def _count(value: object) -> int:
    return value if type(value) is int and 0 <= value < 1 << 32 else 0
