"""AsideStream: bytes through a pipe, and beside it payloads that go another way.

Rules: pure. Such a payload is counted with the bytes that go through the pipe.
"""

from __future__ import annotations

from yarpy.wire.stream import DEFAULT_LIMIT, ByteStream


class AsideStream(ByteStream):
    """A stream that some bytes pass by. `aside`: those that go to the peer, behind what was written
    here and waits to be taken; whoever takes that sets it to 0. `came_aside`: all that have come.
    """

    __slots__ = ("aside", "came_aside")

    def __init__(self, limit: int = DEFAULT_LIMIT) -> None:
        super().__init__(limit)
        self.aside = 0
        self.came_aside = 0
