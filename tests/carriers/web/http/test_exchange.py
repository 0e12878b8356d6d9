"""A request as bytes: what is late, cut off, too large or wrong, and how each is answered."""

from __future__ import annotations

import pytest
from carriers.web.http.test_carrier import ONE, responses, serve
from support.steps import chop, finish

from yarpy.carriers.web.http.carrier import Http
from yarpy.carriers.web.http.exchange import TIME, Exchange, whole_head
from yarpy.carriers.web.http.response import LATE
from yarpy.errors import Timeout
from yarpy.limit import HTTP_BODY, HTTP_HEAD
from yarpy.route import Route
from yarpy.wire.effects import Within
from yarpy.wire.message import QUIT
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream


def test_one_is_read_and_answered() -> None:
    exchange, stream = Exchange(), ByteStream()
    stream.feed(b"POST /x HTTP/1.1\r\nHost: me\r\nContent-Length: 2\r\n\r\nhiGET")
    finish(whole_head(stream))
    steps = exchange.read(stream)
    assert [next(steps), next(steps)] == [Within(TIME), Within(None)]
    with pytest.raises(StopIteration) as end:
        next(steps)
    request = end.value.value
    assert (request.method, request.target, request.body) == ("POST", "/x", b"hi")
    assert (exchange.host, exchange.envelope, exchange.stays) == ("me", "", True)
    assert stream.waiting == 3  # of the next one
    exchange.respond(stream, LATE)
    assert b"".join(map(bytes, stream.take_output())).startswith(b"HTTP/1.1 408 ")


@pytest.mark.parametrize(
    "begun",
    [
        b"GET /?req=x HTTP/1.1\r\nHost: x\r\n",
        b"POST /form HTTP/1.1\r\nHost: x\r\nContent-Length: 9\r\n\r\nre",
    ],
)
def test_request_that_does_not_come_is_told_so(begun: bytes) -> None:
    """What the link does when a peer is too slow; the next requests are not read."""
    carrier, stream = Http(Route("", "/x", "http")), ByteStream()
    stream.feed(begun)
    if begun.startswith(b"GET"):
        steps: Steps[object] = carrier.welcome(stream, begun[:8])
        stream.head = 8
    else:
        steps = carrier.decode(stream)
    asked = list(iter(lambda: next(steps), None))  # what it yields before it wants more bytes
    assert asked == ([Within(TIME)] if begun.startswith(b"POST") else [])
    with pytest.raises(Timeout):
        steps.throw(Timeout("late"))
    found = responses(b"".join(map(bytes, stream.take_output())), "POST")[0]
    assert (found[0], found[1]["connection"]) == (408, "close")
    assert finish(carrier.decode(stream)).key == QUIT


def test_body_that_waits_to_be_asked_for() -> None:
    """curl does so with large bodies."""
    head = b"POST /form HTTP/1.1\r\nHost: x\r\nExpect: 100-continue\r\nContent-Length: 5\r\n\r\n"
    _, said = serve(head, b"req=x")
    assert said.startswith(b"HTTP/1.1 100 ")
    assert responses(said, "POST")[0][0] == 200


def test_body_in_chunks() -> None:
    head = b"POST /form HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n"
    owner, _ = serve(head + b"4\r\nreq=\r\n3\r\none\r\n0\r\n\r\n" + ONE)
    assert [m.value for m in owner.heard] == [["one"], ["one"]]


BAD = [
    (b"GET / HTTP/1.1\r\n\r\n", 400),  # no Host
    (b"GET / HTTP/9\r\n\r\n", 400),
    (b"GET /  x HTTP/1.1\r\nHost: x\r\n\r\n", 400),
    (b"GET / HTTP/1.1\r\nHost: x\r\nno colon\r\n\r\n", 400),
    (b"GET / HTTP/1.1\r\nHost: x\r\nContent-Length: -1\r\n\r\n", 400),
    (b"GET / HTTP/1.1\r\nHost: x\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n", 400),
    (b"POST /form HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: gzip\r\n\r\n", 501),
    (b"POST /form HTTP/1.1\r\nHost: x\r\nContent-Length: 10\r\n\r\nreq=x", 400),  # too short
    (b"POST /form HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n", 400),
    (b"POST /form HTTP/1.1\r\nHost: x\r\nContent-Length: %d\r\n\r\n" % (HTTP_BODY + 1), 413),
    (b"POST /form HTTP/1.1\r\nHost: x\r\nContent-Length: %s\r\n\r\n" % (b"9" * 15), 413),
    (b"GET / HTTP/1.1\r\nHost: x\r\nX: " + b"y" * HTTP_HEAD, 431),
    (b"GET / HTTP/1.1\r\nHost: x\r\nX: " + b"y" * HTTP_HEAD + b"\r\n\r\n", 431),
    (b"GET /" + b"y" * 2 * HTTP_HEAD, 431),
]


@pytest.mark.parametrize(("request_", "status"), BAD, ids=lambda item: str(item)[:60])
@pytest.mark.parametrize("piece", [0, 1000])
def test_bad_requests(request_: bytes, status: int, piece: int) -> None:
    owner, said = serve(*chop(request_, piece))
    found = responses(said, "POST")[0]
    assert found[0] == status
    assert not owner.heard
    assert found[1].get("connection") == "close" or status == 400
    assert len(found[2]) < 300


def test_body_without_end_is_not_collected() -> None:
    head = b"POST /form HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n"
    chunk = b"100000\r\n" + b"x" * (1 << 20) + b"\r\n"
    owner, said = serve(head, *[chunk] * 40)
    assert responses(said, "POST")[0][0] == 413
    assert not owner.heard


LENGTHS = [
    "Content-Length: 3\r\nContent-Length: 4",
    "Content-Length: 3\r\nTransfer-Encoding: chunked",
    "Transfer-Encoding: chunked\r\nContent-Length: 3",
    "Transfer-Encoding: identity\r\nContent-Length: 3",
]


@pytest.mark.parametrize("lines", LENGTHS)
def test_two_lengths_are_refused(lines: str) -> None:
    """Somebody in between may have read another request (smuggling)."""
    wire = f"POST /form HTTP/1.1\r\nHost: x\r\n{lines}\r\n\r\n0\r\n\r\n".encode()
    owner, said = serve(wire)
    assert said.split(b" ")[1] in (b"400", b"501")
    assert owner.heard == []
