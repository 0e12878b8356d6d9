"""The last answer on a connection: a status, a line that says what to do, and no more.

For the carriers beside http that begin as a request of HTTP. Rules: the peer gets the time to read
it; closing while the peer still sends resets the connection and loses the answer.
"""

from __future__ import annotations

from typing import Final, Never

from yarpy.carriers.http.message import TEXT, Headers, response_head
from yarpy.errors import LinkClosed, RemoteProtocolError
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

DRAIN: Final = 1 << 26  # bytes of a refused request that are read


def refuse(
    stream: ByteStream, status: int, text: str, more: Headers = (), rest: int = 0
) -> Steps[Never]:
    """Say no, and end: raises RemoteProtocolError. `rest` bytes of the request are to come."""
    body = f"{text}\n".encode()
    last = [("Content-Type", TEXT), ("Content-Length", str(len(body))), ("Connection", "close")]
    stream.write(response_head(status, [*more, *last]) + body)
    try:
        yield from stream.skip(min(rest, DRAIN))
        yield from stream.more(stream.waiting + 1)
    except LinkClosed:
        pass
    raise RemoteProtocolError(f"HTTP {status}: {text}")
