"""What a transport is: it moves bytes and knows no protocol.

Rules: blocking calls, no Python-level timeouts (a kernel receive timeout costs nothing per call);
`interrupt` wakes the threads inside; `close` is idempotent. Errors are OSError,
mapped to ours by the driver alone.
"""

from __future__ import annotations

import select
import socket
import struct
import sys
from collections.abc import Callable, Sequence
from typing import Any, Protocol

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

    def try_send(self, buffers: Sequence[Buffer]) -> list[Buffer]:
        """Send what leaves without waiting; what is left. An empty buffer in that stands for bytes
        that the transport holds back itself."""

    def wait_writable(self, seconds: float) -> bool:
        """Wait until something can be sent, or an error is to be had; False if time is over."""

    def limit_waiting(self, seconds: float | None, sends: bool = True) -> None:
        """Limit the wait of each receive, and of each send if `sends`; None: for ever."""

    def set_dscp(self, tos: int) -> None:
        """Set the IP type-of-service byte (DSCP << 2) of outgoing packets."""

    def tos(self) -> int:
        """That byte, as the system has it."""

    def ended(self) -> bool:
        """Whether the peer has closed its side, without reading anything."""

    def taken(self, sent: int, received: int) -> tuple[int, bool] | None:
        """How many bytes the peer's system has confirmed, and whether it is certain that its
        program has read them; None: nobody can say. `sent`, `received`: so many went and came
        here."""

    def interrupt(self) -> None:
        """Wake the threads that wait inside; nothing more will be sent or received."""

    def close(self) -> None:
        """Release it."""


class Answerable(Transport, Protocol):
    """The transport of a peer that has called us, and that speaks first."""

    def peek(self) -> int:
        """The first byte that comes, left unread; -1 for the end."""


class ObjectTransport:
    """What all transports have in common that carry whole Python objects instead of bytes: within
    a process, or over a library that has sockets of its own. `send` gets objects, too."""

    port = 0

    @property
    def local(self) -> Address:
        return "", 0

    @property
    def remote(self) -> Address:
        return "", 0

    def ready(self, look: Callable[[], object] | None = None) -> None:
        """Nobody else needs to come."""

    def receive(self, wait: bool = True) -> tuple[object] | None:
        """The next object in a one-element tuple; None is the end. Raises BlockingIOError when a
        time limit is over, or there is none and nobody is to wait."""
        raise NotImplementedError

    def send(self, buffers: Sequence[Any]) -> None:
        raise NotImplementedError

    def recv_into(self, view: memoryview) -> int:
        raise TypeError("it carries objects, not bytes")

    def try_recv_into(self, view: memoryview) -> int:
        return -1

    def try_send(self, buffers: Sequence[Any]) -> list[Any]:
        self.send(buffers)
        return []

    def wait_writable(self, seconds: float) -> bool:
        return True

    def limit_waiting(self, seconds: float | None, sends: bool = True) -> None:
        raise NotImplementedError

    def set_dscp(self, tos: int) -> None:
        """No packets of its own, no priority."""

    def tos(self) -> int:
        return 0

    def ended(self) -> bool:
        raise NotImplementedError

    def taken(self, sent: int, received: int) -> tuple[int, bool] | None:
        return None

    def interrupt(self) -> None:
        raise NotImplementedError

    def close(self) -> None:
        raise NotImplementedError


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
        if len(buffers) > 1:
            buffers = _fewest(buffers)
        if len(buffers) == 1:
            self.sock.sendall(buffers[0])
        elif buffers:
            send_all(self.sock, buffers)

    def try_send(self, buffers: Sequence[Buffer]) -> list[Buffer]:
        rest: list[Buffer] = []
        if len(buffers) > 1:
            buffers = _fewest(buffers)
        try:
            if len(buffers) == 1 and MSG_DONTWAIT:  # as nearly always
                sent = self.sock.send(buffers[0], MSG_DONTWAIT)
                if sent == len(buffers[0]):
                    return rest
                return [memoryview(buffers[0])[sent:]]
            rest = [buffer for buffer in buffers if buffer]
            if not MSG_DONTWAIT:  # there a send waits until the whole buffer has gone
                if not (rest and self.wait_writable(0.0)):
                    return rest
                self.send(rest)
                return []
            while rest:
                _drop_sent(rest, self.sock.sendmsg(rest[:_IOV_MAX], (), MSG_DONTWAIT))
        except BlockingIOError:
            return rest or list(buffers)
        return rest

    def wait_writable(self, seconds: float) -> bool:
        number = self.sock.fileno()
        if number < 0:
            return True  # closed, as sending tells
        if not hasattr(select, "poll"):  # Windows
            return bool(select.select([], [number], [], seconds)[1])
        poll = select.poll()
        poll.register(number, select.POLLOUT)
        return bool(poll.poll(max(0.0, seconds) * 1000))

    def wait_readable(self, seconds: float) -> bool:
        """Wait until something can be read, or the end; False if time is over."""
        number = self.sock.fileno()
        if number < 0:
            return True  # closed, as reading tells
        if not hasattr(select, "poll"):  # Windows
            return bool(select.select([number], [], [], seconds)[0])
        poll = select.poll()
        poll.register(number, select.POLLIN)
        return bool(poll.poll(seconds * 1000))

    def limit_waiting(self, seconds: float | None, sends: bool = True) -> None:
        value = timeval(seconds)
        try:
            self.sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVTIMEO, value)
            if sends:
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
        if not self.wait_readable(0.0):  # as nearly always, and cheaper than an exception
            return False
        try:
            return not self.sock.recv(1, _MSG_PEEK)
        except BlockingIOError:
            return False
        except OSError:
            return True

    def taken(self, sent: int, received: int) -> tuple[int, bool] | None:
        return None

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
# So many bytes are sooner joined than walked through by the kernel as a list: of two or three
# buffers, of more.
_FEW = 1 << 11
_LITTLE = 1 << 17


def _fewest(buffers: Sequence[Buffer]) -> Sequence[Buffer]:
    """The same bytes, in one buffer where that is cheaper."""
    if sum(map(len, buffers)) >= (_FEW if len(buffers) < 4 else _LITTLE):
        return buffers
    return (b"".join(buffers),)


def send_all(sock: socket.socket, buffers: Sequence[Buffer]) -> None:
    """One system call for all buffers; more only if the kernel takes less."""
    if not hasattr(sock, "sendmsg"):  # Windows
        sock.sendall(b"".join(buffers))
        return
    rest: list[Buffer] = list(buffers)
    while rest:
        _drop_sent(rest, sock.sendmsg(rest[:_IOV_MAX]))


def _drop_sent(rest: list[Buffer], sent: int) -> None:
    """Take `sent` bytes off the beginning."""
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
