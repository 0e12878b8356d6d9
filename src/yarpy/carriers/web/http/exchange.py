"""One request of HTTP and its response, as bytes.

Rules: each request has an h11 of its own. What is too slow gets a 408, what is wrong or too large
its status, and the connection ends.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

from yarpy.carriers.web.http.client import ENVELOPE
from yarpy.carriers.web.http.message import CONTINUE, next_event, two_lengths
from yarpy.carriers.web.http.refusal import linger
from yarpy.carriers.web.http.response import CUT_OFF, LATE, Response, complaint
from yarpy.errors import LinkClosed, LocalProtocolError, RemoteProtocolError, Timeout
from yarpy.limit import HTTP_BODY, HTTP_HEAD
from yarpy.wire.effects import Within
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

if TYPE_CHECKING:
    import h11

    from yarpy.carriers.web.http.intent import Request

TIME: Final = 60.0  # seconds a connection may be idle, and a request may take to arrive


class Exchange:
    """A request that is read and answered."""

    def __init__(self) -> None:
        self.headers: Mapping[str, str] = {}
        self.head_only = False
        self.modern = False  # HTTP/1.1, which knows chunks
        self.stays = False  # the connection stays open for the next one

    @property
    def host(self) -> str:
        """Return the host that the client asked."""
        return self.headers.get("host", "")

    @property
    def envelope(self) -> str:
        """Return the envelope of the message, "" for none."""
        text = self.headers.get(ENVELOPE, "")
        return text if text.isascii() and text.isprintable() else ""

    def read(self, stream: ByteStream) -> Steps[Request]:
        """Return the request with its body. Raises RemoteProtocolError, Timeout, LinkClosed for one
        that cannot be read to its end, which is answered if it can be."""
        import h11

        from yarpy.carriers.web.http.intent import Request

        talk = h11.Connection(h11.SERVER, max_incomplete_event_size=HTTP_HEAD)
        yield from stream.more(1)
        yield Within(TIME)
        body = bytearray()
        most = min(HTTP_BODY, stream.limit)
        refusal = 413, f"a body may have at most {most} bytes"
        try:
            head = yield from next_event(stream, talk)
            if not isinstance(head, h11.Request):
                raise LinkClosed("the peer closed the connection")
            self._take_head(head)
            event = None
            if two_lengths(head):
                refusal = 400, "a body has either a Content-Length or chunks, not both"
            elif sum(map(len, (head.target, *self.headers, *self.headers.values()))) > HTTP_HEAD:
                refusal = 431, f"the head of a request may have at most {HTTP_HEAD} bytes"
            elif int(self.headers.get("content-length", "0")) <= most:
                if talk.they_are_waiting_for_100_continue:
                    stream.write(CONTINUE)
                event = yield from next_event(stream, talk)
                while isinstance(event, h11.Data) and len(body) <= most:
                    body += event.data
                    event = yield from next_event(stream, talk)
        except h11.RemoteProtocolError as error:
            event, refusal = None, (error.error_status_hint, str(error))
        except Timeout:
            self.stays = False
            self.respond(stream, LATE)
            raise
        except LinkClosed:
            if self.headers:
                self.respond(stream, CUT_OFF)
            raise
        if not isinstance(event, h11.EndOfMessage):
            yield from self._refuse(stream, *refusal)
        yield Within(None)
        rest, _ = talk.trailing_data
        stream.unread(len(rest))  # of the next request
        target = head.target.decode("latin-1")
        return Request(head.method.decode("ascii"), target, self.headers, bytes(body))

    def _take_head(self, head: h11.Request) -> None:
        self.headers = {
            name.decode("ascii"): value.decode("latin-1") for name, value in head.headers
        }
        self.head_only = head.method == b"HEAD"
        self.modern = head.http_version >= b"1.1"
        self.stays = self.modern and "close" not in self.headers.get("connection", "").lower()

    def _refuse(self, stream: ByteStream, status: int, text: str) -> Steps[None]:
        """Answer a request that cannot be read to its end, and end the connection."""
        self.stays = False
        self.respond(stream, complaint(status, text))
        if status in (413, 431):
            yield from linger(stream)
        raise RemoteProtocolError(f"HTTP {status}: {text}")

    def respond(self, stream: ByteStream, response: Response) -> None:
        """Write a whole response."""
        last = [] if self.stays else [("Connection", "close")]
        try:
            head = response.head(*last)
        except LocalProtocolError as error:
            response = complaint(500, str(error))
            head = response.head()
        if isinstance(response.body, bytes) and response.body and not self.head_only:
            stream.write(head, response.body)
        else:
            stream.write(head)


def whole_head(stream: ByteStream) -> Steps[None]:
    """Wait until the head of a request has arrived, or more than one may have."""
    while stream.waiting < HTTP_HEAD and not _complete(stream):
        yield from stream.more(stream.waiting + 1)


def _complete(stream: ByteStream) -> bool:
    """Return whether the head of a request has arrived."""
    buffer, head, tail = stream.buffer, stream.head, stream.tail
    return buffer.find(b"\n\r\n", head, tail) >= 0 or buffer.find(b"\n\n", head, tail) >= 0
