"""LendingStream: what the transport lends is not copied."""

from __future__ import annotations

import pytest

from yarpy.errors import RemoteProtocolError
from yarpy.wire.lending_stream import LendingStream
from yarpy.wire.stream import LARGE, run

DATA = bytes(range(251)) * 400


def test_a_large_read_is_lent() -> None:
    asked: list[tuple[int, int]] = []

    def lend(count: int, back: int) -> memoryview:
        asked.append((count, back))
        return memoryview(DATA)[:count]

    stream = LendingStream(lend)
    stream.feed(DATA[:100])
    stream.begin()
    found = run(stream.read_exact(LARGE + 1), stream)
    assert isinstance(found, memoryview) and found.obj is DATA
    assert asked == [(LARGE + 1, 100)]
    assert (stream.waiting, stream.came_aside) == (0, LARGE + 1 - 100)
    assert not stream.rewind()  # what was lent is not there any more


def test_what_is_not_lent_or_is_small_is_copied() -> None:
    stream = LendingStream(lambda count, back: None)
    assert run(stream.read_exact(LARGE + 1), stream, [DATA]) == DATA[: LARGE + 1]
    assert stream.came_aside == 0
    small = LendingStream(lambda count, back: memoryview(b"never"))
    assert run(small.read_exact(4), small, [b"here"]) == b"here"


def test_nothing_beyond_the_limit_is_lent() -> None:
    stream = LendingStream(lambda count, back: memoryview(DATA)[:count], limit=LARGE)
    with pytest.raises(RemoteProtocolError, match="limit"):
        run(stream.read_exact(LARGE + 1), stream, [DATA])
