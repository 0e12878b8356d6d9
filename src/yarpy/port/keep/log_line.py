"""The messages in which programs hand on their log, as C++ YARP spells them.

    "[/log/HOST/PROGRAM/PID]" "(level INFO) (systemtime 1795219554.10) (component C) (message TEXT)"

Rules: a Bottle of two strings, the second of which is a Property as text; what yarprun reads from
programs that know nothing of this is plain text there. What comes was written by a stranger: it is
read with limits, and nothing of it raises.
"""

from __future__ import annotations

import os
import re
import socket
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from struct import Struct
from typing import TYPE_CHECKING, Any, Final

from yarpy.config.configuration import flag
from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text, print_text
from yarpy.data.value import LIST, STRING
from yarpy.errors import DecodeError

if TYPE_CHECKING:
    from logging import LogRecord

    from yarpy.wire.message import Message

LEVELS: Final = ("TRACE", "DEBUG", "INFO", "WARNING", "ERROR", "FATAL")
LONGEST: Final = 16_384  # characters of a message that is sent, or of a line that is read
LATEST: Final = float(1 << 34)  # seconds since 1970: recordings count nanoseconds in 64 bits

_UNFIT: Final = re.compile(r"[^\w.+\-]")
# What most lines look like, so that reading them takes little; others are read as what they are.
_USUAL: Final = re.compile(
    r"\(level (TRACE|DEBUG|INFO|WARNING|ERROR|FATAL)\) \(systemtime (\d{1,12}\.\d+)\)"
    r"(?: \(networktime (\d{1,12}\.\d+)\))?"
    r"(?: \(component ([A-Za-z_][\w.]*)\))?(?: \(id ([A-Za-z_][\w.]*)\))?"
    r' \(message (?:"([^"\\]*)"|([A-Za-z_]\w*))\)'
)
_TWO: Final = (LIST + STRING, 2)  # a list of two strings begins so,
_HEAD: Final = Struct("<3i")  # and with the length of the first one
_COUNT: Final = Struct("<i")
_LEVEL: Final = re.compile(r"\[(TRACE|DEBUG|INFO|WARNING|ERROR|FATAL)\]\s?(.*)", re.S)


@dataclass(slots=True)  # a frozen one takes twice as long to make, and there are many
class LogLine:
    """A line of a log. `origin`: the port; `time` in seconds since 1970, 0.0 if it is not told;
    `level` one of LEVELS, or ""; `more`: everything else that was told."""

    origin: str
    level: str
    text: str
    time: float = 0.0
    component: str = ""
    more: dict[str, Any] = field(default_factory=dict)


def port_name(environment: Mapping[str, str]) -> str:
    """The name of the port that this process forwards its log by: `/log/HOST/PROGRAM/PID`."""
    program = os.path.basename(sys.argv[0] if sys.argv else "")
    if program in ("", "-c", "-m"):
        program = os.path.basename(sys.executable) or "python"
    label = environment.get("YARP_LOG_PROCESS_LABEL", "")
    words = _UNFIT.sub("_", socket.gethostname()), _UNFIT.sub("_", program)
    shown = f"[{_UNFIT.sub('_', label)}]" if label else ""
    return f"/log/{words[0]}/{words[1]}{shown}/{os.getpid()}"


def message_of(record: LogRecord, port: str, environment: Mapping[str, str]) -> Bottle:
    """A record of Python's logging. YARP_FORWARD_CODEINFO_ENABLE, YARP_FORWARD_HOSTNAME_ENABLE and
    YARP_FORWARD_PROCESSINFO_ENABLE have it tell more, as in C++."""
    told: list[tuple[str, Any]] = []
    if flag(environment, "YARP_FORWARD_CODEINFO_ENABLE", False):
        told += ("filename", record.pathname), ("line", record.lineno)
        told.append(("function", record.funcName or ""))
    if flag(environment, "YARP_FORWARD_HOSTNAME_ENABLE", False):
        told.append(("hostname", socket.gethostname()))
    if flag(environment, "YARP_FORWARD_PROCESSINFO_ENABLE", False):
        told += ("pid", os.getpid()), ("cmd", sys.orig_argv[0] if sys.orig_argv else "")
        told.append(("args", " ".join(sys.orig_argv[1:])[:LONGEST]))
        told.append(("thread_id", f"0x{(record.thread or 0) & 0xFFFFFFFF:08x}"))
    if record.name not in ("root", "yarp", None):  # yarp: what compat prints has no component
        told.append(("component", record.name))
    try:
        text = record.getMessage()
    except Exception as error:  # as logging itself: a wrong format is no end of a program
        text = f"{record.msg} ({error})"
    if text:
        told.append(("message", text[:LONGEST]))
    if record.exc_info and record.exc_info[0] is not None:
        import traceback

        trace = "".join(traceback.format_exception(*record.exc_info))[-LONGEST:]
        told.append(("backtrace", trace))
    # Written by hand: a Bottle of Bottles takes three times as long, and there are many lines.
    start = f"(level {level_of(record.levelno)}) (systemtime {print_text((record.created,))})"
    return Bottle([f"[{port}]", start + "".join([_pair_text(*each) for each in told])])


def _pair_text(key: str, value: Any) -> str:
    return f" ({key} {print_text((value,))})"


def level_of(number: int) -> str:
    """The level of YARP for one of Python's logging."""
    return LEVELS[max(0, min(number // 10, 5))]


def read_message(message: Message) -> LogLine | None:
    """Return the line of a log that a message is; None if it is none. Raises DecodeError."""
    if message.spelling == "binary":
        pair = _pair(message.payload)
        if pair is not None:
            return _line(*pair, message.source)
    return read_line(message.natural(), message.source)


def _pair(payload: Any) -> tuple[str, str] | None:
    """Return the two strings of a message, None if it is another one, or a longer one."""
    size = len(payload)
    if not 16 <= size <= 2 * LONGEST:
        return None
    data = bytes(payload)
    code, count, first = _HEAD.unpack_from(data)
    if (code, count) != _TWO or not 0 <= first <= size - 16:
        return None
    first += 12
    second = first + 4
    if second + _COUNT.unpack_from(data, first)[0] != size:
        return None
    try:
        return data[12:first].decode(), data[second:].decode()
    except UnicodeDecodeError:
        return None


def read_line(value: object, source: str = "") -> LogLine | None:
    """Return the line of a log that a message is; None if it is none. `source`: the port that it
    came from."""
    if not isinstance(value, list) or len(value) != 2:
        return None
    if not all(isinstance(each, str) for each in value):
        return None
    header, text = (plain_text(each)[:LONGEST] for each in value)
    return _line(header, text, source)


def _line(header: str, text: str, source: str) -> LogLine:
    origin = (_known_origin if len(header) <= _SHORT else _origin)(header, source)
    usual = _USUAL.fullmatch(text) if len(text) <= LONGEST else None
    if usual is not None:
        level, moment, network, component, id_, quoted, word = usual.groups()
        more: dict[str, Any] = {}
        if network is not None:
            more["networktime"] = float(network)
        if id_ is not None:
            more["id"] = id_
        said = word if quoted is None else quoted
        seconds = float(moment)
        return LogLine(
            origin, level, said, seconds if seconds < LATEST else 0.0, component or "", more
        )
    text = text[:LONGEST].rstrip("\0")
    found = _fields(text) if text.startswith("(") else {}
    if "level" not in found:
        match = _LEVEL.match(text)
        level, said = (match[1], match[2]) if match else ("", text)
        return LogLine(origin, level, said.rstrip("\r\n"))
    level, said, component = (
        plain_text(found.pop(key, "")) for key in ("level", "message", "component")
    )
    time = found.pop("systemtime", 0.0)
    return LogLine(
        origin,
        level if level in LEVELS else "",
        said,
        _time(time) if isinstance(time, int | float) else 0.0,
        component,
        found,
    )


def _origin(header: str, source: str) -> str:
    """The port that a header tells, else the one that the message came from."""
    header = header[:LONGEST].rstrip("\0")
    return header[1:-1] if header.startswith("[") and header.endswith("]") else source


_SHORT: Final = 256  # characters of a header that is remembered
_known_origin = lru_cache(maxsize=1024)(_origin)


def _time(seconds: float) -> float:
    """A time that calendars and recordings can hold; 0 for what is none."""
    return float(seconds) if 0 <= seconds < LATEST else 0.0


def _fields(text: str) -> dict[str, Any]:
    """A Property as text; nothing for what is none."""
    try:
        told = Bottle.from_text(text)
    except DecodeError:
        return {}
    pairs = [each for each in told if isinstance(each, Bottle) and len(each) == 2]
    return {plain_text(key): value for key, value in pairs if isinstance(key, str)}
