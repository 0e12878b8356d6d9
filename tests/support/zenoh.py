"""The two ends of a pipe through Zenoh, joined without Zenoh."""

from __future__ import annotations

from collections.abc import Callable
from queue import Empty, SimpleQueue

from yarpy.peers.zenoh.tunnel.pipe import WAKE, ZenohPipe


class Line:
    """What a pipe needs of Zenoh, without Zenoh."""

    def __init__(self, wire: Wire, name: str) -> None:
        self.wire, self.name = wire, name
        self.inbox: SimpleQueue[bytes] = SimpleQueue()
        self.priority = "DATA"
        self.closed = False

    def put(self, data: bytes | bytearray) -> None:
        data = bytes(data)
        self.wire.sent.append((self.priority, data))
        if not self.wire.lose(data):
            self.wire.to(self.name)._line.inbox.put(data)  # type: ignore[attr-defined]

    def tell(self, data: bytes) -> None:
        self.wire.said.append(data)
        self.wire.to(self.name).told(data)

    def wake(self) -> None:
        self.inbox.put(bytes([WAKE]))

    def recv(self) -> bytes:
        return self.inbox.get()

    def try_recv(self) -> bytes | None:
        try:
            return self.inbox.get(False)
        except Empty:
            return None

    def prefer(self, priority: str) -> None:
        self.priority = priority

    def close(self) -> None:
        self.closed = True


class Wire:
    """Two ends, and what was sent between them; `lose` says which messages do not arrive."""

    def __init__(self, lose: Callable[[bytes], bool] = lambda data: False) -> None:
        self.sent: list[tuple[str, bytes]] = []
        self.said: list[bytes] = []
        self.lose = lose
        self.lines = Line(self, "a"), Line(self, "b")
        self.one = ZenohPipe(("a", 0), ("b", 7), self.lines[0])
        self.other = ZenohPipe(("b", 7), ("a", 0), self.lines[1])

    def to(self, name: str) -> ZenohPipe:
        return self.other if name == "a" else self.one
