"""thrift+http: calls in the bodies of POSTs, to servers such as Apache's THttpServer.

    thrift+http://127.0.0.1:9090                  TBinaryProtocol, at the path /
    thrift+http+compact+path.camera://HOST:9090   TCompactProtocol, at /camera

Rules: h11 checks every byte that comes. A body is one message, without a frame. A server that ends
the connection with its answer, as THttpServer does, is dialled anew for the next call, before
anything of that has left. Of the response to a oneway call only the status is waited for, and what
is wrong with it is logged: its caller is not there any more.
"""

from __future__ import annotations

from typing import Any, Final

import h11

from yarpy.errors import DecodeError, LinkClosed, LocalProtocolError, RemoteProtocolError
from yarpy.kits.thrift.apache.asking import Asking
from yarpy.kits.thrift.apache.body import KIND
from yarpy.kits.thrift.apache.message import spelling_of
from yarpy.kits.thrift.apache.scan import Scan
from yarpy.limit import HTTP_HEAD
from yarpy.log import logger, readable
from yarpy.route import CarrierSpec, Route
from yarpy.wire.message import Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

log = logger("yarpy.thrift")

_SHOWN: Final = 200  # characters of what a server says
_PROTOCOLS: Final = {"binary": "TBinaryProtocol", "compact": "TCompactProtocol"}


class Post(Asking):
    """A connection to a server over HTTP, which may end with each answer."""

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self._path = path_of(route.spec)
        self._talk: h11.Connection | None = None  # of the call whose response was not read
        self._over = False  # no other call can go over this connection

    def greet(self, stream: ByteStream) -> Steps[None]:
        return  # all is said with each call
        yield

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        if self._over:
            raise LinkClosed("the server has ended the connection after its last answer")
        super().encode(stream, packet)

    def _send(self, stream: ByteStream, data: bytes) -> None:
        route = self.route
        host = f"[{route.host}]" if ":" in route.host else route.host
        self._talk = talk = h11.Connection(h11.CLIENT, max_incomplete_event_size=HTTP_HEAD)
        headers = [
            ("Host", f"{host}:{route.port}"),
            ("User-Agent", "yarpy"),
            ("Accept", KIND),
            ("Content-Type", KIND),
            ("Content-Length", str(len(data))),
        ]
        head = talk.send(h11.Request(method="POST", target=self._path, headers=headers))
        talk.send(h11.Data(data=data))  # which are the same bytes
        talk.send(h11.EndOfMessage())
        stream.write(head or b"", data)

    def expect_reply(self, stream: ByteStream) -> Steps[Message | None]:
        talk = self._talk
        if not self._awaits or talk is None:
            return None
        head = yield from self._head(stream, talk)
        if head.status_code != 200:
            raise RemoteProtocolError(self._refusal(head))
        body = yield from self._body(stream, talk, head)
        self._awaits, self._talk = False, None
        self._over = _is_last(talk)
        spelled = spelling_of(body[:8])
        if spelled != self.spelled:
            raise RemoteProtocolError(self._not_ours(head, body, spelled))
        return self._returned(body)

    def expect_ack(self, stream: ByteStream) -> Steps[None]:
        talk, self._talk = self._talk, None
        if talk is None:
            return  # a reply that was read, or a goodbye, for which nothing comes
        head = yield from self._head(stream, talk)
        # Whatever else comes is not waited for: THttpServer ends it once the call is done.
        ended = isinstance(talk.next_event(), h11.EndOfMessage)
        self._over = not ended or _is_last(talk)
        if head.status_code // 100 != 2:
            self._over = True
            log.warning("%s: a oneway call: %s", self.route.source, self._refusal(head))

    def _head(self, stream: ByteStream, talk: h11.Connection) -> Steps[h11.Response]:
        while isinstance(head := (yield from self._event(stream, talk)), h11.InformationalResponse):
            pass
        if not isinstance(head, h11.Response):
            raise LinkClosed("the server has closed the connection")
        return head

    def _body(self, stream: ByteStream, talk: h11.Connection, head: h11.Response) -> Steps[bytes]:
        """Return the body, which may end with the connection: then what Thrift says of its length
        counts. RemoteProtocolError for one of more than the largest message, LinkClosed for half
        of one."""
        sizes = dict(head.headers)
        ends = b"content-length" not in sizes and b"transfer-encoding" not in sizes
        body = bytearray()
        told = int(sizes.get(b"content-length", b"0"))
        while told <= stream.limit and len(body) <= stream.limit:
            event = yield from self._event(stream, talk)
            if isinstance(event, h11.Data):
                body += event.data
                continue
            found = bytes(body)
            if ends and spelling_of(found[:8]) == self.spelled:
                scan = Scan(self.spelled)
                try:
                    scan.advance(found)
                except DecodeError as error:
                    raise RemoteProtocolError(f"no answer of {self._place}: {error}") from error
                if not scan.done:
                    raise LinkClosed("the server has closed the connection within its answer")
            return found
        raise RemoteProtocolError(
            f"an answer of {max(told, len(body))} bytes or more is announced; the limit is "
            f"{stream.limit} bytes"
        )

    def _event(self, stream: ByteStream, talk: h11.Connection) -> Steps[Any]:
        """The next event that h11 finds; it is told where the server closes the connection."""
        ended = False
        try:
            while (event := talk.next_event()) is h11.NEED_DATA:
                try:
                    yield from stream.more(1)
                except LinkClosed:
                    ended = True
                data = bytes(stream.buffer[stream.head : stream.tail])
                stream.head = stream.tail
                talk.receive_data(data)
        except h11.RemoteProtocolError as error:
            if ended:
                raise LinkClosed("the server has closed the connection") from error
            why = readable(str(error)[:_SHOWN])
            raise RemoteProtocolError(
                f"what answers at {self._place} does not speak HTTP ({why}): is it a server over a "
                "socket, thrift://?"
            ) from error
        return event

    @property
    def _place(self) -> str:
        return f"http://{self.route.host}:{self.route.port}{self._path}"

    def _refusal(self, head: h11.Response) -> str:
        """Return what a status that is none of success means."""
        status = head.status_code
        reason = readable(head.reason.decode("latin-1")[:_SHOWN]).strip()
        text = f'{self._place} answers "{f"{status} {reason}".strip()}"'
        if status in (404, 405):
            return f"{text}: say the path of the service, as thrift+http+path.PATH://HOST:PORT"
        if status == 413:
            return f"{text}: the call is larger than that server takes"
        where = dict(head.headers).get(b"location", b"").decode("latin-1")
        if status // 100 == 3 and where:
            return f"{text}: the service is at {readable(where[:_SHOWN])}, connect to that"
        return f"{text}: its log may say why"

    def _not_ours(self, head: h11.Response, body: bytes, spelled: str) -> str:
        """Return why a body is no answer."""
        if spelled:
            other = "+compact" if spelled == "compact" else ""
            return (
                f"{self._place} answers in {_PROTOCOLS[spelled]}: connect to thrift+http{other}://"
            )
        kind = dict(head.headers).get(b"content-type", b"").decode("latin-1")
        what = f"{readable(kind[:_SHOWN])}, not {KIND}" if kind and kind != KIND else "no message"
        return (
            f"what answers at {self._place} is no server of Thrift: its body of {len(body)} bytes "
            f"is {what}; is the path right (thrift+http+path.PATH://HOST:PORT)?"
        )


def _is_last(talk: h11.Connection) -> bool:
    """Return whether nothing can follow a response that was read: it says so, or the connection has
    ended with it, or more has come than the response."""
    return talk.their_state is not h11.DONE or talk.trailing_data != (b"", False)


def path_of(spec: CarrierSpec) -> str:
    """Return the path that calls are posted to. LocalProtocolError for one that cannot be sent."""
    path = "/" + (spec.value("path") or "").removeprefix("/")
    if not (path.isascii() and path.isprintable()) or " " in path:
        raise LocalProtocolError(f"the path {path!r}: write %20 for blanks, and so on")
    return path
