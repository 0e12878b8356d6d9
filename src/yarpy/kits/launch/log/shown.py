"""Lines of a log as people and programs read them.

    12:07:03 vm/arm.py/77 [WARNING] |my.arm| joint 3 is hot

Rules: pure. What a terminal would obey is escaped, whoever wrote it; the colours are those of C++.
"""

from __future__ import annotations

import time
from functools import lru_cache
from typing import Any, Final

from yarpy.log import readable
from yarpy.port.keep.log_line import LogLine

COLOURS: Final = {
    "TRACE": "37",
    "DEBUG": "32",
    "INFO": "34",
    "WARNING": "33",
    "ERROR": "31",
    "FATAL": "97;41",
}


def text_of(line: LogLine, coloured: bool = False) -> str:
    """Return a line as text, with its backtrace behind it, if it has one."""
    level = line.level or "?"
    if coloured and line.level:
        level = f"\x1b[1;{COLOURS[level]}m{level}\x1b[0m"
    component = f"|{readable(line.component)}| " if line.component else ""
    origin = _origin(line.origin)
    text = f"{_clock(int(line.time))} {origin} [{level}] {component}{readable(line.text)}"
    trace = line.more.get("backtrace") if line.more else None
    if isinstance(trace, str):
        text += "".join(f"\n    {readable(each)}" for each in trace.splitlines())
    return text


def told_of(line: LogLine) -> dict[str, Any]:
    """Return a line as what JSON makes an object of."""
    return {
        "port": line.origin,
        "level": line.level,
        "time": line.time,
        "component": line.component,
        "message": line.text,
        **{key: value for key, value in line.more.items() if key not in ("port", "time")},
    }


@lru_cache(maxsize=1024)
def _origin(name: str) -> str:
    return readable(name.removeprefix("/log/"))


@lru_cache(maxsize=64)
def _clock(seconds: int) -> str:
    return time.strftime("%H:%M:%S", time.localtime(seconds)) if seconds else "--:--:--"
