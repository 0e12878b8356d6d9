"""Our requests, and responses of every kind."""

from __future__ import annotations

import random
from collections.abc import Iterator

import pytest
from support.steps import chop

from yarpy.carriers.web.http.carrier import Http
from yarpy.carriers.web.http.client import HttpClient
from yarpy.errors import LinkClosed, LocalProtocolError, RemoteProtocolError, YarpError
from yarpy.limit import HTTP_HEAD
from yarpy.route import Route
from yarpy.wire.message import Message, Packet
from yarpy.wire.stream import ByteStream, run


def dialled(*replies: bytes) -> tuple[Http, ByteStream]:
    carrier, stream = Http(Route("/a", "/b", "http+path.hook", 80, "fe80::1")), ByteStream()
    for _ in replies:
        carrier.encode(stream, Packet(["x", 1], b"1 2.5", "d"))
    return carrier, stream


def test_messages_are_posted() -> None:
    _, stream = dialled(b"")
    said = b"".join(map(bytes, stream.take_output()))
    assert said.startswith(b"POST /hook?format=text HTTP/1.1\r\n")
    assert b"Host: [fe80::1]:80\r\n" in said
    assert b"1 2.5\r\n" in said
    assert said.endswith(b"\r\n\r\nx 1")


OK = b"HTTP/1.1 200 OK\r\nContent-Length: 6\r\n\r\nok 1\r\n"


@pytest.mark.parametrize("piece", [0, 1])
def test_responses_are_replies(piece: int) -> None:
    wire = OK + b"HTTP/1.1 204 No Content\r\n\r\n" + b"HTTP/1.1 100 Continue\r\n\r\n" + OK
    carrier, stream = dialled(OK, OK, OK)

    def talk() -> Iterator[None]:
        for _ in range(3):
            found.append((yield from carrier.expect_reply(stream)))
            yield from carrier.expect_ack(stream)

    found: list[Message | None] = []
    run(talk(), stream, chop(wire, piece))  # type: ignore[arg-type]
    assert [message and message.value for message in found] == [["ok", 1], None, ["ok", 1]]


@pytest.mark.parametrize(
    ("reply", "error"),
    [
        (b"HTTP/1.1 404 Not Found\r\nContent-Length: 3\r\n\r\nno\n", RemoteProtocolError),
        (b"GARBAGE\r\n\r\n", RemoteProtocolError),
        (b"HTTP/1.1 200 OK\r\nX: " + b"y" * 2 * HTTP_HEAD, RemoteProtocolError),
        (b"HTTP/1.1 200 OK\r\nContent-Length: 9\r\n\r\nok", LinkClosed),
        (b"", LinkClosed),
    ],
    ids=lambda item: str(item)[:30],
)
def test_responses_that_are_none(reply: bytes, error: type[Exception]) -> None:
    carrier, stream = dialled(b"")
    with pytest.raises(error):
        run(carrier.expect_ack(stream), stream, [reply] if reply else [])


def test_damaged_responses_are_our_errors() -> None:
    chance = random.Random(3)
    for _ in range(500):
        data = bytearray(OK)
        for _ in range(chance.randint(1, 3)):
            data[chance.randrange(len(data))] = chance.randrange(256)
        carrier, stream = dialled(b"")
        try:
            run(carrier.expect_reply(stream), stream, [bytes(data)])
        except YarpError:
            pass


def test_envelope_that_would_be_another_header_stays_at_home() -> None:
    client, stream = HttpClient(Route("/a", "/b", "http", 80, "h")), ByteStream()
    client.post(stream, Packet([1], b"1\r\nEvil: 1"))
    assert b"Evil" not in b"".join(map(bytes, stream.take_output()))


def test_path_with_blanks_is_refused() -> None:
    client = HttpClient(Route("/a", "/b", "http+path.a b", 80, "h"))
    with pytest.raises(LocalProtocolError, match="contains blanks"):
        client.post(ByteStream(), Packet([1]))


def test_response_that_nobody_asked_for() -> None:
    client = HttpClient(Route("/a", "/b", "http", 80, "h"))
    with pytest.raises(RemoteProtocolError, match="without a request"):
        run(client.response(ByteStream()), ByteStream(), [OK])
