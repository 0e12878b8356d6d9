"""http: browsers, curl and other programs talk to a port in HTTP/1.1, on the port's own TCP port.

    GET /?req=get+encs              a message; its reply as JSON
    POST /form                      the same from a form, as JSON or as text
    GET /                           the page of the port
    GET /r                          every message that the port writes, as long as one reads
    GET /r  Accept: text/event-stream          the same for JavaScript's EventSource

Rules: what a request means is `http_request`, the page is `http_page`, who may act is `origin`;
here is the protocol alone, with an h11 for each request anew. Every request gets exactly one
response, also if the port says nothing (204, or `[]` in JSON), or if it comes too slowly (408). Bad
requests get their status and end the connection. Who reads slowly misses messages. Between ports
each message is a POST and its response the acknowledgement (`http_client`).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

from yarpy.carriers.base import MAGIC_SIZE, Carrier
from yarpy.carriers.http_client import ENVELOPE, HttpClient
from yarpy.carriers.http_message import (
    CONTINUE,
    HTML,
    JSON,
    LAST_CHUNK,
    MAX_BODY,
    MAX_HEAD,
    TEXT,
    Headers,
    chunk,
    next_event,
    response_head,
)
from yarpy.carriers.origin import hostname, origins_of
from yarpy.contact import Route
from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.errors import LinkClosed, LocalProtocolError, RemoteProtocolError, Timeout, YarpError
from yarpy.wire.effects import Steps
from yarpy.wire.message import CALL, QUIT, Lines, Message, Packet
from yarpy.wire.stream import ByteStream

if TYPE_CHECKING:
    import h11

    from yarpy.carriers.http_request import Form, Refusal, Request, Wish

DRAIN: Final = 1 << 20  # bytes of a refused body that are read, so that the refusal arrives
PATIENCE: Final = 60.0  # seconds a connection may be idle, and a request may take to come
PRELUDE: Final = 2048  # blanks with which an endless page begins, as in C++: browsers wait for some

_METHODS: Final = (b"GET /", b"POST /", b"HEAD /", b"OPTIONS ", b"PUT /", b"DELETE /", b"PATCH /")
_TYPES: Final = {"page": HTML, "json": JSON, "text": TEXT, "events": "text/event-stream"}
_COMMON: Final = [
    ("Cache-Control", "no-store"),
    ("X-Content-Type-Options", "nosniff"),
    ("Access-Control-Allow-Origin", "*"),
]
# Our own page needs neither scripts nor anything from elsewhere.
_PAGE_POLICY: Final = (
    "default-src 'none'; style-src 'unsafe-inline'; form-action 'self'; base-uri 'none'"
)
# A page that a program made: its scripts run, but not as those of the port's own pages.
_GUEST_POLICY: Final = (
    "Content-Security-Policy",
    "sandbox allow-scripts allow-forms allow-popups",
)
_MAY_NOT_ACT: Final = b"the owner of this port lets only some pages act here (YARPY_WEB_ORIGINS)\n"
_LATE: Final = b"the request takes too long to come\n"


class Http(Carrier):
    """One connection of a browser, with any number of requests; or ours to another port."""

    name = "http"
    magic = b"GET /"
    spelling = "text"
    acks = True
    foreign = True
    gathers = False
    patience = PATIENCE
    hurry = PATIENCE

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self.origins = origins_of()
        # Of the request that is being read or answered:
        self._headers: Mapping[str, str] = {}
        self._head_only = False
        self._modern = False  # HTTP/1.1, which knows chunks
        self._stays = False  # the connection stays open for another one
        self._wish: Wish | None = None  # what is being answered
        self._taken = 0  # messages that were handed on, and those that are acknowledged
        self._acked = 0
        self._streaming = False
        self._form: Form = "text"  # of what is streamed
        self._pixels = False
        self._client = HttpClient(route)
        self._confirmed = False  # the response to our last call was read with its reply

    @classmethod
    def recognises(cls, first: bytes) -> int:
        if first == b"POST /RP":
            return 0  # XML-RPC
        if first == b"POST /fo":
            return MAGIC_SIZE
        return next((len(method) for method in _METHODS if first.startswith(method)), 0)

    # -- reading requests -------------------------------------------------------------------------

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[None]:
        """Wait for the head of the first request, which a greeting has limited time for."""
        self.route.source = "web"
        stream.unread(len(first))
        try:
            while stream.waiting < MAX_HEAD and not _complete(stream):
                yield from stream.more(stream.waiting + 1)
        except Timeout:
            self._respond(stream, 408, TEXT, _LATE)
            raise

    def decode(self, stream: ByteStream) -> Steps[Message]:
        while not self.finished:
            if self._streaming:  # the reply to the last message has begun something endless
                self.holding = False
                return Message("r")
            if self._wish is not None:
                self._answer_nothing(stream)  # the next request waits already
                continue
            request = yield from self._read_request(stream)
            wish = self._understood(stream, request) if request is not None else None
            if self.successor is not None:
                return Message("r")
            if wish is None:
                continue
            self._taken += 1
            if wish.key == "r":
                self._begin_reading(stream, wish)
                return Message("r")
            self._wish = wish
            self.structured = wish.form == "json"
            return wish.message(_envelope(self._headers))
        return Message(QUIT)

    def _read_request(self, stream: ByteStream) -> Steps[Request | None]:
        """The next request with its body; None if it was refused."""
        import h11

        from yarpy.carriers.http_request import Request

        self._headers = {}
        self._head_only = self._modern = self._stays = False
        talk = h11.Connection(h11.SERVER, max_incomplete_event_size=MAX_HEAD)
        yield from stream.more(1)
        self.midway = True
        body = bytearray()
        refusal = 413, f"a body has at most {MAX_BODY} bytes"
        try:
            head = yield from next_event(stream, talk)
            if not isinstance(head, h11.Request):
                raise LinkClosed("the peer closed the connection")
            self._take_head(head)
            event = None
            if sum(map(len, (head.target, *self._headers, *self._headers.values()))) > MAX_HEAD:
                refusal = 431, f"the head of a request has at most {MAX_HEAD} bytes"
            elif int(self._headers.get("content-length", "0")) <= MAX_BODY:
                if talk.they_are_waiting_for_100_continue:
                    stream.write(CONTINUE)
                event = yield from next_event(stream, talk)
                while isinstance(event, h11.Data) and len(body) <= MAX_BODY:
                    body += event.data
                    event = yield from next_event(stream, talk)
        except h11.RemoteProtocolError as error:
            event, refusal = None, (error.error_status_hint, str(error))
        except Timeout:
            self._stays = False
            self._respond(stream, 408, TEXT, _LATE)
            raise
        except LinkClosed:
            if self._headers:
                self._respond(stream, 400, TEXT, b"the body is shorter than its length\n")
            raise
        if not isinstance(event, h11.EndOfMessage):
            yield from self._refuse(stream, *refusal)
        self.midway = False
        rest, _ = talk.trailing_data
        stream.unread(len(rest))  # of the next request
        target = head.target.decode("latin-1")
        return Request(head.method.decode("ascii"), target, self._headers, bytes(body))

    def _take_head(self, head: h11.Request) -> None:
        self._headers = {
            name.decode("ascii"): value.decode("latin-1") for name, value in head.headers
        }
        self._head_only = head.method == b"HEAD"
        self._modern = head.http_version >= b"1.1"
        self._stays = self._modern and "close" not in self._headers.get("connection", "").lower()

    def _refuse(self, stream: ByteStream, status: int, text: str) -> Steps[None]:
        """Answer a request that cannot be read to its end; the connection is over."""
        self._stays = False
        self._respond(stream, status, TEXT, _encoded(text + "\n"))
        if status in (413, 431):
            # Hanging up on somebody who still sends would take the answer away from him.
            left = DRAIN
            while left > 0:
                try:
                    yield from stream.more(1)
                except LinkClosed:
                    break
                left -= stream.waiting
                stream.head = stream.tail
        raise RemoteProtocolError(f"HTTP {status}: {text}")

    def _understood(self, stream: ByteStream, request: Request) -> Wish | None:
        """What is wanted of the port; None if the request is answered without it."""
        from yarpy.carriers.http_request import page_asked, read_wish

        if request.method == "OPTIONS":
            self._preflight(stream)
            return None
        if request.method not in ("GET", "HEAD", "POST"):
            self._respond(stream, 405, TEXT, b"", [("Allow", "GET, HEAD, POST, OPTIONS")])
            return None
        if request.method == "GET" and request.target.startswith("/?action="):
            self._show_pictures(stream, request.target)
            return None
        asked = page_asked(request) if self.pages is not None else None
        page = self.pages(*asked) if asked and self.pages is not None else None
        if page is not None:
            framing = self.origins.framing
            policy = [("Content-Security-Policy", framing)] if framing else []
            self._respond(stream, page.status, page.kind, page.to_bytes(), policy)
            return None
        return self._screened(stream, read_wish(request))

    def _screened(self, stream: ByteStream, wish: Wish | Refusal) -> Wish | None:
        """Answer what needs no port, or must not come to it."""
        from yarpy.carriers.http_request import Refusal

        if isinstance(wish, Refusal):
            text = f"{wish.text}\n" if wish.text else ""
            self._respond(stream, wish.status, wish.kind, _encoded(text))
        elif wish.acts and not self.origins.admits(self._headers):
            self._respond(stream, 403, TEXT, _MAY_NOT_ACT)
        elif self._head_only and (wish.acts or wish.key == "r"):
            # Asking for a head must change nothing, so there is no reply to tell the length of.
            self._respond(stream, 200, _TYPES.get(wish.form, TEXT), None)
        else:
            return wish
        return None

    # -- answering --------------------------------------------------------------------------------

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        wish = self._wish
        if wish is None:
            return  # nobody waits for it any more
        try:
            if wish.form == "json":
                self._respond(stream, 200, JSON, _json_body(value, wish))
            elif wish.form == "none":
                self._respond(stream, 204, TEXT, b"")
            elif self._show_guest(stream, value):
                pass
            elif wish.form == "page":
                self._show(stream, wish, _lines(value))
            else:
                self._respond(stream, 200, TEXT, _text_body(value))
        except (TypeError, ValueError, YarpError):
            if self._wish is not None:
                self._respond(stream, 500, TEXT, b"the port's answer cannot be sent\n")
            raise

    def encode_lines(self, stream: ByteStream, lines: list[str]) -> None:
        wish = self._wish
        if wish is None:
            return
        if wish.form == "page":
            self._show(stream, wish, lines)
        elif wish.form == "json":
            self._respond(stream, 200, JSON, _json_body(["list", *lines], wish))
        else:
            self._respond(stream, 200, TEXT, Lines(lines).to_text())

    def encode_ack(self, stream: ByteStream) -> None:
        """The response to a message that the port did not reply to."""
        self._acked += 1
        if self._wish is not None and self._acked >= self._taken:
            self._answer_nothing(stream)

    def encode_quit(self, stream: ByteStream) -> None:
        if self._streaming and self._modern:
            stream.write(LAST_CHUNK)
        self._streaming = False

    def _answer_nothing(self, stream: ByteStream) -> None:
        wish = self._wish
        assert wish is not None
        if wish.form == "json":
            self._respond(stream, 200, JSON, b"[]\n")
        elif wish.form == "page":
            self._show(stream, wish, ["(no reply)"])
        else:
            self._respond(stream, 204, TEXT, b"")

    def _show(self, stream: ByteStream, wish: Wish, lines: list[str]) -> None:
        from yarpy.carriers.http_page import page

        host = hostname(self._headers.get("host", ""))
        body = page(self.route.target, lines, wish.shown, host)
        self._respond(stream, 200, HTML, body, [self._policy()])

    def _policy(self) -> tuple[str, str]:
        """What browsers are told to refuse to the page; its form is not for others to frame."""
        framing = self.origins.framing
        return "Content-Security-Policy", _PAGE_POLICY + (f"; {framing}" if framing else "")

    def _show_guest(self, stream: ByteStream, value: object) -> bool:
        """Answer with the page that a program put under the key `web`; False if there is none."""
        from yarpy.carriers.http_stream import web_of

        body = web_of(value) if isinstance(value, (list, tuple)) else None
        if body is None or not isinstance(value, (list, tuple)):
            return False
        mime = Bottle(value).group("mime")
        kind = str(mime[1]) if mime is not None and len(mime) > 1 else HTML
        if not (kind.isascii() and kind.isprintable()):
            return False
        if Bottle(value).group("stream") is None:
            self._respond(stream, 200, kind, body, [_GUEST_POLICY])
            return True
        self._wish = None
        self._begin_stream(stream, "guest", [("Content-Type", kind), _GUEST_POLICY])
        self._write_part(stream, b" " * PRELUDE + body)
        self.holding = True
        return True

    def _preflight(self, stream: ByteStream) -> None:
        acting = ", POST" if self.origins.admits(self._headers) else ""
        headers = [
            ("Allow", "GET, HEAD, POST, OPTIONS"),
            ("Access-Control-Allow-Methods", f"GET, HEAD{acting}"),
            ("Access-Control-Allow-Headers", f"Content-Type, {ENVELOPE.title()}"),
            ("Access-Control-Max-Age", "600"),
        ]
        self._respond(stream, 204, TEXT, b"", headers)

    def _respond(
        self, stream: ByteStream, status: int, kind: str, body: bytes | None, more: Headers = ()
    ) -> None:
        """Write a whole response. No body: only the head was asked for, and nobody knows it."""
        self._wish = None
        headers = [*_COMMON, *more]
        if status != 204:
            headers.append(("Content-Type", kind))
            if body is not None:
                headers.append(("Content-Length", str(len(body))))
        if not self._stays:
            headers.append(("Connection", "close"))
            self.finished = True
        try:
            head = response_head(status, headers)
        except LocalProtocolError as error:
            body = _encoded(f"{error}\n")
            size = ("Content-Length", str(len(body)))
            head = response_head(500, [*_COMMON, ("Content-Type", TEXT), size])
        if body and not self._head_only:
            stream.write(head, body)
        else:
            stream.write(head)

    # -- a reader ---------------------------------------------------------------------------------

    def _begin_reading(self, stream: ByteStream, wish: Wish) -> None:
        """Answer `/r`: everything that the port writes, from now on."""
        from yarpy.carriers.http_page import stream_head
        from yarpy.carriers.http_stream import KINDS

        self._pixels = wish.pixels
        policy = [self._policy()] if wish.form == "page" else []
        self._begin_stream(stream, wish.form, [("Content-Type", KINDS[wish.form]), *policy])
        if wish.form == "page":
            self._write_part(stream, stream_head(self.route.target))
        elif wish.form == "events":
            self._write_part(stream, b": reading\n\n")

    def _begin_stream(self, stream: ByteStream, form: Form, headers: Headers) -> None:
        """The head of a response that does not end; the connection becomes an output."""
        self._streaming, self._form = True, form
        self.acks, self.lossy, self.backlog = False, True, 16
        way = ("Transfer-Encoding", "chunked") if self._modern else ("Connection", "close")
        stream.write(response_head(200, [*_COMMON, *headers, way]))

    def _show_pictures(self, stream: ByteStream, target: str) -> None:
        """A browser asks for MJPEG on a connection that it has used for a page before."""
        from yarpy.carriers.mjpeg import Mjpeg

        old = self.route
        self.successor = mjpeg = Mjpeg(Route("", old.target, "mjpeg", old.port, old.host))
        mjpeg.accepted = True
        mjpeg.begin(stream, target, "origin" in self._headers)

    def prepare(self, packet: Packet) -> bool:
        if not self._streaming:
            return super().prepare(packet)
        self._part(packet)
        return True

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        if self._streaming:
            self._write_part(stream, self._part(packet))
        else:
            self._client.post(stream, packet)

    def _part(self, packet: Packet) -> bytes:
        from yarpy.carriers.http_stream import part

        return part(packet, self._form, self._pixels)

    def _write_part(self, stream: ByteStream, data: bytes) -> None:
        stream.write(chunk(data) if self._modern else data)

    # -- dialling ---------------------------------------------------------------------------------

    def greet(self, stream: ByteStream) -> Steps[None]:
        return
        yield

    def expect_reply(self, stream: ByteStream) -> Steps[Message | None]:
        status, body = yield from self._client.response(stream)
        self._confirmed = True
        if status == 204:
            return None
        return Message(CALL, body.rstrip(b"\r\n"), spelling="text")

    def expect_ack(self, stream: ByteStream) -> Steps[None]:
        if self._confirmed:
            self._confirmed = False
        else:
            yield from self._client.response(stream)


def _complete(stream: ByteStream) -> bool:
    """Whether the head of a request has come."""
    buffer, head, tail = stream.buffer, stream.head, stream.tail
    return buffer.find(b"\n\r\n", head, tail) >= 0 or buffer.find(b"\n\n", head, tail) >= 0


def _envelope(headers: Mapping[str, str]) -> str:
    text = headers.get(ENVELOPE, "")
    return text if text.isascii() and text.isprintable() else ""


def _json_body(value: object, wish: Wish) -> bytes:
    from yarpy.data.json import to_json

    if isinstance(value, Lines):
        value = ["list", *value]
    return (to_json(value, wish.outer) + "\n").encode()


def _text_body(value: object) -> bytes:
    return value.to_text() if isinstance(value, Lines) else codec.encode_text(value) + b"\r\n"


def _lines(value: object) -> list[str]:
    """What a reply is on a page."""
    if isinstance(value, Lines):
        return list(value)
    return [codec.encode_text(value).decode("utf-8", "surrogateescape")]


def _encoded(text: str) -> bytes:
    return text.encode("utf-8", "replace")
