"""Header lines, well and badly written."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.steps import chop

from yarpy.carriers.web.http.header import read_headers
from yarpy.errors import LinkClosed, RemoteProtocolError, YarpError
from yarpy.limit import HTTP_LINE, HTTP_LINES
from yarpy.wire.stream import ByteStream, run

LINES = [
    (b"\r\n", {}),
    (b"\n", {}),
    (b"Host: x\r\n\r\n", {"host": "x"}),
    (b"HOST:x\n\n", {"host": "x"}),
    (b"a : b:c \r\nA:d\r\n\r\n", {"a": "d"}),
    (b"no colon\r\n\r\n", {"no colon": ""}),
    (
        b"WWW-Authenticate: A b=c\r\nx: y\r\nwww-authenticate:D\r\n\r\n",
        {"www-authenticate": "A b=c, D", "x": "y"},
    ),
    (b"x: \xe9\r\n\r\n", {"x": "\xe9"}),
]


@pytest.mark.parametrize("piece", [0, 1])
@pytest.mark.parametrize(("data", "found"), LINES)
def test_lines(data: bytes, found: dict[str, str], piece: int) -> None:
    stream = ByteStream()
    assert run(read_headers(stream), stream, [*chop(data, piece), b"rest"]) == found


@pytest.mark.parametrize("data", [b"a: " + b"b" * HTTP_LINE + b"\r\n", b"a: b\r\n" * HTTP_LINES])
def test_limits(data: bytes) -> None:
    stream = ByteStream()
    with pytest.raises(RemoteProtocolError):
        run(read_headers(stream), stream, [data + b"\r\n"])


def test_end_is_noticed() -> None:
    stream = ByteStream()
    with pytest.raises(LinkClosed):
        run(read_headers(stream), stream, [b"a: b\r\n"])


@given(st.binary())
def test_whatever_comes(data: bytes) -> None:
    stream = ByteStream()
    try:
        run(read_headers(stream), stream, [data])
    except YarpError:
        pass
