"""Chunks: what is inside an HTTP body of `Transfer-Encoding: chunked` that never ends.

    5 CR LF hello CR LF 3;name=value CR LF abc CR LF ... 0 CR LF

Rules: the reader of the body sees a ByteStream of its own, and knows nothing of chunks. Line ends
may be LF alone, extensions are ignored.
"""

from __future__ import annotations

from typing import Final, TypeVar

from yarpy.errors import LinkClosed, RemoteProtocolError
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

T = TypeVar("T")

MAX_LINE: Final = 1000  # bytes of the line with a size


class Chunks:
    """A chunked body; `inner` has the bytes in it. `limit` as that of a ByteStream."""

    def __init__(self, limit: int) -> None:
        self.inner = ByteStream(limit)
        self._left = 0  # bytes of this chunk that have not come yet
        self._begun = False  # the line end behind a chunk is still to come

    def through(self, stream: ByteStream, steps: Steps[T]) -> Steps[T]:
        """Run `steps`, which read `inner`, with what comes in chunks over `stream`.

        Raises LinkClosed where the body ends, RemoteProtocolError for what is no chunk.
        """
        while True:
            try:
                next(steps)
            except StopIteration as stop:
                value: T = stop.value
                return value
            yield from self._fetch(stream)

    def _fetch(self, stream: ByteStream) -> Steps[None]:
        """Move some bytes from `stream` into `inner`."""
        if not self._left:
            if self._begun and (yield from stream.read_line(MAX_LINE)):
                raise RemoteProtocolError("a chunk is longer than it said")
            self._begun = True
            text = (yield from stream.read_line(MAX_LINE)).partition(b";")[0].strip()
            try:
                self._left = int(text, 16) if text.isalnum() and len(text) < 16 else -1
            except ValueError:
                self._left = -1
            if self._left < 0:
                raise RemoteProtocolError(f"not the size of a chunk: {text[:20]!r}")
            if not self._left:
                raise LinkClosed("the peer has ended its answer")
        yield from stream.more(1)
        room = len(self.inner.get_buffer())
        end = stream.head + min(self._left, stream.waiting, room)
        self.inner.feed(memoryview(stream.buffer)[stream.head : end])
        self._left -= end - stream.head
        stream.head = end
