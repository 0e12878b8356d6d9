"""xmlrpc: ports as XML-RPC servers and clients, over HTTP.

    xmlrpc.client.ServerProxy("http://host:port/RPC2").get("encs")        get encs

Rules: each message is a POST, its reply the response; also a port that says nothing responds, with
an empty string. The questions of ROS nodes (`getPid`, `requestTopic`, `getBusInfo`,
`publisherUpdate`) go to the administration, and the connection ends after them. What is not
XML-RPC is answered with a fault, what comes too slowly with a status. A POST to `/` belongs here if
it brings XML, else to http.
How values are spelled: `yarpy.data.xmlrpc`.
"""

from __future__ import annotations

from typing import Final

from yarpy.carriers.base import MAGIC_SIZE, Carrier
from yarpy.carriers.http.header import MAX_LINE, read_headers
from yarpy.data import codec, xmlrpc
from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError, LinkClosed, LocalProtocolError, RemoteProtocolError, Timeout
from yarpy.route import Route
from yarpy.wire.effects import Steps
from yarpy.wire.message import ADMIN, CALL, Message, Packet
from yarpy.wire.stream import ByteStream

MAX_BODY: Final = 1 << 24
DRAIN: Final = 1 << 26  # bytes of a refused body that are read
MAX_HEAD: Final = 1 << 14
NOT_UNDERSTOOD: Final = -32700  # the fault of a body that is no XML-RPC
ROS: Final = frozenset(("publisherUpdate", "requestTopic", "getPid", "getBusInfo"))

_RESPONSE: Final = (
    "HTTP/1.1 {status}\r\nServer: XMLRPC++ 0.7\r\nContent-Type: text/xml\r\n"
    "Content-length: {size}\r\n\r\n"
)


class XmlRpc(Carrier):
    """Calls from any XML-RPC client, or ours to any XML-RPC server."""

    name = "xmlrpc"
    magic = b"POST /RP"
    acks = True
    foreign = True
    gathers = False
    hurry = 60.0

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self._terse = False  # the call came from a ROS node
        self._last = False  # the peer wants no more calls on this connection
        self._owed = False  # a call waits for its response
        self._confirmed = False  # the response to our call was read with its reply

    @classmethod
    def recognises(cls, first: bytes) -> int:
        if first == cls.magic:
            return MAGIC_SIZE
        return MAGIC_SIZE - 1 if first == b"POST / H" else 0

    # -- the server -------------------------------------------------------------------------------

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[None]:
        self.route.source = "rpc"
        stream.unread(len(first))
        if first == self.magic:
            return
        while not (head := _head(stream)) and stream.waiting < MAX_HEAD:
            yield from stream.more(stream.waiting + 1)
        if b"xml" not in head.lower():
            from yarpy.carriers.http.carrier import Http

            self.instead = Http
            stream.head += len(first)

    def decode(self, stream: ByteStream) -> Steps[Message]:
        while True:
            yield from stream.more(1)
            self.midway = True
            try:
                line = yield from stream.read_line(MAX_LINE)
                if not line:
                    continue  # between two calls
                body = yield from self._read_body(stream, line)
            except Timeout:
                stream.write(_RESPONSE.format(status="408 Request Timeout", size=0).encode())
                self.finished = True
                raise
            finally:
                self.midway = False
            try:
                call = xmlrpc.decode_call(body)
            except DecodeError as error:
                self._respond(stream, xmlrpc.encode_fault(NOT_UNDERSTOOD, str(error)))
                continue
            name = call[0] if call else ""
            self._terse = isinstance(name, str) and name in ROS
            key = ADMIN if self._terse else CALL
            self._owed = True
            return Message(key, b"".join(map(bytes, codec.encode(call))))

    def _read_body(self, stream: ByteStream, line: bytes) -> Steps[bytes | memoryview]:
        headers = yield from read_headers(stream)
        words = line.split()
        connection = headers.get("connection", "").lower()
        self._last = "close" in connection or (
            words[-1:] == [b"HTTP/1.0"] and "keep-alive" not in connection
        )
        size = headers.get("content-length", "")
        if words[:1] != [b"POST"]:
            yield from self._refuse(stream, "405 Method Not Allowed")
        if not (size.isascii() and size.isdigit()):
            yield from self._refuse(stream, "411 Length Required")
        if len(size) > 9 or int(size) > min(MAX_BODY, stream.limit):
            yield from self._refuse(stream, "413 Content Too Large", int(size[:9]))
        if "100-continue" in headers.get("expect", "").lower():
            stream.write(b"HTTP/1.1 100 Continue\r\n\r\n")
        return (yield from stream.read_exact(int(size)))

    def _refuse(self, stream: ByteStream, status: str, rest: int = 0) -> Steps[None]:
        """Say why, give the peer the time to read it, and end. `rest` bytes are still to come: who
        hangs up before they are read takes its answer back."""
        stream.write(_RESPONSE.format(status=status, size=0).encode())
        try:
            yield from stream.skip(min(rest, DRAIN))
            yield from stream.more(stream.waiting + 1)
        except LinkClosed:
            pass
        raise RemoteProtocolError(f"an XML-RPC call was refused: {status}")

    def _respond(self, stream: ByteStream, body: bytes) -> None:
        stream.write(_RESPONSE.format(status="200 OK", size=len(body)).encode() + body)
        self._owed = False
        if self._last or self._terse:
            self.finished = True

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        self._respond(stream, xmlrpc.encode_answer(value, self._terse))

    def encode_ack(self, stream: ByteStream) -> None:
        if self._owed:
            self._respond(stream, xmlrpc.encode_nothing())

    # -- the client -------------------------------------------------------------------------------

    def greet(self, stream: ByteStream) -> Steps[None]:
        self._request(0)  # refuses a path that cannot be
        return
        yield

    def _request(self, size: int) -> bytes:
        route = self.route
        path = route.spec.value("path")
        path = "/RPC2" if path is None else "/" + path.removeprefix("/")
        if not path.isprintable() or " " in path:
            raise LocalProtocolError(f"a path without blanks, please, not {path!r}")
        host = f"[{route.host}]" if ":" in route.host else route.host
        return (
            f"POST {path} HTTP/1.1\r\nUser-Agent: yarpy\r\nHost: {host}:{route.port}\r\n"
            f"Content-Type: text/xml\r\nContent-length: {size}\r\n\r\n"
        ).encode()

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        key = (self.name,)
        if key not in packet.forms:
            packet.forms[key] = (xmlrpc.encode_call(packet.value),)
        body = bytes(packet.forms[key][0])
        stream.write(self._request(len(body)) + body)

    def encode_quit(self, stream: ByteStream) -> None:
        """Nothing ends the dialogue but closing."""

    def expect_reply(self, stream: ByteStream) -> Steps[Message | None]:
        body = yield from self._read_response(stream)
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
            yield from self._read_response(stream)

    def _read_response(self, stream: ByteStream) -> Steps[bytes | memoryview]:
        line = yield from stream.read_line(MAX_LINE)
        headers = yield from read_headers(stream)
        size = headers.get("content-length", "")
        if line.split()[1:2] != [b"200"]:
            text = line[:80].decode("utf-8", "replace")
            raise RemoteProtocolError(f'the XML-RPC server says "{text}"')
        if not (size.isascii() and size.isdigit()):
            raise RemoteProtocolError("the XML-RPC server does not say how long its answer is")
        if len(size) > 9 or int(size) > min(MAX_BODY, stream.limit):
            raise RemoteProtocolError(f"an answer of more than {MAX_BODY} bytes")
        return (yield from stream.read_exact(int(size)))


def _head(stream: ByteStream) -> bytes:
    """The head of the request, if all of it has come."""
    data = bytes(stream.buffer[stream.head : stream.tail])
    for end in (b"\r\n\r\n", b"\n\n"):
        head, found, _ = data.partition(end)
        if found:
            return head
    return b""
