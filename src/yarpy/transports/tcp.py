"""TCP: where every connection begins.

Rules: TCP_NODELAY always (messages are sent whole); keepalive notices within half a minute a peer
that vanishes silently, by a cut cable or a power failure; the listening socket takes every local
address, or the one that `bind` says.
"""

from __future__ import annotations

import select
import socket
import sys
from typing import Final

from yarpy.errors import AddressError
from yarpy.transports.base import Address, SocketTransport
from yarpy.transports.bind import listening_host

CONNECT_TIMEOUT = 10.0  # seconds, as C++ YARP

# After 10 s of silence the kernel sends keepalive probes, three of them.
_KEEP_ALIVE: Final = {"TCP_KEEPIDLE": 10, "TCP_KEEPINTVL": 5, "TCP_KEEPCNT": 3}


class TcpTransport(SocketTransport):
    """A connected TCP socket."""

    def __init__(self, sock: socket.socket) -> None:
        super().__init__(sock)
        if sock.family != getattr(socket, "AF_UNIX", None):
            sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
            for name, value in _KEEP_ALIVE.items():
                if hasattr(socket, name):  # not everywhere
                    sock.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), value)

    def peek(self) -> int:
        """The first byte that comes, left unread; -1 for the end."""
        first = self.sock.recv(1, socket.MSG_PEEK)
        return first[0] if first else -1

    def limit_unsent(self, size: int) -> None:
        """Limit the unsent bytes in the kernel to `size`, on systems that can."""
        option = getattr(socket, "TCP_NOTSENT_LOWAT", None)
        if option is not None:
            self.sock.setsockopt(socket.IPPROTO_TCP, option, size)


def dial(host: str, port: int, timeout: float = CONNECT_TIMEOUT) -> TcpTransport:
    """Connect to a port. Raises OSError (ConnectionRefusedError ...), AddressError."""
    if not 0 < port < 65536:
        raise AddressError(f"{host}:{port}: a TCP port number lies between 1 and 65535")
    try:
        return TcpTransport(socket.create_connection((host, port), timeout))
    except UnicodeError as error:  # from the encoding of names for DNS
        raise AddressError(f'"{host}" is no host name: {error}') from error


def is_taken(port: int) -> bool:
    """Whether that port number of this computer is in use: by a listener, or by an outgoing
    connection.
    """
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as sock:
        try:
            if sys.platform != "win32":
                sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            sock.bind(("", port))
        except OSError:
            return True
    return False


class TcpListener:
    """A listening socket on all IPv4 addresses, or the one of YARPY_BIND; `port` 0 for any number.

    `wait` watches it together with connections that have not sent anything yet.
    """

    def __init__(self, port: int = 0) -> None:
        self.sock = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        try:
            if sys.platform != "win32":
                self.sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            self.sock.bind((listening_host(), port))
            self.sock.listen(1024)
        except OSError:
            self.sock.close()
            raise
        self.sock.setblocking(False)
        self._host: str = self.sock.getsockname()[0]
        self.port: int = self.sock.getsockname()[1]
        self._closed = False

    def accept(self) -> tuple[socket.socket, Address]:
        """The next connection, without waiting. Raises BlockingIOError if there is none."""
        sock, raw = self.sock.accept()
        return sock, (str(raw[0]), int(raw[1]))

    def wait(self, silent: dict[int, socket.socket], timeout: float | None) -> list[int]:
        """File numbers among `silent` and our own that have something to read."""
        own = self.sock.fileno()
        if own < 0:
            return []
        if not hasattr(select, "poll"):  # Windows
            ready, _, _ = select.select([own, *silent], [], [], timeout)
            return list(ready)
        poll = select.poll()
        for number in (own, *silent):
            poll.register(number, select.POLLIN)
        return [number for number, _ in poll.poll(None if timeout is None else timeout * 1000)]

    @property
    def closed(self) -> bool:
        """Whether `close` was called."""
        return self._closed

    def close(self) -> None:
        """Stop listening and wake the thread that waits."""
        if self._closed:
            return
        self._closed = True
        try:
            self.sock.shutdown(socket.SHUT_RDWR)
        except OSError:
            # Not every system lets a listening socket be shut down: a call from us wakes it as
            # well.
            try:
                host = "127.0.0.1" if self._host == "0.0.0.0" else self._host
                socket.create_connection((host, self.port), 1.0).close()
            except OSError:
                pass

    def release(self) -> None:
        """Give the number back; called by the thread that waited."""
        self.sock.close()
