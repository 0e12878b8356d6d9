"""The last answer on a connection: a status, and a line that says what to do.

Rules: the peer gets a moment to read it; closing while the peer still sends would reset the
connection and lose the answer. It is a short moment, and few bytes: whoever is refused must not
occupy a thread.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, Never

from yarpy.carriers.web.http.message import TEXT, Headers, response_head
from yarpy.carriers.web.http.origin import origins_of
from yarpy.carriers.web.http.token import claim
from yarpy.errors import AccessRefused, LinkClosed, RemoteProtocolError, Timeout
from yarpy.route import Route
from yarpy.wire.effects import May, Within
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

DRAIN: Final = 1 << 26  # bytes that are read behind a refused request
LINGER: Final = 2.0  # seconds


def refuse(
    stream: ByteStream,
    status: int,
    text: str,
    more: Headers = (),
    error: type[RemoteProtocolError] = RemoteProtocolError,
) -> Steps[Never]:
    """Refuse and end: raises `error`."""
    body = f"{text}\n".encode()
    last = [("Content-Type", TEXT), ("Content-Length", str(len(body))), ("Connection", "close")]
    stream.write(response_head(status, [*more, *last]) + body)
    yield from linger(stream)
    raise error(f"HTTP {status}: {text}")


def linger(stream: ByteStream) -> Steps[None]:
    """Read what the peer still sends behind its last answer, for a while."""
    yield Within(LINGER)
    try:
        yield from stream.skip(DRAIN)
    except (LinkClosed, Timeout):
        pass


def screen_page(
    stream: ByteStream, headers: Mapping[str, str], route: Route, acts: bool = False
) -> Steps[None]:
    """Go on if the page that makes a request may read, and act if it `acts`; else say why not, and
    end."""
    refusal = origins_of().refusal(headers, route.host, "tls" in route.spec.tokens, acts)
    if refusal is not None:
        yield from refuse(stream, *refusal)


def screen(stream: ByteStream, target: str, headers: Mapping[str, str], right: str) -> Steps[str]:
    """The target of a request without its web token, if its sender may do that; else say why not,
    and end. Raises AccessRefused."""
    shown = yield from claim(target, headers)
    why = shown.refusal or (yield May(right))
    if why:
        yield from refuse(stream, 403, why, error=AccessRefused)
    return shown.target
