"""The last answer on a connection: a status, and a line that says what to do.

For other carriers that begin as an HTTP request. Rules: the peer gets time to read it; closing
while the peer still sends would reset the connection and lose the answer.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, Never

from yarpy.carriers.http.message import TEXT, Headers, response_head
from yarpy.carriers.http.token import claim
from yarpy.errors import AccessRefused, LinkClosed, RemoteProtocolError
from yarpy.wire.effects import May
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

DRAIN: Final = 1 << 26  # bytes of a refused request that are read


def refuse(
    stream: ByteStream,
    status: int,
    text: str,
    more: Headers = (),
    rest: int = 0,
    error: type[RemoteProtocolError] = RemoteProtocolError,
) -> Steps[Never]:
    """Refuse and end: raises `error`. `rest` bytes of the request are still unread."""
    body = f"{text}\n".encode()
    last = [("Content-Type", TEXT), ("Content-Length", str(len(body))), ("Connection", "close")]
    stream.write(response_head(status, [*more, *last]) + body)
    try:
        yield from stream.skip(min(rest, DRAIN))
        yield from stream.more(stream.waiting + 1)
    except LinkClosed:
        pass
    raise error(f"HTTP {status}: {text}")


def screen(
    stream: ByteStream, target: str, headers: Mapping[str, str], right: str, rest: int = 0
) -> Steps[str]:
    """The target of a request without its web token, if its sender may do that; else say why not,
    and end. Raises AccessRefused."""
    shown = yield from claim(target, headers)
    why = shown.refusal or (yield May(right))
    if why:
        yield from refuse(stream, 403, why, rest=rest, error=AccessRefused)
    return shown.target
