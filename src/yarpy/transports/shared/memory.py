"""Memory: a Unix socket between two programs of one computer, and memory that both see.

Rules: the sender waits at a number that it has told over TCP, the reader comes there, and both look
at whose program the other one is: the same user's. Then the reader gets three descriptors
(`arena.py`), and a second socket, by which those of other programs' memory follow when the sender
passes on what lies there. The first has no file: its name ends with it.
"""

from __future__ import annotations

import contextlib
import os
import secrets
import socket
import struct
import sys
import time
import weakref
from array import array
from collections.abc import Callable, Sequence
from functools import partial
from typing import Final

from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.platform.user import user
from yarpy.threads import undisturbed
from yarpy.transports.base import Transport
from yarpy.transports.descriptor import has_input, opened_pair
from yarpy.transports.opener import MeetingPlace, Opener
from yarpy.transports.shared.arena import Arena, arena_of, tidy
from yarpy.transports.shared.borrowed import OTHERS, Borrowed, Shown, adopted
from yarpy.transports.shared.loan import LEDGER, Borrower, Placed
from yarpy.transports.shared.sealed import available, sealed_memory
from yarpy.transports.shared.shared_array import Source
from yarpy.transports.socket_transport import MSG_DONTWAIT
from yarpy.transports.tcp import TcpTransport
from yarpy.transports.unix import UnixTransport
from yarpy.wire.stream import Buffer

TIMEOUT: Final = 5.0  # seconds for the two sides to meet
LOOK: Final = 0.02  # seconds between looks whether the other side still comes
NOWHERE: Final = -1  # the reader cannot have it
_FRESH: Final = 1 << 8  # the memory of that number has just been shown
_MOST: Final = 8  # descriptors that come at a time
_CLOEXEC: Final = int(getattr(socket, "MSG_CMSG_CLOEXEC", 0))  # no program we start gets them
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
    """Return whether the program at the other end runs as our user."""
    if sys.platform != "linux":
        raise NotImplementedError
    told = sock.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, _CREDENTIALS.size)
    return bool(_CREDENTIALS.unpack(told)[1] == user())


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

    def lend(self, payload: Placed) -> int:
        """No memory of ours is shared here."""
        return NOWHERE

    def take(self, where: int, slot: int, generation: int, offset: int, size: int) -> memoryview:
        """No memory of the peer's is shared here."""
        raise RemoteProtocolError("a reference to memory that is not shared")


class SendingTransport(MemoryTransport):
    """The side of the port called `name`, which sends."""

    def __init__(self, name: str) -> None:
        self._arena: Arena | None = arena_of(name)
        self.key = self._arena
        self._reader: Borrower | None = None
        self._aside: socket.socket | None = None  # where descriptors go
        self._others: list[weakref.ref[Source] | None] = [None] * OTHERS  # that were shown
        self._next = 0  # the number to be used next
        if sys.platform == "win32":
            raise NotImplementedError
        sock = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        super().__init__(sock, secrets.randbits(63))
        try:
            sock.bind(_path(self._number))
            sock.listen(1)
        except BaseException:
            sock.close()
            raise

    def ready(self, look: Callable[[], object] | None = None) -> None:
        listener, deadline = self.sock, time.monotonic() + TIMEOUT
        with contextlib.closing(listener):
            while True:
                if not has_input(listener.fileno(), LOOK):
                    if time.monotonic() > deadline:
                        raise TimeoutError("the reader did not come to share memory")
                    if look is not None:
                        look()
                    continue
                if undisturbed(partial(self._admit, listener)):
                    break
        undisturbed(self._hand_over)

    def _admit(self, listener: socket.socket) -> bool:
        self.use(listener.accept()[0])
        if _same_user(self.sock):
            return True
        self.sock.close()  # somebody else, who has seen the name
        return False

    def _hand_over(self) -> None:
        if sys.platform != "linux":
            raise NotImplementedError
        arena = self._arena
        if arena is None:
            return  # it was closed meanwhile, by who called us
        ledger = sealed_memory("yarpy-ledger", LEDGER)
        self._aside, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs:
            ours, pipe = opened_pair(os.pipe2, os.O_CLOEXEC | os.O_NONBLOCK)
            numbers = [arena.number, ledger.fileno(), pipe.fileno(), theirs.fileno()]
            _send(self.sock, _WORD, numbers)
            self._reader = Borrower(ledger.fileno(), ours)

    def place(self, blocks: Sequence[Buffer], size: int) -> Placed | None:
        """Take a payload into the arena, copied unless it lies in shared memory; None if there is
        no room."""
        return None if self._arena is None else self._arena.place(blocks, size)

    def lend(self, payload: Placed) -> int:
        """The reader is about to be told of it: in which memory."""
        arena, reader = self._arena, self._reader
        if arena is None or reader is None:
            return NOWHERE
        if not arena.lend(payload, reader):
            return NOWHERE
        where = 0 if payload.source is arena else self._show(payload.source)
        if where < 0:
            arena.recall(payload, reader)
        return where

    def _show(self, source: Source) -> int:
        """The number of memory that is not ours, as the reader knows it."""
        for number, other in enumerate(self._others):
            if other is not None and other() is source:
                return number + 1
        place = self._next
        try:
            assert self._aside is not None
            _send(self._aside, bytes([place + 1]), source.descriptors, MSG_DONTWAIT)
        except OSError:
            return NOWHERE  # it takes none at present
        self._next = (place + 1) % OTHERS
        self._others[place] = weakref.ref(source)
        return place + 1 | _FRESH

    def close(self) -> None:
        super().close()
        if self._aside is not None:
            self._aside.close()
        if self._reader is not None:
            self._reader.ended = True
        self._arena = self.key = None  # it ends with the last connection, or array in it
        tidy()


class ReadingTransport(MemoryTransport):
    """The side that reads."""

    def __init__(self, sock: socket.socket, number: int) -> None:
        super().__init__(sock, number)
        self._borrowed: Borrowed | None = None
        self._aside: socket.socket | None = None  # where descriptors come from

    def ready(self, look: Callable[[], object] | None = None) -> None:
        if not self.wait_readable(TIMEOUT):
            raise TimeoutError("the sender does not share its memory")
        undisturbed(self._adopt)

    def _adopt(self) -> None:
        said, numbers, complete = _receive(self.sock, len(_WORD), MSG_DONTWAIT)
        if said != _WORD or len(numbers) != 4 or not complete:
            _close(numbers)
            raise RemoteProtocolError(
                f"four descriptors of shared memory were expected, not {len(numbers)}"
            )
        file, ledger, pipe, aside = numbers
        try:
            self._aside = socket.socket(fileno=aside)
        except OSError:
            _close(numbers)
            raise RemoteProtocolError("the fourth descriptor is no socket") from None
        self._borrowed = Borrowed(file, ledger, pipe)

    def take(self, where: int, slot: int, generation: int, offset: int, size: int) -> memoryview:
        """A payload. Raises RemoteProtocolError for one that lies nowhere."""
        borrowed = self._borrowed
        if borrowed is None:
            return super().take(where, slot, generation, offset, size)
        tidy()
        if where & _FRESH:
            other = where & ~_FRESH
            borrowed.show(other, undisturbed(partial(self._shown, other)))
        return borrowed.take(where & ~_FRESH, slot, generation, offset, size)

    def _shown(self, number: int) -> Shown:
        """Memory of another program, which the sender has just shown."""
        if self._aside is None or not 0 < number <= OTHERS:
            raise RemoteProtocolError(f"memory number {number}; there are {OTHERS} at most")
        try:
            said, numbers, complete = _receive(self._aside, 2, MSG_DONTWAIT)
        except OSError as error:
            raise RemoteProtocolError(f"memory number {number} was not shown ({error})") from error
        if said != bytes([number]) or len(numbers) not in (1, 2) or not complete:
            _close(numbers)
            raise RemoteProtocolError(f"memory number {number} was shown in a wrong way")
        return Shown(*adopted(numbers))

    def close(self) -> None:
        super().close()
        self._borrowed = None  # what is looked at still keeps it
        if self._aside is not None:
            self._aside.close()
        tidy()


# `socket.send_fds` and `recv_fds` of Python ignore their flags.


def _send(sock: socket.socket, said: bytes, numbers: Sequence[int], flags: int = 0) -> None:
    """Send descriptors. Raises OSError."""
    if sys.platform != "linux":
        raise NotImplementedError
    sock.sendmsg([said], [(socket.SOL_SOCKET, socket.SCM_RIGHTS, array("i", numbers))], flags)


def _receive(sock: socket.socket, size: int, flags: int = 0) -> tuple[bytes, list[int], bool]:
    """At most `size` bytes, the descriptors that came with them, and whether these are all. Raises
    OSError."""
    if sys.platform != "linux":
        raise NotImplementedError
    found = array("i")
    room = socket.CMSG_SPACE(_MOST * found.itemsize)
    said, beside, told, _ = sock.recvmsg(size, room, flags | _CLOEXEC)
    for level, kind, data in beside:
        if (level, kind) == (socket.SOL_SOCKET, socket.SCM_RIGHTS):
            found.frombytes(data[: len(data) - len(data) % found.itemsize])
    return said, list(found), not told & socket.MSG_CTRUNC


def _close(numbers: Sequence[int]) -> None:
    for number in numbers:
        os.close(number)


def _reading(number: int) -> ReadingTransport | None:
    if sys.platform != "linux":
        raise NotImplementedError
    sock = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        sock.connect(_path(number))
        if _same_user(sock):
            return ReadingTransport(sock, number)
    except OSError:
        pass  # another computer or container
    sock.close()
    return None


class Memory(Opener):
    """Payloads in memory that two programs of yarpy share."""

    name = "memory"
    meets = False
    stays = True
    system = "linux"
    uses = "memory without a name (memfd)"

    @classmethod
    def meet(cls, place: MeetingPlace) -> Transport | None:
        return open_memory(place.listen, place.port, place.group)
