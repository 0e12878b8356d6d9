"""What a transport is: it moves bytes and knows no protocol.

Rules: blocking calls, no Python-level timeouts (a kernel receive timeout costs nothing per call);
`interrupt` wakes whoever is inside from another thread; `close` is idempotent. Errors are OSError,
mapped to ours by the driver alone.
"""

from __future__ import annotations

import select
import socket
import struct
import sys
from collections.abc import Callable, Sequence
from typing import Protocol

from yarpy.wire.stream import Buffer

Address = tuple[str, int]


class Transport(Protocol):
    """One side of a byte pipe."""

    @property
    def local(self) -> Address:
        """Our address, `(host, port)`."""

    @property
    def remote(self) -> Address:
        """The peer's address."""

    @property
    def port(self) -> int:
        """The number the peer needs to find us, 0 if none."""

    def ready(self, look: Callable[[], object] | None = None) -> None:
        """Called once before the first byte: here the two ends wait for each other.

        `look` is called now and then meanwhile; it raises if the peer will not come.
        """

    def recv_into(self, view: memoryview) -> int:
        """Wait for bytes; 0 is the end. Raises BlockingIOError when a time limit is over."""

    def try_recv_into(self, view: memoryview) -> int:
        """Bytes that have come already; -1 if there are none, 0 at the end."""

    def send(self, buffers: Sequence[Buffer]) -> None:
        """Send everything."""

    def limit_waiting(self, seconds: float | None) -> None:
        """Limit the wait of each receive or send; None: for ever."""

    def set_dscp(self, tos: int) -> None:
        """Set the IP type-of-service byte (DSCP << 2) of outgoing packets."""

    def tos(self) -> int:
        """That byte, as the system has it."""

    def ended(self) -> bool:
        """Whether the peer has closed its side, without reading anything."""

    def interrupt(self) -> None:
        """Wake the threads that wait inside; nothing more will be sent or received."""

    def close(self) -> None:
        """Release it."""


class SocketTransport:
    """What all transports on sockets have in common."""

    def __init__(self, sock: socket.socket) -> None:
        self.sock = sock
        sock.setblocking(True)
        self._recv_into = sock.recv_into

    @property
    def local(self) -> Address:
        return address_of(self.sock.getsockname())

    @property
    def remote(self) -> Address:
        return address_of(self.sock.getpeername())

    @property
    def port(self) -> int:
        return 0

    def ready(self, look: Callable[[], object] | None = None) -> None:
        """Sockets that were accepted or connected are ready."""

    def recv_into(self, view: memoryview) -> int:
        return self._recv_into(view)

    def try_recv_into(self, view: memoryview) -> int:
        if not MSG_DONTWAIT and not self._readable():
            return -1
        try:
            return self._recv_into(view, 0, MSG_DONTWAIT)
        except BlockingIOError:
            return -1

    def send(self, buffers: Sequence[Buffer]) -> None:
        if len(buffers) == 1:
            self.sock.sendall(buffers[0])
        elif len(buffers) > _MANY and sum(map(len, buffers)) < _LITTLE:
            self.sock.sendall(b"".join(buffers))  # cheaper than a list for the kernel to walk
        elif buffers:
            send_all(self.sock, buffers)

    def limit_waiting(self, seconds: float | None) -> None:
        value = timeval(seconds)
        try:
            self.sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVTIMEO, value)
            self.sock.setsockopt(socket.SOL_SOCKET, socket.SO_SNDTIMEO, value)
        except OSError:
            pass  # closed by another thread meanwhile: readers and writers get the error

    def set_dscp(self, tos: int) -> None:
        if self.sock.family == socket.AF_INET6:
            self.sock.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_TCLASS, tos)
        else:
            self.sock.setsockopt(socket.IPPROTO_IP, socket.IP_TOS, tos)

    def tos(self) -> int:
        try:
            if self.sock.family == socket.AF_INET6:
                return self.sock.getsockopt(socket.IPPROTO_IPV6, socket.IPV6_TCLASS)
            if self.sock.family == socket.AF_INET:
                return self.sock.getsockopt(socket.IPPROTO_IP, socket.IP_TOS)
        except OSError:
            pass  # closed meanwhile
        return 0

    def _readable(self) -> bool:
        """For systems where a single call cannot be told not to wait (Windows)."""
        return bool(select.select([self.sock], [], [], 0)[0])

    def ended(self) -> bool:
        if not MSG_DONTWAIT and not self._readable():
            return False
        try:
            return not self.sock.recv(1, _MSG_PEEK)
        except BlockingIOError:
            return False
        except OSError:
            return True

    def interrupt(self) -> None:
        try:
            self.sock.shutdown(socket.SHUT_RDWR)
        except OSError:
            pass  # not connected any more: no thread is waiting inside

    def close(self) -> None:
        self.sock.close()


# Plain numbers: combining the enumerations of `socket` costs as much as a system call.
MSG_DONTWAIT: int = int(getattr(socket, "MSG_DONTWAIT", 0))
_MSG_PEEK: int = int(socket.MSG_PEEK) | MSG_DONTWAIT
_IOV_MAX = 512
_MANY = 3
_LITTLE = 1 << 17


def send_all(sock: socket.socket, buffers: Sequence[Buffer]) -> None:
    """One system call for all buffers; more only if the kernel takes less."""
    if not hasattr(sock, "sendmsg"):  # Windows
        sock.sendall(b"".join(buffers))
        return
    rest: list[Buffer] = list(buffers)
    while rest:
        sent = sock.sendmsg(rest[:_IOV_MAX])
        while rest and sent >= len(rest[0]):
            sent -= len(rest.pop(0))
        if sent:
            rest[0] = memoryview(rest[0])[sent:]


def timeval(seconds: float | None) -> bytes:
    """The argument of SO_RCVTIMEO: microseconds on Unix, milliseconds on Windows."""
    if sys.platform == "win32":
        return struct.pack("<L", 0 if seconds is None else max(1, int(seconds * 1000)))
    if seconds is None:
        return struct.pack("@ll", 0, 0)
    micros = max(1, int(seconds * 1e6))
    return struct.pack("@ll", micros // 1_000_000, micros % 1_000_000)


def address_of(raw: object) -> Address:
    """`(host, port)` of what the socket module calls an address."""
    if isinstance(raw, tuple) and len(raw) >= 2:
        host = str(raw[0])
        if len(raw) > 3 and raw[3] and "%" not in host:
            host += f"%{raw[3]}"  # a link-local address: on which network
        return host.removeprefix("::ffff:"), int(raw[1])
    return str(raw), 0
