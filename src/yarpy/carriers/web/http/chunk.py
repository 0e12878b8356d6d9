"""Chunks: read an endless HTTP body of `Transfer-Encoding: chunked`.

    5 CR LF hello CR LF 3;name=value CR LF abc CR LF ... 0 CR LF

Rules: the body's reader gets a separate ByteStream and knows nothing about chunks. Line ends may be
LF alone, extensions are ignored.
"""

from __future__ import annotations

from typing import TypeVar

from yarpy.errors import LinkClosed, RemoteProtocolError
from yarpy.limit import HTTP_CHUNK_LINE
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

T = TypeVar("T")


class Chunks:
    """A chunked body; `inner` has its contents. `limit` as for a ByteStream."""

    def __init__(self, limit: int) -> None:
        self.inner = ByteStream(limit)
        self._left = 0  # bytes of this chunk that have not arrived yet
        self._begun = False  # the line end after a chunk has not been read yet
        self._idle = True  # nothing has arrived of what the reader waits for

    def through(self, stream: ByteStream, steps: Steps[T]) -> Steps[T]:
        """Run `steps`, which read `inner`, filling it from the chunks on `stream`.

        Raises LinkClosed where the body ends, RemoteProtocolError for a malformed chunk.
        """
        self._idle = True
        while True:
            try:
                next(steps)
            except StopIteration as stop:
                value: T = stop.value
                return value
            if self.inner.paused:
                self.inner.paused = False
                self._idle = not self.inner.waiting
            yield from self._fetch(stream)

    def _fetch(self, stream: ByteStream) -> Steps[None]:
        """Move some bytes from `stream` into `inner`."""
        if self._idle:
            stream.pause()
        if not self._left:
            if self._begun and (yield from stream.read_line(HTTP_CHUNK_LINE)):
                raise RemoteProtocolError("a chunk is longer than its size line says")
            if self._idle:
                stream.pause()
            self._begun = True
            text = (yield from stream.read_line(HTTP_CHUNK_LINE)).partition(b";")[0].strip()
            try:
                self._left = int(text, 16) if text.isalnum() and len(text) < 16 else -1
            except ValueError:
                self._left = -1
            if self._left < 0:
                raise RemoteProtocolError(f"not a chunk size: {text[:20]!r}")
            if not self._left:
                raise LinkClosed("the peer has ended its answer")
        yield from stream.more(1)
        room = len(self.inner.get_buffer())
        end = stream.head + min(self._left, stream.waiting, room)
        self._idle = False
        self.inner.feed(memoryview(stream.buffer)[stream.head : end])
        self._left -= end - stream.head
        stream.head = end
