"""Header lines of HTTP as a tolerant reader sees them: of cameras, ROS programs, web pages.

Rules: line ends are CR LF or LF, order and spelling do not matter, later lines win, except that
ways to log in add up; their number and length are limited. (The carrier http, which owes browsers
every detail, uses h11.)
"""

from __future__ import annotations

from typing import Final

from yarpy.errors import RemoteProtocolError
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

MAX_LINE: Final = 1 << 14  # bytes of one line
MAX_LINES: Final = 200

CHALLENGES: Final = "www-authenticate"  # a line each, or several in one


def read_headers(stream: ByteStream) -> Steps[dict[str, str]]:
    """Lines up to an empty one; names in small letters."""
    found: dict[str, str] = {}
    for _ in range(MAX_LINES):
        line = yield from stream.read_line(MAX_LINE)
        if not line:
            return found
        name, _, value = line.decode("latin-1").partition(":")
        name, value = name.strip().lower(), value.strip()
        if name == CHALLENGES and name in found:
            value = f"{found[name]}, {value}"
        found[name] = value
    raise RemoteProtocolError(f"more than {MAX_LINES} header lines")
