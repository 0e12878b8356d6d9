"""Memory: a Unix socket between two programs of one computer, and memory that both see.

Rules: the sender waits at a number that it has told over TCP, the reader comes there, and both look
at whose program the other one is: the same user's. Then the reader gets three descriptors
(`arena.py`). The socket has no file: its name ends with it.
"""

from __future__ import annotations

import contextlib
import os
import secrets
import select
import socket
import struct
import time
from collections.abc import Callable, Sequence
from typing import Final

from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.transports.arena import LEDGER, Placed, Reader, arena_of, available, sealed_memory
from yarpy.transports.borrowed import Borrowed
from yarpy.transports.tcp import TcpTransport
from yarpy.transports.unix import UnixTransport
from yarpy.wire.stream import Buffer

PATIENCE: Final = 5.0  # seconds for the two sides to meet
LOOK: Final = 0.02  # seconds between looks whether the other side still comes
_WORD: Final = b"YARPYMEM"
_CREDENTIALS: Final = struct.Struct("3i")  # process, user, group


def open_memory(listen: bool, number: int, name: str) -> MemoryTransport | None:
    """Our side of a connection that greeted over TCP; the sender is the port called `name`.

    None for a reader that cannot see the sender, or must not. Raises LocalProtocolError.
    """
    if not available():
        if listen:
            return None
        raise LocalProtocolError("this system shares no memory between programs; use tcp")
    return _reading(number) if listen else SendingTransport(name)


def _path(number: int) -> str:
    return f"\0yarpy-memory-{number:016x}"


def _same_user(sock: socket.socket) -> bool:
    """Whether the program at the other end is of our user."""
    told = sock.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, _CREDENTIALS.size)
    return bool(_CREDENTIALS.unpack(told)[1] == os.geteuid())


class MemoryTransport(UnixTransport):
    """A Unix socket that packets have no priority on, and memory beside it."""

    key: object = None

    def __init__(self, sock: socket.socket, number: int) -> None:
        TcpTransport.__init__(self, sock)
        self._path, self._listen = _path(number)[1:], False
        self._number = number
        self._tos = 0

    @property
    def port(self) -> int:
        return self._number

    def set_dscp(self, tos: int) -> None:
        self._tos = tos  # no packet leaves this computer

    def tos(self) -> int:
        return self._tos

    def place(self, blocks: Sequence[Buffer], size: int) -> Placed | None:
        """No memory of ours is shared here."""
        return None

    def lend(self, parcel: Placed) -> bool:
        """No memory of ours is shared here."""
        return False

    def take(self, slot: int, generation: int, offset: int, size: int) -> memoryview:
        """No memory of the peer's is shared here."""
        raise RemoteProtocolError("a reference to memory that is not shared")


class SendingTransport(MemoryTransport):
    """The side of the port called `name`, which sends."""

    def __init__(self, name: str) -> None:
        self.arena = arena_of(name)
        self.key = self.arena
        self._reader: Reader | None = None
        sock = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        super().__init__(sock, secrets.randbits(63))
        try:
            sock.bind(_path(self._number))
            sock.listen(1)
        except BaseException:
            sock.close()
            raise

    def ready(self, look: Callable[[], object] | None = None) -> None:
        listener, deadline = self.sock, time.monotonic() + PATIENCE
        with contextlib.closing(listener):
            while True:
                if not select.select([listener], [], [], LOOK)[0]:
                    if time.monotonic() > deadline:
                        raise TimeoutError("the reader did not come to share memory")
                    if look is not None:
                        look()
                    continue
                self.sock, _ = listener.accept()
                if _same_user(self.sock):
                    break
                self.sock.close()  # somebody else, who has seen the name
        self._recv_into = self.sock.recv_into
        self._hand_over()

    def _hand_over(self) -> None:
        ledger = sealed_memory("yarpy-ledger", LEDGER)
        pipe: tuple[int, ...] = ()
        try:
            pipe = os.pipe2(os.O_CLOEXEC | os.O_NONBLOCK)
            socket.send_fds(self.sock, [_WORD], [self.arena.number, ledger, pipe[1]])
            self._reader = Reader(os.dup(ledger), pipe[0])
            pipe = pipe[1:]
        finally:
            for number in (ledger, *pipe):
                os.close(number)

    def place(self, blocks: Sequence[Buffer], size: int) -> Placed | None:
        """Copy a payload into the arena; None if there is no room."""
        return self.arena.place(blocks, size)

    def lend(self, parcel: Placed) -> bool:
        """The reader is about to be told of it."""
        return self._reader is not None and self.arena.lend(parcel, self._reader)

    def close(self) -> None:
        super().close()
        if self._reader is not None:
            self._reader.ended = True


class ReadingTransport(MemoryTransport):
    """The side that reads."""

    def __init__(self, sock: socket.socket, number: int) -> None:
        super().__init__(sock, number)
        self._borrowed: Borrowed | None = None

    def ready(self, look: Callable[[], object] | None = None) -> None:
        self.limit_waiting(PATIENCE)
        try:
            said, numbers, flags, _ = socket.recv_fds(
                self.sock, len(_WORD), 8, getattr(socket, "MSG_CMSG_CLOEXEC", 0)
            )
        except BlockingIOError:
            raise TimeoutError("the sender does not share its memory") from None
        self.limit_waiting(None)
        if said != _WORD or len(numbers) != 3 or flags & socket.MSG_CTRUNC:
            for number in numbers:
                os.close(number)
            raise RemoteProtocolError(
                f"three descriptors of shared memory were expected, not {len(numbers)}"
            )
        file, ledger, pipe = numbers
        self._borrowed = Borrowed(file, ledger, pipe)

    def take(self, slot: int, generation: int, offset: int, size: int) -> memoryview:
        """A payload. Raises RemoteProtocolError for one that lies nowhere."""
        if self._borrowed is None:
            return super().take(slot, generation, offset, size)
        return self._borrowed.take(slot, generation, offset, size)

    def close(self) -> None:
        super().close()
        self._borrowed = None  # what is looked at still keeps it


def _reading(number: int) -> ReadingTransport | None:
    sock = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        sock.connect(_path(number))
        if _same_user(sock):
            return ReadingTransport(sock, number)
    except OSError:
        pass  # another computer or container
    sock.close()
    return None
