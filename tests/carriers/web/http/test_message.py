"""Messages of HTTP: heads that say what they should and nothing that somebody put into them."""

from __future__ import annotations

import h11
import pytest

from yarpy.carriers.web.http.message import chunk, next_event, request_head, response_head
from yarpy.errors import LinkClosed, LocalProtocolError
from yarpy.wire.stream import ByteStream, run


def test_heads() -> None:
    assert response_head(404, [("A", "b")]) == b"HTTP/1.1 404 Not Found\r\nA: b\r\n\r\n"
    assert response_head(299, []) == b"HTTP/1.1 299 \r\n\r\n"
    assert request_head("GET", "/x?y=%20", [("Host", "h")]) == (
        b"GET /x?y=%20 HTTP/1.1\r\nHost: h\r\n\r\n"
    )


@pytest.mark.parametrize("value", ["a\r\nEvil: 1", "a\nb", "\0", "\x7f"])
def test_header_ends_where_it_should(value: str) -> None:
    with pytest.raises(LocalProtocolError, match="cannot be"):
        response_head(200, [("A", value)])


@pytest.mark.parametrize("target", ["/a b", "/a\r\nb", "/\u00e4"])
def test_target_is_one_word(target: str) -> None:
    with pytest.raises(LocalProtocolError, match="contains blanks"):
        request_head("GET", target, [])


def test_chunks() -> None:
    assert chunk(b"x" * 26) == b"1a\r\n" + b"x" * 26 + b"\r\n"
    assert chunk(b"") == b""  # the chunk of no bytes is the end


@pytest.mark.parametrize("piece", [1, 7, 100])
def test_events(piece: int) -> None:
    wire = b"GET / HTTP/1.1\r\nHost: x\r\n\r\n"
    talk, stream = h11.Connection(h11.SERVER), ByteStream()
    feeds = [wire[i : i + piece] for i in range(0, len(wire), piece)]
    assert isinstance(run(next_event(stream, talk), stream, feeds), h11.Request)
    assert isinstance(run(next_event(stream, talk), stream), h11.EndOfMessage)


def test_end_within_a_head() -> None:
    stream = ByteStream()
    with pytest.raises(LinkClosed):
        run(next_event(stream, h11.Connection(h11.SERVER)), stream, [b"GET / HTTP/1.1\r\n"])
