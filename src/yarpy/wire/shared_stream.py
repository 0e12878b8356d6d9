"""SharedStream: bytes through a pipe, and beside it payloads in memory that both ends see.

Rules: pure. What that memory is a transport knows; here is only what a protocol may ask of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from yarpy.wire.aside_stream import AsideStream
from yarpy.wire.stream import DEFAULT_LIMIT, Buffer


class SharedPayload(Protocol):
    """A payload in shared memory: `size` bytes from `offset`. It stays there for as long as the
    sender keeps this object, or a reader looks at it. `slot` and `generation` tell it from those
    before it."""

    slot: int
    generation: int
    offset: int
    size: int


class SharedMemory(Protocol):
    """The memory that the two ends of one connection share."""

    key: object
    """The same for all connections that have the same memory."""

    def place(self, blocks: Sequence[Buffer], size: int) -> SharedPayload | None:
        """Take a payload in, copied unless it lies in shared memory already; None if there is no
        room."""

    def lend(self, payload: SharedPayload) -> int:
        """The peer is about to be told of that payload: in which memory it lies, 16 bits; negative
        if it cannot have it."""

    def take(self, where: int, slot: int, generation: int, offset: int, size: int) -> memoryview:
        """A payload that the peer tells of, read-only; it is given back when the last view of it is
        gone. `where` is what the peer was told by `lend`. Raises RemoteProtocolError for one that
        lies nowhere."""


class SharedStream(AsideStream):
    """A stream with `memory` beside it."""

    __slots__ = ("memory",)

    def __init__(self, memory: SharedMemory, limit: int = DEFAULT_LIMIT) -> None:
        super().__init__(limit)
        self.memory = memory
