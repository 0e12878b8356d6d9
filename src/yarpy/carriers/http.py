"""http: browsers, curl and other programs talk to a port in HTTP/1.1, on the port's own TCP port.

    GET /?req=get+encs              a message; its reply as JSON
    POST /form                      the same from a form, as JSON or as text
    GET /                           the page of the port
    GET /r                          every message that the port writes, as long as one reads
    GET /r  Accept: text/event-stream          the same for JavaScript's EventSource

Rules: what a request means is `http_request`, the page is `http_page`; here is the protocol alone,
with h11 for each request anew. Every request gets exactly one response, also if the port says
nothing (204, or `[]` in JSON). Bad requests get their status and end the connection. Who reads
slowly misses messages. Between ports each message is a POST and its response the acknowledgement.

Other origins: any page may read and act, as in C++. `YARPY_WEB_ORIGINS` names the origins whose
pages may act (`http://dash:8080 https://x.org`, or `none`); then a browser must show that it is
such a page, or the port's own.
"""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

from yarpy.carriers.base import MAGIC_SIZE, Carrier
from yarpy.contact import Route, modifier
from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.errors import LinkClosed, RemoteProtocolError, YarpError
from yarpy.wire.effects import Steps
from yarpy.wire.message import ADMIN, CALL, DATA, QUIT, Lines, Message, Packet
from yarpy.wire.stream import ByteStream

if TYPE_CHECKING:
    import h11

    from yarpy.carriers.http_request import Form, Refusal, Wish

MAX_HEAD: Final = 1 << 14  # bytes of a request line with all headers
MAX_BODY: Final = 1 << 24
DRAIN: Final = 1 << 20  # bytes of a refused body that are read, so that the refusal arrives
_PRELUDE: Final = 2048  # blanks with which an endless page begins, so that browsers show it
PATIENCE: Final = 60.0  # seconds a connection may be idle
ENVELOPE: Final = "yarp-envelope"

_METHODS: Final = (b"GET /", b"POST /", b"HEAD /", b"OPTIONS ", b"PUT /", b"DELETE /", b"PATCH /")
_HTML: Final = "text/html; charset=utf-8"
_TEXT: Final = "text/plain; charset=utf-8"
_JSON: Final = "application/json"
_TYPES: Final = {"page": _HTML, "json": _JSON, "text": _TEXT, "events": "text/event-stream"}
_STREAMS: Final = {**_TYPES, "json": "application/x-ndjson"}
_REASONS: Final = {
    200: b"OK",
    204: b"No Content",
    400: b"Bad Request",
    403: b"Forbidden",
    404: b"Not Found",
    405: b"Method Not Allowed",
    413: b"Content Too Large",
    415: b"Unsupported Media Type",
    431: b"Request Header Fields Too Large",
    500: b"Internal Server Error",
    501: b"Not Implemented",
}
_COMMON: Final = [
    ("Cache-Control", "no-store"),
    ("X-Content-Type-Options", "nosniff"),
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


class Http(Carrier):
    """One connection of a browser, with any number of requests; or ours to another port."""

    name = "http"
    magic = b"GET /"
    spelling = "text"
    acks = True
    gathers = False
    patience = PATIENCE

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self.origins = origins_of(os.environ.get("YARPY_WEB_ORIGINS", "*"))
        self._h11: h11.Connection | None = None
        self._headers: Mapping[str, str] = {}
        self._head_only = False
        self._wish: Wish | None = None  # what is being answered
        self._taken = 0  # messages that were handed on, and those that are acknowledged
        self._acked = 0
        self._asked: deque[h11.Connection] = deque()  # our requests without a response
        self._confirmed = False  # the response to the last call was read with its reply
        self._streaming = False

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
        while stream.waiting < MAX_HEAD and not _complete(stream):
            yield from stream.more(stream.waiting + 1)

    def decode(self, stream: ByteStream) -> Steps[Message]:
        while not self.finished:
            if self._streaming:  # the reply to the last message has begun something endless
                self.holding = False
                return Message("r")
            if self._wish is not None:
                self._answer_nothing(stream)  # the next request waits already
                continue
            wish = yield from self._read_wish(stream)
            if self.successor is not None:
                return Message("r")
            if wish is None:
                continue
            self._taken += 1
            if wish.key == "r":
                self._begin_reading(stream, wish.form)
                return Message("r")
            self._wish = wish
            self.structured = wish.form == "json"
            return wish.message(_envelope(self._headers))
        return Message(QUIT)

    def _read_wish(self, stream: ByteStream) -> Steps[Wish | None]:
        """The next request, unless it is answered without the port."""
        import h11

        from yarpy.carriers.http_request import Request, page_asked, read_wish

        talk = self._h11 = h11.Connection(h11.SERVER, max_incomplete_event_size=MAX_HEAD)
        self._headers, self._head_only = {}, False
        try:
            head = yield from self._event(stream, talk)
            assert isinstance(head, h11.Request)
            self._headers = _headers(head)
            self._head_only = head.method == b"HEAD"
            announced = self._headers.get("content-length", "0")
            if int(announced) > MAX_BODY:
                yield from self._refuse(stream, 413, f"a body has at most {MAX_BODY} bytes")
                return None
            body = bytearray()
            while not isinstance(event := (yield from self._event(stream, talk)), h11.EndOfMessage):
                assert isinstance(event, h11.Data)
                body += event.data
                if len(body) > MAX_BODY:
                    yield from self._refuse(stream, 413, f"a body has at most {MAX_BODY} bytes")
                    return None
        except h11.RemoteProtocolError as error:
            yield from self._refuse(stream, error.error_status_hint, str(error))
            return None
        except LinkClosed:
            if self._headers:
                self._respond(stream, 400, _TEXT, b"the body is shorter than its length\n")
            raise
        rest, _ = talk.trailing_data
        stream.unread(len(rest))  # of the next request
        method = head.method.decode("ascii")
        if method == "OPTIONS":
            self._preflight(stream)
            return None
        if method not in ("GET", "HEAD", "POST"):
            self._respond(stream, 405, _TEXT, b"", [("Allow", "GET, HEAD, POST, OPTIONS")])
            return None
        target = head.target.decode("latin-1")
        request = Request(method, target, self._headers, bytes(body))
        if method == "GET" and target.startswith("/?action="):
            self._show_pictures(stream, target)
            return None
        asked = page_asked(request)
        guest = self.pages(*asked) if asked and self.pages is not None else None
        if guest is not None:
            frames = self._frames()
            policy = [("Content-Security-Policy", frames)] if frames else []
            self._respond(stream, guest.status, guest.kind, guest.to_bytes(), policy)
            return None
        return self._screened(stream, read_wish(request))

    def _show_pictures(self, stream: ByteStream, target: str) -> None:
        """A browser asks for MJPEG on a connection that it has used for a page before."""
        from yarpy.carriers.mjpeg import Mjpeg

        old = self.route
        self.successor = mjpeg = Mjpeg(Route("", old.target, "mjpeg", old.port, old.host))
        mjpeg.accepted = True
        mjpeg.begin(stream, target, "origin" in self._headers)

    def _screened(self, stream: ByteStream, wish: Wish | Refusal) -> Wish | None:
        """Answer what needs no port, or must not come to it."""
        from yarpy.carriers.http_request import Refusal

        if isinstance(wish, Refusal):
            text = f"{wish.text}\n" if wish.text else ""
            self._respond(stream, wish.status, wish.kind, _encoded(text))
            return None
        if wish.acts and not self.origins.admits(self._headers):
            self._respond(
                stream,
                403,
                _TEXT,
                b"the owner of this port lets only some pages act here (YARPY_WEB_ORIGINS)\n",
            )
            return None
        if self._head_only and (wish.acts or wish.key == "r"):
            # Asking for a head must change nothing, so there is no reply to tell the length of.
            self._respond(stream, 200, _TYPES.get(wish.form, _TEXT), None)
            return None
        return wish

    def _event(self, stream: ByteStream, talk: h11.Connection) -> Steps[Any]:
        import h11

        while (event := talk.next_event()) is h11.NEED_DATA:
            if talk.they_are_waiting_for_100_continue:
                go_on = h11.InformationalResponse(status_code=100, headers=[])
                stream.write(talk.send(go_on) or b"")
            yield from stream.more(1)
            talk.receive_data(bytes(stream.buffer[stream.head : stream.tail]))
            stream.head = stream.tail
        return event

    def _refuse(self, stream: ByteStream, status: int, text: str) -> Steps[None]:
        """Answer a request that cannot be read to its end; the connection is over."""
        self._respond(stream, status, _TEXT, _encoded(text + "\n"), [("Connection", "close")])
        self.finished = True
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

    # -- answering --------------------------------------------------------------------------------

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        wish = self._wish
        if wish is None:
            return  # nobody waits for it any more
        try:
            if wish.form == "json":
                self._respond(stream, 200, _JSON, _json_body(value, wish))
            elif wish.form == "none":
                self._respond(stream, 204, _TEXT, b"")
            elif self._show_guest(stream, value):
                pass
            elif wish.form == "page":
                self._show(stream, wish, _lines(value))
            else:
                self._respond(stream, 200, _TEXT, _text_body(value))
        except (TypeError, ValueError, YarpError):
            if self._wish is not None:
                self._respond(stream, 500, _TEXT, b"the port's answer cannot be sent\n")
            raise

    def encode_lines(self, stream: ByteStream, lines: list[str]) -> None:
        wish = self._wish
        if wish is None:
            return
        if wish.form == "page":
            self._show(stream, wish, lines)
        elif wish.form == "json":
            self._respond(stream, 200, _JSON, _json_body(["list", *lines], wish))
        else:
            self._respond(stream, 200, _TEXT, Lines(lines).to_text())

    def encode_ack(self, stream: ByteStream) -> None:
        """The response to a message that the port did not reply to."""
        self._acked += 1
        if self._wish is not None and self._acked >= self._taken:
            self._answer_nothing(stream)

    def encode_quit(self, stream: ByteStream) -> None:
        if self._streaming:
            self._end(stream)

    def _answer_nothing(self, stream: ByteStream) -> None:
        wish = self._wish
        assert wish is not None
        if wish.form == "json":
            self._respond(stream, 200, _JSON, b"[]\n")
        elif wish.form == "page":
            self._show(stream, wish, ["(no reply)"])
        else:
            self._respond(stream, 204, _TEXT, b"")

    def _show(self, stream: ByteStream, wish: Wish, lines: list[str]) -> None:
        from yarpy.carriers.http_page import page

        host = _hostname(self._headers.get("host", ""))
        body = page(self.route.target, lines, wish.shown, host)
        self._respond(stream, 200, _HTML, body, [self._policy()])

    def _policy(self) -> tuple[str, str]:
        """What browsers are told to refuse to the page; its form is not for others to frame."""
        frames = self._frames()
        return "Content-Security-Policy", _PAGE_POLICY + (f"; {frames}" if frames else "")

    def _frames(self) -> str:
        """Who may frame pages that may act: where only some may act, nobody else."""
        listed = self.origins.listed
        return "" if listed is None else " ".join(["frame-ancestors 'self'", *sorted(listed)])

    def _show_guest(self, stream: ByteStream, value: object) -> bool:
        """Answer with the page that a program put under the key `web`; False if there is none."""
        guest = Bottle(value).group("web") if isinstance(value, (list, tuple)) else None
        if guest is None or len(guest) < 2 or not isinstance(value, (list, tuple)):
            return False
        kind = Bottle(value).group("mime")
        mime = str(kind[1]) if kind is not None and len(kind) > 1 else _HTML
        if not (mime.isascii() and mime.isprintable()):
            return False
        body = _web_body(guest)
        if Bottle(value).group("stream") is None:
            self._respond(stream, 200, mime, body, [_GUEST_POLICY])
            return True
        self._wish = None
        self._begin_stream(stream, "guest", [_GUEST_POLICY, ("Content-Type", mime)])
        self._write_part(stream, b" " * _PRELUDE + body)  # as C++; some browsers need it
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
        self._respond(stream, 204, _TEXT, b"", headers)

    def _respond(
        self,
        stream: ByteStream,
        status: int,
        kind: str,
        body: bytes | None,
        extra: list[tuple[str, str]] | None = None,
    ) -> None:
        """Write a whole response. No body: only the head was asked for, and nobody knows it."""
        import h11

        self._wish = None
        talk = self._h11
        assert talk is not None
        headers = [*_COMMON, *(extra or ()), ("Access-Control-Allow-Origin", "*")]
        if status != 204:
            headers.append(("Content-Type", kind))
            if body is not None:
                headers.append(("Content-Length", str(len(body))))
        try:
            reason = _REASONS.get(status, b"")
            head = h11.Response(status_code=status, headers=headers, reason=reason)
            parts = [talk.send(head)]
            if body and not self._head_only:
                parts.append(talk.send(h11.Data(data=body)))
            parts.append(talk.send(h11.EndOfMessage()))
        except h11.LocalProtocolError as error:
            raise RemoteProtocolError(f"HTTP {status} cannot be said any more: {error}") from None
        stream.write(*(part for part in parts if part))
        if talk.our_state is not h11.DONE:
            self.finished = True

    # -- a reader ---------------------------------------------------------------------------------

    def _begin_reading(self, stream: ByteStream, form: Form) -> None:
        """Answer `/r`: everything that the port writes, from now on."""
        from yarpy.carriers.http_page import stream_head

        policy = [self._policy()] if form == "page" else []
        self._begin_stream(stream, form, [*policy, ("Content-Type", _STREAMS.get(form, _TEXT))])
        if form == "page":
            self._write_part(stream, stream_head(self.route.target))
        elif form == "events":
            self._write_part(stream, b": reading\n\n")

    def _begin_stream(self, stream: ByteStream, form: Form, headers: list[tuple[str, str]]) -> None:
        """The head of a response that does not end; the connection becomes an output."""
        import h11

        talk = self._h11
        assert talk is not None
        self._streaming, self._form = True, form
        self.acks, self.lossy, self.backlog = False, True, 16
        headers = [*_COMMON, *headers, ("Access-Control-Allow-Origin", "*")]
        head = h11.Response(status_code=200, headers=headers, reason=_REASONS[200])
        stream.write(talk.send(head) or b"")

    def prepare(self, packet: Packet) -> bool:
        if not self._streaming:
            return super().prepare(packet)
        self._part(packet)
        return True

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        if self._streaming:
            self._write_part(stream, self._part(packet))
        else:
            self._post(stream, packet)

    def _part(self, packet: Packet) -> bytes:
        """A packet as it appears in the stream; made once for all that read in this form."""
        key = (self.name, self._form)
        found = packet.forms.get(key)
        if found is None:
            found = packet.forms[key] = (_streamed(packet, self._form),)
        return bytes(found[0])

    def _write_part(self, stream: ByteStream, data: bytes) -> None:
        import h11

        assert self._h11 is not None
        stream.write(self._h11.send(h11.Data(data=data)) or b"")

    def _end(self, stream: ByteStream) -> None:
        import h11

        assert self._h11 is not None
        stream.write(self._h11.send(h11.EndOfMessage()) or b"")
        self._streaming = False

    # -- dialling ---------------------------------------------------------------------------------

    def greet(self, stream: ByteStream) -> Steps[None]:
        return
        yield

    def _post(self, stream: ByteStream, packet: Packet) -> None:
        import h11

        route = self.route
        host = f"[{route.host}]" if ":" in route.host else route.host or "yarp"
        path = (modifier(route.carrier, "path") or "form").lstrip("/")
        form = "none" if packet.key == DATA else "text"
        admin = "&admin=1" if packet.key == ADMIN else ""
        body = packet.line
        headers = [
            ("Host", f"{host}:{route.port}"),
            ("Content-Type", _TEXT),
            ("Content-Length", str(len(body))),
        ]
        if packet.envelope:
            headers.append((ENVELOPE, packet.envelope.decode("latin-1")))
        talk = h11.Connection(h11.CLIENT, max_incomplete_event_size=MAX_HEAD)
        request = h11.Request(
            method="POST", target=f"/{path}?format={form}{admin}", headers=headers
        )
        stream.write(talk.send(request) or b"")
        if body:
            stream.write(talk.send(h11.Data(data=body)) or b"")
        stream.write(talk.send(h11.EndOfMessage()) or b"")
        self._asked.append(talk)

    def expect_reply(self, stream: ByteStream) -> Steps[Message | None]:
        status, body = yield from self._response(stream)
        self._confirmed = True
        if status == 204:
            return None
        return Message(CALL, body.rstrip(b"\r\n"), spelling="text")

    def expect_ack(self, stream: ByteStream) -> Steps[None]:
        if self._confirmed:
            self._confirmed = False
        else:
            yield from self._response(stream)

    def _response(self, stream: ByteStream) -> Steps[tuple[int, bytes]]:
        """The response to the oldest of our requests."""
        import h11

        if not self._asked:
            raise RemoteProtocolError("a response came that nobody asked for")
        talk = self._asked.popleft()
        body = bytearray()
        limit = min(stream.limit, MAX_BODY)
        try:
            head = yield from self._event(stream, talk)
            while isinstance(head, h11.InformationalResponse):
                head = yield from self._event(stream, talk)
            while isinstance(event := (yield from self._event(stream, talk)), h11.Data):
                body += event.data
                if len(body) > limit:
                    raise RemoteProtocolError(f"a response of more than {limit} bytes")
        except h11.RemoteProtocolError as error:
            raise RemoteProtocolError(f"no HTTP response: {error}") from None
        if not (isinstance(head, h11.Response) and isinstance(event, h11.EndOfMessage)):
            raise LinkClosed("the peer closed the connection")
        rest, _ = talk.trailing_data
        stream.unread(len(rest))
        if not 200 <= head.status_code < 300:
            text = bytes(body[:200]).decode("utf-8", "replace").strip()
            raise RemoteProtocolError(f"HTTP {head.status_code}: {text}")
        return head.status_code, bytes(body)


class Origins:
    """Whose pages may act on a port. `listed` None: those of everybody."""

    def __init__(self, listed: frozenset[str] | None) -> None:
        self.listed = listed

    def admits(self, headers: Mapping[str, str]) -> bool:
        """Whether a request comes from such a page, from the port's own, or from no browser."""
        if self.listed is None:
            return True
        origin = headers.get("origin")
        if origin is None:
            referer = headers.get("referer", "")
            scheme, _, rest = referer.partition("://")
            origin = f"{scheme}://{rest.partition('/')[0]}" if rest else None
        if origin is not None:
            return origin in self.listed or _is_own(origin, headers.get("host", ""))
        site = headers.get("sec-fetch-site")
        if site is not None:
            return site in ("same-origin", "none")
        # A browser that tells nothing may have been told to by the page.
        return "mozilla/" not in headers.get("user-agent", "").lower()


def origins_of(text: str) -> Origins:
    """What YARPY_WEB_ORIGINS says: `*`, or origins between blanks; `none` is none."""
    words = text.replace(",", " ").split()
    if "*" in words:
        return Origins(None)
    return Origins(frozenset(word.rstrip("/").lower() for word in words if word != "none"))


def _is_own(origin: str, host: str) -> bool:
    """Whether a page is of the port itself. A name that somebody else gave this computer does not
    count: it may be theirs today and ours tomorrow."""
    name = _hostname(host)
    known = name.startswith("[") or "." not in name or name.replace(".", "").isdigit()
    return origin.lower() == f"http://{host.lower()}" and (known or name.endswith(".local"))


def _hostname(host: str) -> str:
    """The name in a Host header, without the port number."""
    if host.startswith("["):
        return host.partition("]")[0] + "]"
    return host.partition(":")[0]


def _complete(stream: ByteStream) -> bool:
    """Whether the head of a request has come."""
    buffer, head, tail = stream.buffer, stream.head, stream.tail
    return buffer.find(b"\n\r\n", head, tail) >= 0 or buffer.find(b"\n\n", head, tail) >= 0


def _headers(head: h11.Request) -> dict[str, str]:
    found: dict[str, str] = {}
    for name, value in head.headers:
        found[name.decode("ascii")] = value.decode("latin-1")
    return found


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


def _streamed(packet: Packet, form: Form) -> bytes:
    """One message of a stream."""
    if form in ("events", "json"):
        from yarpy.data.json import to_json

        text = to_json(packet.value).encode()
        if form == "json":
            return text + b"\n"
        mark = b"id: " + packet.envelope + b"\n" if packet.envelope else b""
        return mark + b"data: " + text + b"\n\n"
    if form == "page":
        from yarpy.carriers.http_page import stream_line

        return stream_line(packet.line.decode("utf-8", "surrogateescape"))
    if form == "guest":
        value = packet.value
        guest = Bottle(value).group("web") if isinstance(value, (list, tuple)) else None
        if guest is not None and len(guest) > 1:
            return _web_body(guest)
    return packet.line + b"\r\n"


def _web_body(guest: Bottle) -> bytes:
    """What a program put under the key `web`."""
    return guest[1] if isinstance(guest[1], bytes) else _encoded(str(guest[1]))


def _encoded(text: str) -> bytes:
    return text.encode("utf-8", "replace")
