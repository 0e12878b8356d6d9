"""One HTTP/1.1 message: read by h11, written here.

Rules: h11 checks every byte that peers send. We send either a head with the length of its body or a
head followed by chunks, so that writing is joining bytes; header values are checked for characters
that would end a line.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from yarpy.errors import LocalProtocolError
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

if TYPE_CHECKING:
    import h11

Headers: TypeAlias = Iterable[tuple[str, str]]

CONTINUE: Final = b"HTTP/1.1 100 Continue\r\n\r\n"
LAST_CHUNK: Final = b"0\r\n\r\n"
HTML: Final = "text/html; charset=utf-8"
TEXT: Final = "text/plain; charset=utf-8"
JSON: Final = "application/json"

_REASONS: Final = {
    200: "OK",
    204: "No Content",
    303: "See Other",
    400: "Bad Request",
    403: "Forbidden",
    404: "Not Found",
    405: "Method Not Allowed",
    408: "Request Timeout",
    411: "Length Required",
    413: "Content Too Large",
    415: "Unsupported Media Type",
    421: "Misdirected Request",
    426: "Upgrade Required",
    431: "Request Header Fields Too Large",
    500: "Internal Server Error",
    501: "Not Implemented",
    505: "HTTP Version Not Supported",
}


def response_head(status: int, headers: Headers) -> bytes:
    """The head of a response. LocalProtocolError for a header value that cannot be sent."""
    return _head(f"HTTP/1.1 {status} {_REASONS.get(status, '')}", headers)


def request_head(method: str, target: str, headers: Headers) -> bytes:
    """The head of a request. LocalProtocolError for a target or header that cannot be sent."""
    if not (target.isascii() and target.isprintable()) or " " in target:
        raise LocalProtocolError(f"the path {target!r} contains blanks: write %20 for each")
    return _head(f"{method} {target} HTTP/1.1", headers)


def chunk(data: bytes) -> bytes:
    """A piece of a body of unknown length; empty for no data, since an empty chunk would end it."""
    return b"%x\r\n%b\r\n" % (len(data), data) if data else b""


def _head(first: str, headers: Headers) -> bytes:
    lines = [first]
    for name, value in headers:
        line = f"{name}: {value}"
        if not line.isprintable():
            raise LocalProtocolError(f"the header {name} cannot be {value!r}")
        lines.append(line)
    return ("\r\n".join(lines) + "\r\n\r\n").encode("latin-1", "replace")


def two_lengths(head: h11.Request) -> bool:
    """Return whether a request gives its length in two ways: a proxy on the way may have read a
    different request than we would (request smuggling). h11 refuses two numbers."""
    names = {name for name, _ in head.headers}
    return b"transfer-encoding" in names and b"content-length" in names


def next_event(stream: ByteStream, talk: h11.Connection) -> Steps[Any]:
    """The next event that h11 finds in the peer's bytes."""
    import h11

    while (event := talk.next_event()) is h11.NEED_DATA:
        yield from stream.more(1)
        talk.receive_data(bytes(stream.buffer[stream.head : stream.tail]))
        stream.head = stream.tail
    return event
