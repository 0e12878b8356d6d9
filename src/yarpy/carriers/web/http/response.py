"""HTTP responses of a port to a browser: replies, lines, pages and refusals.

    json     [1, 2] LF            no reply: []
    text     1 2 CR LF            no reply: 204
    none     204
    page     the port's page with the reply on it (`port_page`)
    web      a page that a program put into its reply, isolated from the port's own

Rules: a reply goes in, a Response comes out; `carrier` writes it. Each response forbids caching and
type sniffing. What the port says may be read by any page, what its program shows only by those that
`origin` admits.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from yarpy.carriers.own.text import reply_text
from yarpy.carriers.web.http.client import ENVELOPE
from yarpy.carriers.web.http.message import HTML, JSON, TEXT, Headers, response_head
from yarpy.carriers.web.http.origin import Origins, hostname
from yarpy.carriers.web.http.token import REFERRER
from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.route import Route
from yarpy.wire.message import Lines

if TYPE_CHECKING:
    from yarpy.carriers.web.http.intent import Intent, Refusal
    from yarpy.carriers.web.http.page import Page, Pieces

PRELUDE: Final = 2048  # blanks at the start of an endless page, as in C++, because browsers buffer

_COMMON: Final = [
    ("Cache-Control", "no-store"),
    ("X-Content-Type-Options", "nosniff"),
    REFERRER,
]
_FOR_ALL: Final = ("Access-Control-Allow-Origin", "*")
_FOR_ITS_OWN: Final = ("Cross-Origin-Resource-Policy", "same-origin")
_TYPES: Final = {"page": HTML, "json": JSON, "text": TEXT, "events": "text/event-stream"}
_ALLOW: Final = ("Allow", "GET, HEAD, POST, OPTIONS")
# Our own page needs nothing from elsewhere; nothing that came in a message can run in it.
_PAGE_POLICY: Final = (
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
    "img-src 'self' blob:; form-action 'self'; base-uri 'none'"
)
# A page from a reply: its scripts run, but not with the rights of the port's own pages.
_REPLY_PAGE_POLICY: Final = (
    "Content-Security-Policy",
    "sandbox allow-scripts allow-forms allow-popups",
)


@dataclass(frozen=True, slots=True)
class Response:
    """Status, type, body and further headers.

    body None: only the head was requested, and the rest is unknown. endless: the body is only the
    beginning, messages follow. Pieces: `sent` writes them after the head. reader: the origin whose
    pages may read it too, * for all, "" for none.
    """

    status: int
    kind: str = TEXT
    body: bytes | Pieces | None = b""
    more: Headers = ()
    endless: bool = False
    reader: str = "*"

    def head(self, *last: tuple[str, str]) -> bytes:
        """The head, with `last` after its headers. Raises LocalProtocolError, as
        `response_head`."""
        headers = [*_COMMON, *_readers(self.reader), *self.more]
        if self.status != 204:
            headers.append(("Content-Type", self.kind))
            if self.body is not None and not self.endless:
                headers.append(("Content-Length", str(len(self.body))))
        headers += last
        return response_head(self.status, headers)


LATE: Final = Response(408, body=b"the request takes too long to arrive\n")
CUT_OFF: Final = Response(400, body=b"the body is shorter than its Content-Length\n")
NO_SUCH_METHOD: Final = Response(
    405,
    body=b"a port supports GET, HEAD, POST and OPTIONS; post messages to /form\n",
    more=[_ALLOW],
)
UNSPEAKABLE: Final = Response(500, body=b"the port's answer cannot be sent\n")


def _readers(origin: str) -> Headers:
    """The headers that say whose pages may read a response."""
    if origin == "*":
        return (_FOR_ALL,)
    if not origin:
        return (_FOR_ITS_OWN,)
    return (("Access-Control-Allow-Origin", origin), ("Vary", "Origin"))


def complaint(status: int, text: str) -> Response:
    """A one-line response that says what is wrong."""
    return Response(status, body=_encoded(text + "\n"))


def refused(refusal: Refusal) -> Response:
    """An answer that does not involve the port."""
    text = f"{refusal.text}\n" if refusal.text else ""
    return Response(refusal.status, refusal.kind, _encoded(text))


def sent_on(target: str, *more: tuple[str, str]) -> Response:
    """Another address of the same port, where the browser goes on."""
    if not target.startswith("/") or target.startswith(("//", "/\\")):
        target = "/"  # that would be another computer
    return Response(303, more=[("Location", target), *more])


def bare(intent: Intent) -> Response:
    """The head of the answer, without its body."""
    return Response(200, _TYPES.get(intent.form, TEXT), None)


class Responder:
    """The answers of the port at the end of `route`; `origins`: which pages may act.

    host: the browser's name for this computer, its Host header.
    """

    def __init__(self, route: Route, origins: Origins) -> None:
        self.route = route
        self.origins = origins
        self.may_write = True  # whoever asks

    def reply(self, intent: Intent, value: object, host: str) -> Response:
        """The port's reply; an endless one if a program's page wants to continue."""
        if intent.content is not None:
            return Response(200, intent.content.kind, intent.content.reply(value))
        if intent.form == "none":
            return Response(204)
        page = _reply_page(value) if intent.form != "json" else None
        return page or self.said(intent, value, host)

    def said(self, intent: Intent, value: object, host: str) -> Response:
        """A value or lines in the requested form."""
        if intent.form == "json":
            return Response(200, JSON, _json_body(value, intent))
        if intent.form == "page":
            return self._page(intent, _lines(value), host)
        return Response(200, TEXT, reply_text(value))

    def nothing(self, intent: Intent, host: str) -> Response:
        """The answer to a message that the port did not reply to."""
        if intent.content is not None:
            return Response(200, intent.content.kind, intent.content.reply(None))
        if intent.form == "json":
            return Response(200, JSON, b"[]\n")
        return self._page(intent, ["(no reply)"], host) if intent.form == "page" else Response(204)

    def reading(self, intent: Intent) -> Response:
        """The beginning of everything that the port writes from now on."""
        from yarpy.carriers.web.http.stream import KINDS

        body = b": reading\n\n" if intent.form == "events" else b""
        return Response(200, KINDS[intent.form], body, endless=True)

    def reader(self) -> Response:
        """The page that shows what the port writes, message by message."""
        from yarpy.carriers.web.http.port_page import reader

        return Response(200, HTML, reader(self.route.target), [self._policy()])

    def shown(self, page: Page, headers: Mapping[str, str]) -> Response:
        """A page that the port's program serves beside those of the port."""
        framing = self.origins.framing
        policy = [("Content-Security-Policy", framing)] if framing else []
        reader = self.origins.reader_of(headers)
        return Response(page.status, page.kind, page.encoded(), policy, reader=reader)

    def rights(self, found: list[str]) -> Response:
        """Return the response that lists the rights of the client."""
        from yarpy.data.json import to_json

        return Response(200, JSON, (to_json(found) + "\n").encode())

    def preflight(self, headers: Mapping[str, str]) -> Response:
        """Return the response to a CORS preflight: what a page may do here, asked by its browser
        beforehand."""
        acting = ", POST" if self.origins.admits(headers, self._secure) else ""
        allowed = [
            _ALLOW,
            ("Access-Control-Allow-Methods", f"GET, HEAD{acting}"),
            ("Access-Control-Allow-Headers", f"Content-Type, {ENVELOPE.title()}"),
            ("Access-Control-Max-Age", "600"),
        ]
        return Response(204, more=allowed)

    def _page(self, intent: Intent, lines: list[str], host: str) -> Response:
        from yarpy.carriers.web.http.port_page import Browsed, page

        browsed = Browsed(hostname(host), self._secure, self.may_write)
        body = page(self.route.target, lines, intent.shown, browsed)
        return Response(200, HTML, body, [self._policy()])

    @property
    def _secure(self) -> bool:
        """Return whether the browser uses TLS."""
        return "tls" in self.route.spec.tokens

    def _policy(self) -> tuple[str, str]:
        """Return the header that says what browsers must not let the page do; no other site may
        frame its form."""
        framing = self.origins.framing
        return "Content-Security-Policy", _PAGE_POLICY + (f"; {framing}" if framing else "")


def _reply_page(value: object) -> Response | None:
    """The page that a program put under the key `web`; None if there is none."""
    from yarpy.carriers.web.http.stream import web_of

    if not isinstance(value, (list, tuple)):
        return None
    body = web_of(value)
    if body is None:
        return None
    mime = Bottle(value).group("mime")
    kind = str(mime[1]) if mime is not None and len(mime) > 1 else HTML
    if not (kind.isascii() and kind.isprintable()):
        return None
    if Bottle(value).group("stream") is None:
        return Response(200, kind, body, [_REPLY_PAGE_POLICY])
    return Response(200, kind, b" " * PRELUDE + body, [_REPLY_PAGE_POLICY], endless=True)


def _json_body(value: object, intent: Intent) -> bytes:
    from yarpy.data.json import to_json

    if isinstance(value, Lines):
        value = ["list", *value]
    return (to_json(value, intent.outer) + "\n").encode()


def _lines(value: object) -> list[str]:
    """A reply as lines on a page."""
    if isinstance(value, Lines):
        return list(value)
    return [codec.encode_text(value).decode("utf-8", "surrogateescape")]


def _encoded(text: str) -> bytes:
    return text.encode("utf-8", "replace")
