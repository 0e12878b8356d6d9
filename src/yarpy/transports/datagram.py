"""UDP and multicast sockets: each send is one datagram, each receive is one datagram.

Rules: receive buffers are asked for generously, since what the kernel drops is lost; it
counts that (SO_RXQ_OVFL on Linux), `dropped` has the sum. Sending is paced, since receivers of
other programs have less room. A UDP sender is connected, so that it learns when its target's port
is no longer open. What comes from another computer than the one that has greeted is nobody's: who
may write was decided about that one.
"""

from __future__ import annotations

import socket
import struct
import sys
from collections.abc import Sequence

from yarpy.transports.base import Address, Transport
from yarpy.transports.bind import listening_host
from yarpy.transports.opener import MeetingPlace, Opener
from yarpy.transports.pace import Pace
from yarpy.transports.socket_transport import MSG_DONTWAIT, SocketTransport
from yarpy.wire.stream import Buffer

RECEIVE_BUFFER = 1 << 23
_LEAST = 64  # bytes that even an empty datagram counts for
_SO_RXQ_OVFL = 40 if sys.platform.startswith("linux") else 0


class DatagramTransport(SocketTransport):
    """A UDP socket, connected or not. `source`: only what comes from this address is received."""

    def __init__(
        self, sock: socket.socket, target: Address | None = None, source: str = ""
    ) -> None:
        super().__init__(sock)
        self._target = target
        self._source = source
        self._connected = False
        self._woken = False
        self._pace = Pace()
        self._room = RECEIVE_BUFFER  # bytes that may still be read after the wake-up
        self.dropped = 0  # datagrams that the kernel dropped because its buffer was full
        for size in (RECEIVE_BUFFER, RECEIVE_BUFFER // 8):
            try:
                sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, size)
                break
            except OSError:
                continue
        if sys.platform == "linux" and _SO_RXQ_OVFL:
            sock.setsockopt(socket.SOL_SOCKET, _SO_RXQ_OVFL, 1)

    def use(self, sock: socket.socket) -> None:
        super().use(sock)
        self.recv_call = self.send_call = None  # senders and losses are looked at as well

    @property
    def remote(self) -> Address:
        return self._target or ("", 0)

    @property
    def port(self) -> int:
        return self.local[1]

    def recv_into(self, view: memoryview) -> int:
        while True:
            if self._woken:
                return self._rest(view)
            try:
                count = self.receive(self._recv_datagram, view)
            except BrokenPipeError:  # Windows' word for a wake-up
                if not self._woken:
                    raise
                continue
            if count:
                return count  # an empty datagram is not an end: anybody can send one

    def _rest(self, view: memoryview) -> int:
        """Return the size of what had come before the wake-up: it was sent before the end. 0 when
        that is all."""
        while self._room > 0:  # a sender that goes on is not read for ever
            try:
                count = self._recv_datagram(view, MSG_DONTWAIT)
            except OSError:
                break
            self._room -= max(count, _LEAST)
            if count:
                return count
        return 0

    def _recv_datagram(self, view: memoryview, flags: int = 0) -> int:
        """The size of the next datagram, 0 if it is empty or not for us."""
        if sys.platform == "linux" and _SO_RXQ_OVFL:
            count, ancillary, _, sender = self.sock.recvmsg_into([view], 64, flags)
            for level, kind, data in ancillary:
                if level == socket.SOL_SOCKET and kind == _SO_RXQ_OVFL:
                    (self.dropped,) = struct.unpack("=I", data)
        else:
            count, sender = self.sock.recvfrom_into(view, 0, flags)
        # (a connected socket is told no sender)
        return count if not (self._source and sender) or sender[0] == self._source else 0

    def try_recv_into(self, view: memoryview) -> int:
        while True:
            try:
                count = self._recv_datagram(view, MSG_DONTWAIT)
            except BlockingIOError:
                return -1
            if count or self._woken:
                return count

    def send(self, buffers: Sequence[Buffer]) -> None:
        for datagram in buffers:
            if self._target is None:
                raise OSError("this datagram socket only receives")
            self._pace.wait(len(datagram))
            if self._woken:
                raise OSError("closed while it was sending")
            if self._polling is not None:  # there a call does not wait for room
                to = () if self._connected else (self._target,)
                self._polling.send(self.sock.sendto if to else self.sock.send, datagram, *to)
            elif self._connected:
                self.sock.send(datagram)
            else:
                self.sock.sendto(datagram, self._target)

    def try_send(self, buffers: Sequence[Buffer]) -> list[Buffer]:
        """Datagrams wait for no reader."""
        self.send(buffers)
        return []

    def connect(self) -> None:
        """Let sending raise an error when the target's port is not open."""
        if self._target is not None:
            self.sock.connect(self._target)
            self._connected = True

    def ended(self) -> bool:
        return self._connected and self.sock.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR) != 0

    def interrupt(self) -> None:
        self._woken = True
        super().interrupt()
        if self._target is None:
            # An unconnected UDP socket does not notice a shutdown: an empty datagram wakes it.
            try:
                with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as waker:
                    waker.sendto(b"", (listening_host() or "127.0.0.1", self.port))
            except OSError:
                pass


def open_udp(listen: bool, local: Address, remote: Address, port: int) -> DatagramTransport:
    """The UDP side of a connection that greeted over TCP from `local` to `remote`.

    The initiator sends from the number of its TCP port, which the peer may have noted.
    """
    sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        if listen:
            sock.bind((listening_host(), 0))
            return DatagramTransport(sock, source=remote[0])
        try:
            sock.bind(("", local[1]))
        except OSError:
            sock.bind(
                ("", 0)
            )  # taken by another program; C++ does not check where datagrams are from
        sender = DatagramTransport(sock, (remote[0], port))
        sender.connect()
        return sender
    except OSError:
        sock.close()
        raise


def open_mcast(
    listen: bool, local: Address, remote: Address, group: str, port: int
) -> DatagramTransport:
    """Join a multicast group, or send to it, on the interface that has the address `local`; the
    peer has greeted from `remote`."""
    sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        interface = socket.inet_aton(local[0])
        if not listen:
            sock.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, interface)
            sock.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 1)
            sock.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_LOOP, 1)
            return DatagramTransport(sock, (group, port))
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if hasattr(socket, "SO_REUSEPORT") and sys.platform == "darwin":
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        # Bound to the group itself, so that other traffic to this number stays out.
        sock.bind((group if sys.platform != "win32" else "", port))
        membership = socket.inet_aton(group) + interface
        sock.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
        return McastReceiver(sock, group, remote[0])
    except OSError:
        sock.close()
        raise


class McastReceiver(DatagramTransport):
    """A member of a group; leaving it wakes the receiver with a short receive timeout."""

    def __init__(self, sock: socket.socket, group: str, source: str = "") -> None:
        super().__init__(sock, source=source)
        self._group = group
        super().limit_waiting(0.25)  # a datagram to wake us would go to the whole group

    def limit_waiting(self, seconds: float | None, sends: bool = True) -> None:
        """Keeps its own short limit."""

    def recv_into(self, view: memoryview) -> int:
        while not self._woken:
            try:
                return super().recv_into(view)
            except BlockingIOError:
                continue
        while self._rest(view):
            # Not handed on: if the sender has reconnected, its new connection gets them as well.
            self.dropped += 1
        return 0

    def interrupt(self) -> None:
        self._woken = True


class Udp(Opener):
    """Datagrams from one port to another."""

    name = "udp"
    meets = False
    datagrams = True

    @classmethod
    def meet(cls, place: MeetingPlace) -> Transport:
        through = place.through
        return open_udp(place.listen, through.local, through.remote, place.port)


class Mcast(Opener):
    """Datagrams from one port to a group."""

    name = "mcast"
    meets = False
    datagrams = True

    @classmethod
    def meet(cls, place: MeetingPlace) -> Transport:
        listen, group, port = place.listen, place.group, place.port
        return open_mcast(listen, place.through.local, place.through.remote, group, port)
