"""LendingStream: large parts of a message lie where the transport has received them.

Rules: pure. What the transport cannot lend is copied, as from any stream; what it has lent cannot
be read again.
"""

from __future__ import annotations

from collections.abc import Callable

from yarpy.wire.aside_stream import AsideStream
from yarpy.wire.steps import Steps
from yarpy.wire.stream import DEFAULT_LIMIT, ByteStream

#: The next so many bytes where a transport has them, of which the last so many of those that have
#: come to the stream are the first; None: they have to be copied.
Lend = Callable[[int, int], memoryview | None]


class LendingStream(AsideStream):
    """A stream of a transport that lends what has come."""

    __slots__ = ("_lend",)

    def __init__(self, lend: Lend, limit: int = DEFAULT_LIMIT) -> None:
        super().__init__(limit)
        self._lend = lend

    def read_large(self, count: int) -> Steps[memoryview]:
        if count <= self.limit:
            lent = self._lend(count, self.tail - self.head)
            if lent is not None:
                self.mark = -1
                self.came_aside += count - (self.tail - self.head)
                self.head = self.tail
                return lent
        return (yield from ByteStream.read_large(self, count))
