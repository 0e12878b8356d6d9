"""shmem: two rings of shared memory between two programs, and a TCP connection that shows that both
are alive.

    initiator   int32 0, int32 size of its ring
    acceptor    int32 1, int32 of any value

Rules: between programs of one user on one computer. A side's ring has the number of its end of
that connection. The names of all that is shared are taken away as soon as both sides have found it,
those of C++ as well: it ends with the programs, however they end. What is written waits in the
ring, which grows as far as its reader is behind; beyond `AHEAD` bytes the writer waits.
"""

from __future__ import annotations

import socket
import struct
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Final

from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.transports.base import Address, Transport
from yarpy.transports.descriptor import has_input
from yarpy.transports.opener import MeetingPlace, Opener
from yarpy.transports.shared.ring import FIRST_SIZE, Ring
from yarpy.transports.shared.sysv import ELSEWHERE, require
from yarpy.transports.socket_transport import MSG_DONTWAIT, address_of
from yarpy.wire.stream import Buffer

TIMEOUT: Final = 5.0  # seconds for the two sides to meet
LOOK: Final = 0.02  # seconds between looks whether the other side still comes
GLANCE: Final = 0.5  # seconds between looks whether the other side still lives
AHEAD: Final = 1 << 20  # bytes that a reader may be behind; a single message may be larger
TRIES: Final = 8  # numbers to try: another program may use one for something else
_PACKET: Final = struct.Struct("<2i")
_CONNECT, _ACKNOWLEDGE = 0, 1
_SHORTEST, _LONGEST = 50e-6, 2e-3  # seconds between looks whether there is room


def open_shmem(listen: bool, local: Address, remote: Address, port: int) -> ShmemTransport:
    """Our side of a connection that greeted over TCP. The peer comes to us if we `listen`, else we
    go to its `port`. Raises LocalProtocolError where that cannot be."""
    require()
    if not listen and local[0] != remote[0]:
        raise LocalProtocolError(_far(local, remote))
    family = socket.AF_INET6 if ":" in remote[0] else socket.AF_INET
    reason = ""
    for _ in range(TRIES):
        sock = socket.socket(family, socket.SOCK_STREAM)
        try:
            # Only on the same computer its address can be ours as well.
            sock.bind((remote[0].partition("%")[0], 0))
        except OSError:
            sock.close()
            raise LocalProtocolError(_far(local, remote)) from None
        try:
            return ShmemTransport(sock, (remote[0], port), listen)
        except OSError as error:
            sock.close()
            reason = str(error)
    raise LocalProtocolError(f"no memory can be shared ({reason}); {ELSEWHERE}")


def _far(local: Address, remote: Address) -> str:
    return f"shmem joins ports of one computer, not {local[0]} and {remote[0]}; use tcp"


class ShmemTransport(Transport):
    """Two rings and a socket; connected once `ready` has returned."""

    scheme = "shmem"
    port: int = 0

    def __init__(self, sock: socket.socket, peer: Address, listen: bool) -> None:
        self._sock = sock
        self._peer = peer
        self._listen = listen
        self.port: int = sock.getsockname()[1]
        self._out = Ring(self.port, True, self._check)
        self._in: Ring | None = None
        self._limit: float | None = None
        self._send_limit: float | None = None
        self._tos = 0
        self._interrupted = False
        self._met = not listen  # the peer has found our ring
        if listen:
            sock.listen(1)

    # -- how the two meet -------------------------------------------------------------------------

    def ready(self, look: Callable[[], object] | None = None) -> None:
        """The two ends find each other, and each other's ring."""
        deadline = time.monotonic() + TIMEOUT
        if self._listen:
            self._accept(deadline, look)
        else:
            self._sock.settimeout(TIMEOUT)
            self._sock.connect(self._peer)
            self._sock.sendall(_PACKET.pack(_CONNECT, FIRST_SIZE))
        self._expect(_CONNECT if self._listen else _ACKNOWLEDGE, deadline)
        try:
            self._in = Ring(self._sock.getpeername()[1], False, self._check)
        except OSError as error:
            raise RemoteProtocolError(
                f"the peer's shared memory cannot be had ({error}): both have to be programs of "
                f"one user, and see the same memory; {ELSEWHERE}"
            ) from error
        self._in.forget()
        if self._listen:
            self._sock.sendall(_PACKET.pack(_ACKNOWLEDGE, 0))
        else:
            self._out.forget()
        self._sock.setblocking(False)

    def _accept(self, deadline: float, look: Callable[[], object] | None) -> None:
        listener = self._sock
        while not has_input(listener.fileno(), LOOK):
            if time.monotonic() > deadline:
                raise TimeoutError("the peer did not come to share memory")
            if look is not None:
                look()
        self._sock, (host, *_) = listener.accept()
        listener.close()
        if address_of((host, 0))[0] != self._peer[0]:
            raise RemoteProtocolError(f"{host} came instead of {self._peer[0]} to share memory")

    def _expect(self, wanted: int, deadline: float) -> None:
        """Read the peer's half of the greeting."""
        found = b""
        while len(found) < _PACKET.size:
            self._sock.settimeout(max(deadline - time.monotonic(), 0.001))
            piece = self._sock.recv(_PACKET.size - len(found))
            if not piece:
                raise RemoteProtocolError("the peer hung up before it shared memory")
            found += piece
        if _PACKET.unpack(found)[0] != wanted:
            raise RemoteProtocolError(f"the peer begins to share memory with {found.hex()}")

    # -- facts ------------------------------------------------------------------------------------

    @property
    def local(self) -> Address:
        return address_of(self._sock.getsockname())

    @property
    def remote(self) -> Address:
        return address_of(self._sock.getpeername())

    def set_dscp(self, tos: int) -> None:
        self._tos = tos  # no packet leaves this computer

    def tos(self) -> int:
        return self._tos

    def taken(self, sent: int, received: int) -> tuple[int, bool] | None:
        """Return how much the peer has read: what does not lie in the ring any more."""
        return sent - self._out.filled, False

    def ended(self) -> bool:
        if self._out.closed or self._in is None or (self._in.closed and not self._in.filled):
            return True
        try:
            return not self._sock.recv(1, socket.MSG_PEEK | MSG_DONTWAIT)
        except BlockingIOError:
            return False
        except OSError:
            return True

    def _check(self) -> None:
        """Raises OSError if the other side is gone."""
        if self._interrupted:
            raise BrokenPipeError("interrupted")
        with suppress(BlockingIOError):
            if not self._sock.recv(1, socket.MSG_PEEK | MSG_DONTWAIT):
                raise ConnectionResetError("the peer has gone")

    # -- reading ----------------------------------------------------------------------------------

    def recv_into(self, view: memoryview) -> int:
        limit = self._limit
        end = None if limit is None else time.monotonic() + limit
        while (count := self.try_recv_into(view)) < 0:
            left = GLANCE if end is None else min(end - time.monotonic(), GLANCE)
            if left <= 0:
                raise BlockingIOError
            assert self._in is not None
            self._in.wait(left)
            if not self._in.filled and self.ended():
                return max(self.try_recv_into(view), 0)
        return count

    def try_recv_into(self, view: memoryview) -> int:
        if self._interrupted or self._in is None:
            return 0
        count = self._in.read_into(view)
        if not self._met and (count >= 0 or self._out.found):
            self._met = True
            self._out.forget()
        return count

    # -- writing ----------------------------------------------------------------------------------

    def send(self, buffers: Sequence[Buffer]) -> None:
        limit = self._send_limit
        end = None if limit is None else time.monotonic() + limit
        while self.try_send(buffers):
            if not self.wait_writable(GLANCE if end is None else end - time.monotonic()) and end:
                raise BlockingIOError

    def try_send(self, buffers: Sequence[Buffer]) -> list[Buffer]:
        if self._interrupted:
            raise BrokenPipeError("interrupted")
        count = sum(map(len, buffers))
        if not self._has_room(count):
            return list(buffers)
        self._out.write(buffers, count)
        return []

    def _has_room(self, count: int) -> bool:
        filled = self._out.filled
        return not filled or filled + count <= AHEAD

    def wait_writable(self, seconds: float) -> bool:
        end, pause = time.monotonic() + seconds, _SHORTEST
        glance = time.monotonic() + GLANCE
        while self._out.filled > AHEAD // 2 and not self._interrupted:
            now = time.monotonic()
            if now >= end:
                return False
            if now > glance and self.ended():
                return True  # as sending tells
            time.sleep(min(pause, end - now))
            pause = min(2 * pause, _LONGEST)
        return True

    # -- the end ----------------------------------------------------------------------------------

    def limit_waiting(self, seconds: float | None, sends: bool = True) -> None:
        self._limit = seconds
        if sends:
            self._send_limit = seconds

    def interrupt(self) -> None:
        self._interrupted = True
        if self._in is not None:
            self._in.wake()
        with suppress(OSError):
            self._sock.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        for ring in (self._in, self._out):
            if ring is not None:
                ring.close()
        self._sock.close()


class Shmem(Opener):
    """Rings in shared memory, as C++ YARP has them."""

    name = "shmem"
    meets = False
    stays = True
    system = "linux"
    uses = "System V memory of Linux"

    @classmethod
    def meet(cls, place: MeetingPlace) -> Transport:
        through = place.through
        return open_shmem(place.listen, through.local, through.remote, place.port)
