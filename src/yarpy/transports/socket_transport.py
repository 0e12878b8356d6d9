"""SocketTransport: bytes over a socket, the base of transports on TCP, UDP and TLS.

Rules: one system call for each read and each send; nothing is joined that is cheaper as a list. The
socket is blocking and has no timeout of Python's (`base.py`); on Windows `polling.py` waits.
"""

from __future__ import annotations

import select
import socket
import struct
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any, TypeVar

from yarpy.errors import LocalProtocolError
from yarpy.transports.base import Address, Answerable
from yarpy.transports.descriptor import has_input
from yarpy.transports.polling import Polling
from yarpy.wire.stream import Buffer

T = TypeVar("T")


class SocketTransport(Answerable):
    """The base of transports on sockets."""

    sock: socket.socket
    whole = True

    def __init__(self, sock: socket.socket) -> None:
        self.sock = sock
        self.use(sock)

    def use(self, sock: socket.socket) -> None:
        """Send and receive through this socket."""
        self.sock = sock
        sock.setblocking(bool(MSG_DONTWAIT))
        self._polling = None if MSG_DONTWAIT else Polling(sock)
        #: What `recv_into` and `try_send` come down to: one call into the system each, which an
        #: exception out of a signal handler comes before or after. None: they do more than that.
        self.recv_call: Callable[..., int] | None = sock.recv_into if MSG_DONTWAIT else None
        self.send_call: Callable[..., int] | None = sock.send
        self._poll: Any = None  # tells when there is something to be read

    @property
    def local(self) -> Address:
        return address_of(self.sock.getsockname())

    @property
    def remote(self) -> Address:
        return address_of(self.sock.getpeername())

    def recv_into(self, view: memoryview) -> int:
        return self.sock.recv_into(view) if self._polling is None else self._polling.recv_into(view)

    def receive(self, call: Callable[..., T], *arguments: Any) -> T:
        """Return call(*arguments), which reads from the socket and waits as `recv_into` does."""
        waits = self._polling
        return call(*arguments) if waits is None else waits.receive(call, *arguments)

    def send_all(self, buffers: Sequence[Buffer]) -> None:
        """Hand all of them to the system, whatever the transport does to its bytes before."""
        if self._polling is not None:
            self._polling.send_all(buffers)
        elif len(buffers) == 1:
            self.sock.sendall(buffers[0])
        elif buffers:
            send_all(self.sock, buffers)

    def try_recv_into(self, view: memoryview) -> int:
        try:
            return self.sock.recv_into(view, 0, MSG_DONTWAIT)
        except BlockingIOError:
            return -1

    def send(self, buffers: Sequence[Buffer]) -> None:
        if len(buffers) > 1:
            buffers = _fewest(buffers)
        self.send_all(buffers)

    def try_send(self, buffers: Sequence[Buffer]) -> list[Buffer]:
        rest: list[Buffer] = []
        if len(buffers) > 1:
            buffers = _fewest(buffers)
        try:
            if len(buffers) == 1:  # as nearly always
                sent = self.sock.send(buffers[0], MSG_DONTWAIT)
                if sent == len(buffers[0]):
                    return rest
                return [memoryview(buffers[0])[sent:]]
            rest = [buffer for buffer in buffers if buffer]
            while rest:
                if sys.platform == "win32":  # it has no sendmsg
                    _drop_sent(rest, self.sock.send(rest[0]))
                    continue
                _drop_sent(rest, self.sock.sendmsg(rest[:_IOV_MAX], (), MSG_DONTWAIT))
        except BlockingIOError:
            return rest or list(buffers)
        return rest

    def wait_writable(self, seconds: float) -> bool:
        if self._polling is not None:
            return self._polling.wait(reads=False, seconds=seconds)
        number = self.sock.fileno()
        if number < 0:
            return True  # closed, as sending tells
        if sys.platform == "win32" or not hasattr(select, "poll"):
            return bool(select.select([], [number], [], seconds)[1])
        poll = select.poll()
        poll.register(number, select.POLLOUT)
        return bool(poll.poll(max(0.0, seconds) * 1000))

    def wait_readable(self, seconds: float) -> bool:
        if self._polling is not None:
            return self._polling.wait(reads=True, seconds=seconds)
        number = self.sock.fileno()
        if number < 0:
            return True  # closed, as reading tells
        if _POLL is None:
            return has_input(number, seconds)
        poll, self._poll = self._poll, None  # it serves one thread at a time
        if poll is None:
            poll = _POLL()
            poll.register(number, _READABLE)
        found = poll.poll(max(0.0, seconds) * 1000)
        self._poll = poll
        return bool(found)

    def limit_waiting(self, seconds: float | None, sends: bool = True) -> None:
        if self._polling is not None:
            self._polling.receiving = seconds
            if sends:
                self._polling.sending = seconds
            return
        value = _FOR_EVER if seconds is None else timeval(seconds)
        try:
            self.sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVTIMEO, value)
            if sends:
                self.sock.setsockopt(socket.SOL_SOCKET, socket.SO_SNDTIMEO, value)
        except OSError as error:
            if error.errno is None:
                raise  # out of a signal handler
            # Closed by another thread meanwhile: readers and writers get the error.

    def set_dscp(self, tos: int) -> None:
        if sys.platform == "win32":  # which takes the option, and does nothing
            if tos == self.tos():
                return
            raise LocalProtocolError(
                "Windows marks packets by its policies alone: as an administrator, New-NetQosPolicy"
                f" yarpy -AppPathNameMatchCondition python.exe -DSCPAction {tos >> 2}"
            )
        if self.sock.family == socket.AF_INET6:
            self.sock.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_TCLASS, tos)
        else:
            self.sock.setsockopt(socket.IPPROTO_IP, socket.IP_TOS, tos)

    def tos(self) -> int:
        if sys.platform == "win32":
            return 0
        try:
            if self.sock.family == socket.AF_INET6:
                return self.sock.getsockopt(socket.IPPROTO_IPV6, socket.IPV6_TCLASS)
            if self.sock.family == socket.AF_INET:
                return self.sock.getsockopt(socket.IPPROTO_IP, socket.IP_TOS)
        except OSError:
            pass  # closed meanwhile
        return 0

    def ended(self) -> bool:
        number = self.sock.fileno()
        if _POLL is None:
            if not self.wait_readable(0.0):
                return False
        elif number >= 0:  # spelled out, and cheaper than an exception
            poll, self._poll = self._poll, None  # it serves one thread at a time
            if poll is None:
                poll = _POLL()
                poll.register(number, _READABLE)
            found = poll.poll(0)
            self._poll = poll
            if not found:  # as nearly always
                return False
        try:
            return not self.sock.recv(1, _MSG_PEEK)
        except BlockingIOError:
            return False
        except OSError as error:
            self.failed(error)
            return True

    def hung_up(self) -> bool:
        number = self.sock.fileno()
        if _POLL is None or number < 0:
            return False
        poll = _POLL()
        poll.register(number, _HANGS_UP)
        return bool(poll.poll(0))

    def interrupt(self) -> None:
        if self._polling is not None:
            self._polling.interrupt()
        else:
            with suppress(OSError):  # not connected any more: no thread is waiting inside
                self.sock.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        (self._polling or self.sock).close()


# Plain numbers: combining the enumerations of `socket` costs as much as a system call.
MSG_DONTWAIT: int = int(getattr(socket, "MSG_DONTWAIT", 0))
_MSG_PEEK: int = int(socket.MSG_PEEK) | MSG_DONTWAIT
_POLL = getattr(select, "poll", None)  # not on Windows
_READABLE: int = getattr(select, "POLLIN", 0)
_HANGS_UP: int = getattr(select, "POLLRDHUP", 0)  # errors and POLLHUP are told of in any case
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


_FOR_EVER = timeval(None)


def address_of(raw: object) -> Address:
    """`(host, port)` of what the socket module calls an address."""
    if isinstance(raw, tuple) and len(raw) >= 2:
        host = str(raw[0])
        if len(raw) > 3 and raw[3] and "%" not in host:
            host += f"%{raw[3]}"  # a link-local address: on which network
        return host.removeprefix("::ffff:"), int(raw[1])
    return str(raw), 0
