"""AsideStream: a stream that some bytes pass by."""

from __future__ import annotations

from yarpy.wire.aside_stream import AsideStream
from yarpy.wire.stream import run


def test_bytes_come_as_in_any_stream_and_nothing_has_passed_by() -> None:
    stream = AsideStream(limit=100)
    assert run(stream.read_exact(3), stream, [b"a", b"bc"]) == b"abc"
    assert (stream.limit, stream.aside, stream.came_aside) == (100, 0, 0)
