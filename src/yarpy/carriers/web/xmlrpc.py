"""xmlrpc: ports as XML-RPC servers and clients, over HTTP.

    xmlrpc.client.ServerProxy("http://host:port/RPC2").get("encs")        get encs

Rules: each message is a POST, its reply the response; without a reply the response is an empty
string. (A C++ port whose reader does not reply sends no response: a message waits for the response
to the previous one, with a timeout.) What nodes of a graph call each other with (`graphs` of the
registry) goes to the administration and ends the connection. Anything that is not XML-RPC is
answered with a fault, a request that is too slow with a status. A POST to `/` belongs here if its
body is XML, else to http. Values are encoded by `yarpy.data.xmlrpc`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from yarpy.carriers.base import OVER_TCP, Carrier, Delivery, Limits
from yarpy.carriers.web.http.header import read_headers
from yarpy.carriers.web.http.message import CONTINUE, next_event
from yarpy.carriers.web.http.refusal import refuse, screen, screen_page
from yarpy.data import codec, xmlrpc
from yarpy.data.bottle import Bottle
from yarpy.errors import (
    AccessRefused,
    DecodeError,
    LinkClosed,
    LocalProtocolError,
    RemoteProtocolError,
    Timeout,
)
from yarpy.facts import MAGIC_SIZE, Reach
from yarpy.limit import HTTP_BODY, HTTP_HEAD, HTTP_LINE
from yarpy.registry import graphs
from yarpy.route import Route
from yarpy.wire.effects import May, Within
from yarpy.wire.message import ADMIN, CALL, QUIT, Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

if TYPE_CHECKING:
    import h11

TIME: Final = 60.0  # seconds for a call from its first byte to its last
NOT_UNDERSTOOD: Final = -32700  # the fault for a body that is not XML-RPC

_RESPONSE: Final = (
    "HTTP/1.1 {status}\r\nServer: XMLRPC++ 0.7\r\nContent-Type: text/xml\r\n"
    "Content-length: {size}\r\n\r\n"
)


class XmlRpc(Carrier):
    """Calls from any XML-RPC client, or ours to any XML-RPC server."""

    name = "xmlrpc"
    words = ("path.PATH", *OVER_TCP)
    magic = b"POST /RP"
    acks = True
    reaches = Reach("server", page=True)
    delivery = Delivery(coalesces=False)
    limits = Limits(ack_timeout=5.0)

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self._terse = False  # the call is one of nodes
        declared = route.declared
        self._is_node = bool(declared.node) and not declared.topic  # it answers nothing else
        self._finished = False  # the dialogue is complete
        self._last = False  # the peer wants no more calls on this connection
        self._owed = False  # a call is waiting for its response
        self._confirmed = False  # reading the reply was also the acknowledgement

    @classmethod
    def recognises(cls, first: bytes) -> int:
        if first == cls.magic:
            return MAGIC_SIZE
        return MAGIC_SIZE - 1 if first == b"POST / H" else 0

    # -- the server -------------------------------------------------------------------------------

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[Carrier | None]:
        self.route.source = "rpc"
        stream.unread(len(first))
        if first == self.magic:
            return None
        while not (head := _head(stream)) and stream.waiting < HTTP_HEAD:
            yield from stream.more(stream.waiting + 1)
        if not _brings_xml(head):
            from yarpy.carriers.web.http.carrier import Http

            stream.head += len(first)
            route = self.route
            return Http(Route("", route.target, route.spec.over(Http.name), route.port, route.host))
        return None

    def decode(self, stream: ByteStream) -> Steps[Message]:
        while not self._finished:
            yield from stream.more(1)
            if stream.buffer[stream.head] in b"\r\n":
                stream.head += 1
                stream.pause()
                continue  # between two calls
            yield Within(TIME)
            try:
                body = yield from self._read_body(stream)
            except Timeout:
                stream.write(_RESPONSE.format(status="408 Request Timeout", size=0).encode())
                self._finished = True
                raise
            yield Within(None)
            try:
                call = xmlrpc.decode_call(memoryview(body))
            except DecodeError as error:
                self._respond(stream, xmlrpc.encode_fault(NOT_UNDERSTOOD, str(error)))
                continue
            name = call[0] if call else ""
            self._terse = isinstance(name, str) and (self._is_node or _of_nodes(name))
            key = ADMIN if self._terse else CALL
            if key == CALL and (why := (yield May("write"))):
                yield from refuse(stream, 403, why, error=AccessRefused)
            self._owed = True
            return Message(key, b"".join(map(bytes, codec.encode(call))))
        return Message(QUIT)

    def _read_body(self, stream: ByteStream) -> Steps[bytearray]:
        """The body of a call; h11 parses and checks its head."""
        import h11

        talk = h11.Connection(h11.SERVER, max_incomplete_event_size=HTTP_HEAD)
        body = bytearray()
        try:
            head = yield from next_event(stream, talk)
            if not isinstance(head, h11.Request):
                raise LinkClosed("the peer closed the connection")
            yield from self._judge(stream, head, min(HTTP_BODY, stream.limit))
            if talk.they_are_waiting_for_100_continue:
                stream.write(CONTINUE)
            while isinstance(event := (yield from next_event(stream, talk)), h11.Data):
                body += event.data
        except h11.RemoteProtocolError as error:
            yield from refuse(stream, error.error_status_hint, str(error))
        rest, _ = talk.trailing_data
        stream.unread(len(rest))  # of the next call
        return body

    def _judge(self, stream: ByteStream, head: h11.Request, most: int) -> Steps[None]:
        """Continue only with an allowed call of at most `most` bytes."""
        headers = {key.decode("ascii"): value.decode("latin-1") for key, value in head.headers}
        connection = headers.get("connection", "").lower()
        self._last = "close" in connection or (
            head.http_version == b"1.0" and "keep-alive" not in connection
        )
        if head.method != b"POST":
            yield from refuse(stream, 405, "an XML-RPC call is a POST", [("Allow", "POST")])
        size = headers.get("content-length", "")
        if not size or "transfer-encoding" in headers:
            yield from refuse(stream, 411, "an XML-RPC call needs a Content-Length, not chunks")
        if int(size) > most:
            text = f"an XML-RPC call has at most {most} bytes"
            yield from refuse(stream, 413, text)
        yield from screen_page(stream, headers, self.route, acts=True)
        # What the call itself needs shows in its body.
        target = head.target.decode("latin-1")
        yield from screen(stream, target, headers, "ask")

    def _respond(self, stream: ByteStream, body: bytes) -> None:
        stream.write(_RESPONSE.format(status="200 OK", size=len(body)).encode() + body)
        self._owed = False
        if self._last or self._terse:
            self._finished = True

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        self._respond(stream, xmlrpc.encode_answer(value, self._terse))

    def encode_ack(self, stream: ByteStream, count: int) -> None:
        if self._owed:
            self._respond(stream, xmlrpc.encode_nothing())

    # -- the client -------------------------------------------------------------------------------

    def greet(self, stream: ByteStream) -> Steps[None]:
        self._request(0)  # refuses an impossible path
        return
        yield

    def _request(self, size: int) -> bytes:
        route = self.route
        path = route.spec.value("path")
        path = "/RPC2" if path is None else "/" + path.removeprefix("/")
        if not path.isprintable() or " " in path:
            raise LocalProtocolError(f"the path {path!r} contains blanks: write %20 for each")
        host = f"[{route.host}]" if ":" in route.host else route.host
        return (
            f"POST {path} HTTP/1.1\r\nUser-Agent: yarpy\r\nHost: {host}:{route.port}\r\n"
            f"Content-Type: text/xml\r\nContent-length: {size}\r\n\r\n"
        ).encode()

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        key = (self.name,)
        if key not in packet.forms:
            packet.forms[key] = (xmlrpc.encode_call(packet.value),)
        self.post(stream, bytes(packet.forms[key][0]))

    def post(self, stream: ByteStream, body: bytes) -> None:
        """Write a call."""
        stream.write(self._request(len(body)) + body)

    def encode_quit(self, stream: ByteStream) -> None:
        """Only closing ends the dialogue."""

    def expect_reply(self, stream: ByteStream) -> Steps[Message | None]:
        body = yield from self.read_response(stream)
        try:
            value = xmlrpc.decode_answer(body)
        except DecodeError as error:
            raise RemoteProtocolError(str(error)) from error
        self._confirmed = True
        if value is None:
            return None
        return Message(CALL, b"".join(map(bytes, codec.encode(Bottle(value)))))

    def expect_ack(self, stream: ByteStream) -> Steps[None]:
        if self._confirmed:
            self._confirmed = False
        else:
            yield from self.read_response(stream)

    def read_response(self, stream: ByteStream) -> Steps[bytes | memoryview]:
        """The body of an answer. Raises RemoteProtocolError."""
        line = yield from stream.read_line(HTTP_LINE)
        headers = yield from read_headers(stream)
        size = headers.get("content-length", "")
        if line.split()[1:2] != [b"200"]:
            text = line[:80].decode("utf-8", "replace")
            raise RemoteProtocolError(f'the XML-RPC server answers "{text}"')
        if not (size.isascii() and size.isdigit()):
            raise RemoteProtocolError("the XML-RPC server's answer has no Content-Length")
        if len(size) > 9 or int(size) > min(HTTP_BODY, stream.limit):
            raise RemoteProtocolError(f"an answer of more than {HTTP_BODY} bytes")
        return (yield from stream.read_exact(int(size)))


def _of_nodes(name: str) -> bool:
    """Return whether nodes of a graph call any port by that name."""
    found = graphs.call(name)
    return found is not None and found[1].everywhere and found[1].name == name


def _head(stream: ByteStream) -> bytes:
    """The head of the request, once it is complete."""
    data = bytes(stream.buffer[stream.head : stream.tail])
    for end in (b"\r\n\r\n", b"\n\n"):
        head, found, _ = data.partition(end)
        if found:
            return head
    return b""


def _brings_xml(head: bytes) -> bool:
    """Return whether the body will be XML; a browser that accepts XML does not send any."""
    lines = (line.partition(b":") for line in head.lower().split(b"\n"))
    return any(name.strip() == b"content-type" and b"xml" in value for name, _, value in lines)
