"""ObjectDriver: moves whole objects between a stream and a transport that carries these.

Rules: an object that has come is in `_item` until it is in the stream, so that an exception out of
a signal handler loses none. An object counts as so many bytes as its `size` says, if it has one.
"""

from __future__ import annotations

from typing import ClassVar

from yarpy.link.driver import Driver, is_foreign, link_error
from yarpy.transports.base import ObjectTransport
from yarpy.wire.stream import ObjectStream


class ObjectDriver(Driver):
    """A transport of objects and the stream in front of it."""

    pushes: ClassVar[bool] = False

    def __init__(self, transport: ObjectTransport, stream: ObjectStream) -> None:
        super().__init__(transport, stream)
        self._pipe = transport
        self._items = stream
        self._item: tuple[object] | None = None  # that has come

    def push(self) -> bool:
        return not self.stream.output

    def send(self, until: float | None = None) -> bool:
        output = self.stream.output
        if not output:
            return True
        self.stream.output = []
        try:
            self.transport.send(output)
        except OSError as error:
            if is_foreign(error):
                raise
            self.transport.failed(error)
            raise link_error(error) from error
        for piece in output:
            self.bytes_out += getattr(piece, "size", 0)
        return True

    def fill(self, deadline: float | None = None) -> None:
        try:
            if deadline is not None and not self._limit(deadline):
                raise BlockingIOError
            item = self._item
            if item is None:  # as `_take`, spelled out
                item = self._item = self._pipe.receive()
            if item is None:
                self.stream.feed_eof()
                return
            size = getattr(item[0], "size", 0)
            self._items.items += item
            self.bytes_in += size
            self._item = None
        except OSError as error:
            if self._waits_on(error, deadline):
                self.fill(deadline)
            else:
                self.stream.feed_eof()

    def try_fill(self) -> bool:
        try:
            self._take(wait=False)
        except BlockingIOError:
            return False
        return True

    def close(self) -> list[object]:
        super().close()
        return self._pipe.unread()

    def _take(self, wait: bool) -> None:
        if self._item is None:
            self._item = self._pipe.receive(wait)
            if self._item is None:
                self.stream.feed_eof()
                return
        size = getattr(self._item[0], "size", 0)
        self._items.items += self._item
        self.bytes_in += size
        self._item = None
