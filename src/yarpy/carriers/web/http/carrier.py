"""http: browsers, curl and other programs talk to a port in HTTP/1.1, on the port's own TCP port.

    GET /?req=get+encs              a message; its reply as JSON
    POST /form                      the same from a form, as JSON or as text
    GET /                           the page of the port
    GET /r                          every message that the port writes, until the client hangs up
    GET /r  Accept: text/event-stream          the same for JavaScript's EventSource

Rules: `exchange` reads a request from the stream, `request` what it means, `response` makes the
answer, `origin` says who may act. Every request gets exactly one response, even if the port does
not reply (204, or `[]` in JSON). A slow consumer misses messages. Between ports each message is a
POST and its response the acknowledgement (`client`).
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

from yarpy import registry
from yarpy.carriers.base import OVER_TCP, Carrier, Delivery, Limits
from yarpy.carriers.web.http.client import HttpClient
from yarpy.carriers.web.http.exchange import TIME, Exchange, whole_head
from yarpy.carriers.web.http.message import LAST_CHUNK, chunk
from yarpy.carriers.web.http.origin import may_not_act, origins_of
from yarpy.carriers.web.http.page import Pieces
from yarpy.carriers.web.http.response import (
    LATE,
    NO_SUCH_METHOD,
    UNSPEAKABLE,
    Responder,
    Response,
    bare,
    complaint,
    refused,
    sent_on,
)
from yarpy.carriers.web.http.token import claim, cookie
from yarpy.carriers.web.upgrade import offered_subprotocols
from yarpy.errors import LinkClosed, Timeout, YarpError
from yarpy.facts import MAGIC_SIZE, Reach
from yarpy.route import Route
from yarpy.wire.effects import HEAR, Flush, May, Show
from yarpy.wire.message import CALL, QUIT, Lines, Message, Packet, Refused
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

if TYPE_CHECKING:
    from yarpy.carriers.web.http.intent import Form, Intent, Request

_RIGHTS: Final = ("read", "write", "administer", "attach", "register")
_METHODS: Final = (b"GET /", b"POST /", b"HEAD /", b"OPTIONS ", b"PUT /", b"DELETE /", b"PATCH /")


class Http(Carrier):
    """One connection of a browser, with any number of requests; or ours to another port."""

    name = "http"
    words = ("path.PATH", *OVER_TCP)
    magic = b"GET /"
    spelling = "text"
    acks = True
    # To C++ YARP, http is for browsers: such a connection is made, and carries nothing.
    reaches = Reach(
        "server", cpp="which exchanges nothing with other ports over http: use tcp", page=True
    )
    delivery = Delivery(coalesces=False)
    limits = Limits(idle_timeout=TIME)

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self.origins = origins_of()
        self._responder = Responder(route, self.origins)
        self._exchange = Exchange()  # the request that is being read or answered
        self._finished = False  # the last response is complete
        self._intent: Intent | None = None  # what is being answered
        self._taken = 0  # messages handed to the port, and those acknowledged
        self._acked = 0
        self._streaming = False
        self._form: Form = "text"  # of what is streamed
        self._pixels = False
        self._client = HttpClient(route)
        self._confirmed = False  # reading the last reply was also the acknowledgement

    @classmethod
    def recognises(cls, first: bytes) -> int:
        if first == b"POST /RP":
            return 0  # XML-RPC
        if first == b"POST /fo":
            return MAGIC_SIZE
        return next((len(method) for method in _METHODS if first.startswith(method)), 0)

    # -- reading requests -------------------------------------------------------------------------

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[Carrier | None]:
        """Wait for the head of the first request, within the time limit of a greeting. One for a
        WebSocket in which another carrier comes is the carrier `websocket`'s."""
        self.route.source = "web"
        stream.unread(len(first))
        try:
            yield from whole_head(stream)
        except Timeout:
            self._respond(stream, LATE)
            raise
        if registry.carriers.subprotocol(offered_subprotocols(stream)) is None:
            return None
        stream.head += len(first)
        websocket: Carrier = registry.carriers.load("websocket")(self.route)
        return websocket

    def decode(self, stream: ByteStream) -> Steps[Message]:
        while not self._finished:
            if self._streaming:  # the reply to the last message began an endless response
                return Message("r")
            if self._intent is not None:
                self._answer_nothing(stream)  # the next request is already waiting
                continue
            self._exchange = Exchange()
            self._finished = True  # if it cannot be read to its end
            request = yield from self._exchange.read(stream)
            self._finished = False
            intent = yield from self._understood(stream, request)
            if isinstance(intent, Carrier):
                return Message("r", intent)
            if intent is None:
                continue
            self._taken += 1
            if intent.key == "r":
                self._begin_reading(stream, intent)
                return Message("r")
            self._intent = intent
            return intent.message(self._exchange.envelope)
        return Message(QUIT)

    def _understood(self, stream: ByteStream, request: Request) -> Steps[Intent | Carrier | None]:
        """Return what the request asks of the port; None if it was answered without the port; a
        carrier if that one takes over."""
        from yarpy.carriers.web.http.intent import Refusal
        from yarpy.carriers.web.http.request import MAY, likes, page_asked, read_intent

        headers = self._exchange.headers
        refusal = self.origins.refusal(headers, self.route.host, self._secure)
        if refusal is not None:
            self._respond(stream, complaint(*refusal))
            return None
        shown = yield from claim(request.target, headers)
        if shown.refusal:
            self._respond(stream, complaint(403, shown.refusal))
            return None
        if shown.token and request.method == "GET" and likes(request, "text/html"):
            self._respond(stream, sent_on(shown.target, cookie(shown.token, self._secure)))
            return None
        request = replace(request, target=shown.target)
        if request.method == "OPTIONS":
            self._respond(stream, self._responder.preflight(headers))
            return None
        if request.method not in ("GET", "HEAD", "POST"):
            self._respond(stream, NO_SUCH_METHOD)
            return None
        if request.method == "GET" and request.target.startswith("/?action="):
            if why := (yield May(HEAR)):
                self._respond(stream, complaint(403, why))
                return None
            return self._show_pictures(stream, request.target)
        if request.target == MAY:
            self._respond(stream, self._responder.rights((yield from _rights())))
            return None
        asked = page_asked(request)
        if asked and (yield May("read", asking=True)):
            asked = None  # pages show what the program knows
        page = (yield Show(*asked)) if asked else None
        if page is not None:
            if not self.origins.shows(headers, self._secure):
                self._respond(stream, complaint(403, may_not_act(self.origins, headers)))
                return None
            response = self._responder.shown(page, headers)
            self._respond(stream, response)
            if isinstance(response.body, Pieces) and not self._exchange.head_only:
                yield from _send(stream, response.body)
            return None
        intent = read_intent(request)
        if isinstance(intent, Refusal):
            self._respond(stream, refused(intent))
            return None
        if why := (yield May(intent.right)):
            self._respond(stream, complaint(403, why))
            return None
        self._responder.may_write = not (yield May("write", asking=True))
        return self._screened(stream, intent)

    def _screened(self, stream: ByteStream, intent: Intent) -> Intent | None:
        """The intent, unless it must not reach the port."""
        headers = self._exchange.headers
        if intent.acts and not self.origins.admits(headers, self._secure, intent.asks):
            self._respond(stream, complaint(403, may_not_act(self.origins, headers)))
        elif self._exchange.head_only and (intent.acts or intent.key == "r"):
            # HEAD must change nothing, so there is no reply whose length could be given.
            self._respond(stream, bare(intent))
        elif (intent.key, intent.form) == ("r", "page"):
            self._respond(stream, self._responder.reader())
        else:
            return intent
        return None

    # -- answering --------------------------------------------------------------------------------

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        intent = self._intent
        if intent is None:
            return  # nobody is waiting for it any more
        try:
            if isinstance(value, Refused) and intent.content is None:
                response = complaint(value.status, value.why)
            else:
                response = self._responder.reply(intent, value, self._exchange.host)
            if response.endless:
                self._intent = None
                self._begin_stream(stream, "reply_page", response)
            else:
                self._respond(stream, response)
        except (TypeError, ValueError, YarpError):
            if self._intent is not None:
                self._respond(stream, UNSPEAKABLE)
            raise

    def encode_lines(self, stream: ByteStream, lines: list[str]) -> None:
        if self._intent is not None:
            said = self._responder.said(self._intent, Lines(lines), self._exchange.host)
            self._respond(stream, said)

    def encode_ack(self, stream: ByteStream, count: int) -> None:
        """The response to a message that the port did not reply to."""
        self._acked += count
        if self._intent is not None and self._acked >= self._taken:
            self._answer_nothing(stream)

    def encode_quit(self, stream: ByteStream) -> None:
        if self._streaming and self._exchange.modern:
            stream.write(LAST_CHUNK)
        self._streaming = False

    def _answer_nothing(self, stream: ByteStream) -> None:
        assert self._intent is not None
        self._respond(stream, self._responder.nothing(self._intent, self._exchange.host))

    @property
    def _secure(self) -> bool:
        """Return whether the browser uses TLS."""
        return "tls" in self.route.spec.tokens

    def _respond(self, stream: ByteStream, response: Response) -> None:
        """Write a whole response."""
        self._intent = None
        self._finished = not self._exchange.stays
        self._exchange.respond(stream, response)

    # -- a reader ---------------------------------------------------------------------------------

    def _begin_reading(self, stream: ByteStream, intent: Intent) -> None:
        """Answer `/r`: everything that the port writes, from now on."""
        self._pixels = intent.pixels
        interval = 1 / intent.rate if intent.rate else 0.0
        self._begin_stream(stream, intent.form, self._responder.reading(intent), interval)

    def _begin_stream(
        self, stream: ByteStream, form: Form, response: Response, interval: float = 0.0
    ) -> None:
        """The beginning of a response that does not end; the connection becomes an output."""
        self._streaming, self._form = True, form
        self.acks = False
        self.delivery = Delivery(lossy=True, backlog=16, interval=interval, coalesces=False)
        way = ("Transfer-Encoding", "chunked") if self._exchange.modern else ("Connection", "close")
        stream.write(response.head(way))
        if isinstance(response.body, bytes) and response.body:
            self._write_part(stream, response.body)

    def _show_pictures(self, stream: ByteStream, target: str) -> Carrier | None:
        """A browser asks for MJPEG on a connection that it has used for a page before."""
        from yarpy.carriers.web.mjpeg import Mjpeg, read_stream_options

        try:
            options = read_stream_options(target)
        except ValueError as error:
            self._respond(stream, complaint(400, str(error)))
            return None
        old = self.route
        mjpeg = Mjpeg(Route("", old.target, old.spec.over("mjpeg"), old.port, old.host))
        mjpeg.begin(stream, options, self._exchange.headers)
        return mjpeg

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
        from yarpy.carriers.web.http.stream import part

        return part(packet, self._form, self._pixels)

    def _write_part(self, stream: ByteStream, data: bytes) -> None:
        stream.write(chunk(data) if self._exchange.modern else data)

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


def _send(stream: ByteStream, body: Pieces) -> Steps[None]:
    """Write a body piece by piece, as many bytes as its head has promised."""
    left = body.size
    for piece in body.read():
        stream.write(piece[:left])
        left -= len(piece[:left])
        yield Flush()
        if not left:
            return
    if left:  # the client would take what comes next for the rest
        raise LinkClosed(f"the page is {left} bytes shorter than it was when it was asked for")


def _rights() -> Steps[list[str]]:
    """Return the rights of the peer, for pages that show them."""
    found = []
    for right in _RIGHTS:
        if not (yield May(HEAR if right == "read" else right, asking=True)):
            found.append(right)
    return found
