"""Our side of HTTP when we dial: each message is a POST, its response the acknowledgement.

Rules: the carrier string gives the path (`http+path.hook`); responses come in the order of the
requests; an error status ends the connection, with the response's text as the reason.
"""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Final

from yarpy.carriers.web.http.message import TEXT, next_event, request_head
from yarpy.errors import LinkClosed, RemoteProtocolError
from yarpy.limit import HTTP_BODY, HTTP_HEAD
from yarpy.route import Route
from yarpy.wire.message import ADMIN, DATA, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

if TYPE_CHECKING:
    import h11

ENVELOPE: Final = "yarp-envelope"


class HttpClient:
    """The requests sent to one server that it has not answered yet."""

    def __init__(self, route: Route) -> None:
        self.route = route
        self._asked: deque[h11.Connection] = deque()

    def post(self, stream: ByteStream, packet: Packet) -> None:
        """Send a message."""
        import h11

        route = self.route
        host = f"[{route.host}]" if ":" in route.host else route.host or "yarp"
        path = (route.spec.value("path") or "form").lstrip("/")
        form = "none" if packet.key == DATA else "text"
        admin = "&admin=1" if packet.key == ADMIN else ""
        body = packet.line
        headers = [
            ("Host", f"{host}:{route.port}"),
            ("Content-Type", TEXT),
            ("Content-Length", str(len(body))),
        ]
        if packet.envelope:
            envelope = packet.envelope.decode("latin-1")
            if envelope.isascii() and envelope.isprintable():
                headers.append((ENVELOPE, envelope))
        stream.write(request_head("POST", f"/{path}?format={form}{admin}", headers) + body)
        talk = h11.Connection(h11.CLIENT, max_incomplete_event_size=HTTP_HEAD)
        # To read the response, h11 must know the method of the request, but not its bytes.
        talk.send(h11.Request(method="POST", target="/", headers=[("Host", "x")]))
        talk.send(h11.EndOfMessage())
        self._asked.append(talk)

    def response(self, stream: ByteStream) -> Steps[tuple[int, bytes]]:
        """Status and body of the response to the oldest of our requests.

        Raises LinkClosed, RemoteProtocolError.
        """
        import h11

        if not self._asked:
            raise RemoteProtocolError("a response came without a request")
        talk = self._asked.popleft()
        body = bytearray()
        limit = min(stream.limit, HTTP_BODY)
        try:
            head = yield from next_event(stream, talk)
            while isinstance(head, h11.InformationalResponse):
                head = yield from next_event(stream, talk)
            while isinstance(event := (yield from next_event(stream, talk)), h11.Data):
                body += event.data
                if len(body) > limit:
                    raise RemoteProtocolError(f"a response of more than {limit} bytes")
        except h11.RemoteProtocolError as error:
            raise RemoteProtocolError(f"not an HTTP response: {error}") from None
        if not (isinstance(head, h11.Response) and isinstance(event, h11.EndOfMessage)):
            raise LinkClosed("the peer closed the connection")
        rest, _ = talk.trailing_data
        stream.unread(len(rest))
        if not 200 <= head.status_code < 300:
            text = bytes(body[:200]).decode("utf-8", "replace").strip()
            raise RemoteProtocolError(f"HTTP {head.status_code}: {text}")
        return head.status_code, bytes(body)
