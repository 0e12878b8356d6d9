"""Chunked bodies: any cut gives the same bytes; ends and mistakes are told."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.carriers.web.http.chunk import Chunks
from yarpy.errors import LinkClosed, RemoteProtocolError
from yarpy.limit import HTTP_CHUNK_LINE
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream


def read(body: bytes, counts: list[int], piece: int) -> list[bytes]:
    """What a reader of so many bytes at a time gets out of a body that comes in pieces."""
    outer, chunks = ByteStream(), Chunks(1 << 20)
    found: list[bytes] = []

    def reader(inner: ByteStream) -> Steps[None]:
        for count in counts:
            found.append(bytes((yield from inner.read_exact(count))))

    steps = chunks.through(outer, reader(chunks.inner))
    for at in range(0, len(body), piece):
        try:
            next(steps)
        except StopIteration:
            return found
        outer.feed(body[at : at + piece])
    outer.feed_eof()
    with pytest.raises(StopIteration):
        while True:
            next(steps)
    return found


@given(
    st.lists(st.binary(min_size=1, max_size=300), min_size=1, max_size=8),
    st.sampled_from([b"\r\n", b"\n", b"; a=b\r\n", b"  \r\n"]),
    st.integers(1, 50),
)
def test_any_cut(parts: list[bytes], end: bytes, piece: int) -> None:
    body = b"".join(b"%x" % len(part) + end + part + b"\r\n" for part in parts)
    whole = b"".join(parts)
    half = len(whole) // 2
    assert b"".join(read(body, [half, len(whole) - half], piece)) == whole


def test_large_reads() -> None:
    data = bytes(range(256)) * 1000
    body = b"%X\r\n" % 100_000 + data[:100_000] + b"\r\n%X\r\n" % 156_000 + data[100_000:] + b"\r\n"
    assert read(body, [len(data)], 60_000) == [data]


def test_end_of_the_body() -> None:
    with pytest.raises(LinkClosed, match="ended its answer"):
        read(b"1\r\na\r\n0\r\n\r\n", [2], 100)
    with pytest.raises(LinkClosed):
        read(b"5\r\nab", [5], 100)


@pytest.mark.parametrize(
    "body", [b"x\r\n", b"-1\r\n", b"\r\n", b"+3\r\nabc", b"f" * 16 + b"\r\n", b"1\r\nabc\r\n1\r\n"]
)
def test_what_is_no_chunk(body: bytes) -> None:
    with pytest.raises(RemoteProtocolError):
        read(body, [2], 100)


def test_endless_line() -> None:
    with pytest.raises(RemoteProtocolError):
        read(b"1;" + b"x" * (HTTP_CHUNK_LINE + 1) + b"\r\n", [1], 500)
