"""TCP: where every connection begins.

Rules: TCP_NODELAY always (messages are sent whole); a peer whose host vanishes silently, by a cut
cable or a power failure, is noticed within half a minute by both sides (`peer_timeout.py`); the
listening socket takes every local address, or the one that `bind` says. To a program on the same
computer little is under way at a time (NEAR).
"""

from __future__ import annotations

import socket
import sys
import time
from functools import partial
from typing import Any, Final

from yarpy import scope
from yarpy.contact import Contact
from yarpy.errors import AddressError
from yarpy.platform.connecting import Connecting
from yarpy.route import Route
from yarpy.threads import Thread
from yarpy.transports.base import Address
from yarpy.transports.bind import listening_host
from yarpy.transports.opener import CONNECT_TIMEOUT, MeetingPlace, Opener
from yarpy.transports.peer_timeout import ZeroWindowTimeout, notice_death
from yarpy.transports.socket_transport import SocketTransport
from yarpy.transports.tcp_info import tcp_info

# Bytes on their way to a program on this computer. Left to itself, Linux lets megabytes of an image
# pile up, which then have left the processor's cache before the reader copies them. With 112 to 208
# KiB images come up to 1.5 times as fast; from 256 on the gain is gone, with 80 it is small. Less
# than a segment of the loopback (64 KiB) would wait for delayed acknowledgements.
NEAR: Final = 176 << 10


class TcpTransport(SocketTransport):
    """A connected TCP socket."""

    scheme = "tcp"

    def __init__(self, sock: socket.socket) -> None:
        super().__init__(sock)
        # Bytes that the peer's system has confirmed already: the dialling side's SYN counts.
        info = tcp_info(sock)
        self._origin = info.confirmed if info else 0
        if sock.family != getattr(socket, "AF_UNIX", None):
            sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            notice_death(sock)
            _limit_what_is_near(sock)
        self._zero_window = ZeroWindowTimeout()

    def limit_silence(self, seconds: float) -> bool:
        if self.sock.family != getattr(socket, "AF_UNIX", None):
            notice_death(self.sock, seconds)
            self._zero_window = ZeroWindowTimeout(seconds)
        return True

    def peek(self) -> int:
        first = self.receive(self.sock.recv, 1, socket.MSG_PEEK)
        return first[0] if first else -1

    def taken(self, sent: int, received: int) -> tuple[int, bool] | None:
        """As of every transport.

        A system that closes a connection says goodbye (FIN) if the program had read all that came,
        otherwise it resets it; but a program may also say it (shutdown) before it has read all, or
        end with what it has read in its hands. The goodbye counts as a byte; and what we send after
        it is not confirmed any more.
        """
        info = tcp_info(self.sock)
        if info is None:
            return None
        return info.confirmed - self._origin, info.came == received + 1 and self.ended()

    def spare_slow_reader(self) -> None:
        if self.sock.family != getattr(socket, "AF_UNIX", None) and self._zero_window.expired(
            self.sock
        ):
            self.interrupt()

    def limit_unsent(self, size: int) -> None:
        option = getattr(socket, "TCP_NOTSENT_LOWAT", None)
        if option is not None:
            self.sock.setsockopt(socket.IPPROTO_TCP, option, size)


def _limit_what_is_near(sock: socket.socket) -> None:
    if sys.platform == "linux":
        try:
            if sock.getpeername()[0] == sock.getsockname()[0]:
                sock.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, NEAR)
        except OSError:
            pass  # closed already: reading tells


def dial(host: str, port: int, timeout: float = CONNECT_TIMEOUT) -> TcpTransport:
    """Connect to a port. Raises OSError (ConnectionRefusedError ...), AddressError."""
    if not 0 < port < 65536:
        raise AddressError(f"{host}:{port}: a TCP port number lies between 1 and 65535")
    return TcpTransport(connected(host, port, timeout))


def connected(
    host: str, port: int, timeout: float, make: type[socket.socket] = socket.socket
) -> socket.socket:
    """Return a socket, of class `make`, that is connected to `host`:`port`. All of it, the look-up
    of a name included, takes `timeout` seconds at most, and ends with the call under way (`scope`).

    Raises OSError (TimeoutError, ConnectionRefusedError ...), AddressError.
    """
    limit = time.monotonic() + scope.left(timeout)
    failure: OSError | None = None
    addresses = _addresses(host, port, limit)
    for number, (family, kind, protocol, _, address) in enumerate(addresses):
        left = (limit - time.monotonic()) / (len(addresses) - number)
        if left <= 0.0:
            break
        try:
            sock = make(family, kind, protocol)
        except OSError as error:  # of a family that this system does not have
            failure = error
            continue
        try:
            attempt = Connecting(sock, left)
            with scope.waking(attempt.give_up):
                attempt.run(address)
            return sock
        except OSError as error:
            sock.close()
            failure = error
        except BaseException:
            sock.close()
            raise
    raise failure or TimeoutError("timed out")


def _addresses(host: str, port: int, limit: float) -> list[Any]:
    """Return what the system knows of a host, as socket.getaddrinfo does. Raises OSError."""
    look = partial(socket.getaddrinfo, port=port, type=socket.SOCK_STREAM)
    if host.isascii() and "\0" not in host:
        try:  # as bytes: the encoding of names for DNS takes a while to load
            return look(host.encode(), flags=socket.AI_NUMERICHOST)
        except socket.gaierror:
            pass  # a name, which somebody has to be asked for, who may be silent for long
    found: list[Any] = []
    failed: list[Exception] = []
    waiter = scope.Waiter()

    def ask() -> None:
        try:
            found.extend(look(host))
        except (OSError, UnicodeError) as error:
            failed.append(error)
        waiter.wake()

    Thread(target=ask, name=f"yarpy look up {host}", daemon=True).start()
    waiter.wait(limit - time.monotonic())
    if failed and isinstance(failed[0], UnicodeError):
        raise AddressError(f'"{host}" is no host name: {failed[0]}') from failed[0]
    if failed:
        raise failed[0]
    if not found:
        raise TimeoutError(f"nobody says where {host} is")
    return found


def is_taken(port: int) -> bool:
    """Return whether that port number of this computer is in use: by a listener, or by an outgoing
    connection."""
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

    `close` also wakes a thread that watches `sock` for something to read.
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
        """The next connection, without waiting; who reads from it waits. Raises BlockingIOError if
        there is none."""
        sock, raw = self.sock.accept()
        if sys.platform != "linux":  # on Windows and the BSDs it has the ways of the listener
            sock.setblocking(True)
        return sock, (str(raw[0]), int(raw[1]))

    @property
    def closed(self) -> bool:
        """Return whether `close` was called."""
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


class Tcp(Opener):
    """Connections of the system, and another one to the same peer."""

    name = "tcp"

    @classmethod
    def dial(cls, contact: Contact, timeout: float, route: Route | None = None) -> TcpTransport:
        return dial(contact.host, contact.port, timeout)

    @classmethod
    def meet(cls, place: MeetingPlace) -> TcpTransport:
        return dial(*place.through.remote, place.timeout)
