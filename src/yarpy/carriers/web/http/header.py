"""A tolerant reader of HTTP header lines from cameras, web pages and other programs.

Rules: line ends are CR LF or LF, order and case do not matter, later lines win, except that login
challenges accumulate; number and length of lines are limited. (The carrier http, which must be
strict for browsers, uses h11.)
"""

from __future__ import annotations

from typing import Final

from yarpy.errors import RemoteProtocolError
from yarpy.limit import HTTP_LINE, HTTP_LINES
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

CHALLENGES: Final = "www-authenticate"  # a line each, or several in one


def read_headers(stream: ByteStream) -> Steps[dict[str, str]]:
    """Lines up to an empty one; names in lower case."""
    found: dict[str, str] = {}
    for _ in range(HTTP_LINES):
        line = yield from stream.read_line(HTTP_LINE)
        if not line:
            return found
        name, _, value = line.decode("latin-1").partition(":")
        name, value = name.strip().lower(), value.strip()
        if name == CHALLENGES and name in found:
            value = f"{found[name]}, {value}"
        found[name] = value
    raise RemoteProtocolError(f"more than {HTTP_LINES} header lines")
