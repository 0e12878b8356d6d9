"""A transport that is a script: what the peer says is known beforehand, what is sent is kept.

Rules: no sockets. `incoming` holds bytes, or an exception to raise; after the last item the peer
has hung up, or (`open_ended`) is silent.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from yarpy.link.begin.greeting import driver_of
from yarpy.link.driver import Driver
from yarpy.transports.base import Address, Answerable
from yarpy.wire.stream import Buffer

Item = bytes | OSError


class ScriptTransport(Answerable):
    """One side of a byte pipe whose other side is a list."""

    scheme = "tcp"
    local: Address = ("127.0.0.1", 21602)
    remote: Address = ("127.0.0.1", 50000)

    def __init__(self, incoming: Iterable[Item] = (), open_ended: bool = False) -> None:
        self.incoming = list(incoming)
        self.open_ended = open_ended
        self.sent: list[bytes] = []
        self.sends = 0
        self.closed = False
        self.interrupted = False
        self.waits: list[float | None] = []
        self.fails_after: int | None = None

    def recv_into(self, view: memoryview) -> int:
        if not self.incoming or self.interrupted:
            if self.open_ended and not self.interrupted:
                raise BlockingIOError("silent")
            return 0
        item = self.incoming.pop(0)
        if isinstance(item, OSError):
            raise item
        part, rest = item[: len(view)], item[len(view) :]
        view[: len(part)] = part
        if rest:
            self.incoming.insert(0, rest)
        return len(part)

    def peek(self) -> int:
        first = self.incoming[0] if self.incoming else b""
        return first[0] if isinstance(first, bytes) and first else -1

    def try_recv_into(self, view: memoryview) -> int:
        if not self.incoming and self.open_ended and not self.interrupted:
            return -1
        return self.recv_into(view)

    def send(self, buffers: Sequence[Buffer]) -> None:
        if self.closed:
            raise OSError(9, "Bad file descriptor")
        if self.fails_after is not None and self.sends >= self.fails_after:
            raise BrokenPipeError(32, "Broken pipe")
        self.sends += 1
        self.sent += [bytes(b) for b in buffers]

    def try_send(self, buffers: Sequence[Buffer]) -> list[Buffer]:
        self.send(buffers)
        return []

    def limit_waiting(self, seconds: float | None, sends: bool = True) -> None:
        self.waits.append(seconds)

    def ended(self) -> bool:
        return not self.incoming and not self.open_ended

    def interrupt(self) -> None:
        self.interrupted = True

    def close(self) -> None:
        self.closed = True

    @property
    def said(self) -> bytes:
        """Everything that was sent, as one."""
        return b"".join(self.sent)


def scripted(*incoming: Item, open_ended: bool = False) -> tuple[Driver, ScriptTransport]:
    """A driver on such a transport."""
    transport = ScriptTransport(incoming, open_ended)
    return driver_of(transport), transport
