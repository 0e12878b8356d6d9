"""A link out of a port, to a peer that does what a test says."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager

from support.transport import ScriptTransport, scripted

from yarpy.carriers.base import Carrier
from yarpy.carriers.own.tcp import Tcp
from yarpy.carriers.own.unix_stream import UnixStream
from yarpy.link.begin.greeting import driver_of
from yarpy.link.driver import Driver
from yarpy.link.send.outbound import Outbound
from yarpy.route import Route
from yarpy.transports.tcp import TcpTransport
from yarpy.transports.unix import UnixTransport
from yarpy.wire import framing
from yarpy.wire.message import Packet


def link_on(transport_driver: tuple[Driver, ScriptTransport], kind: type[Carrier]) -> Outbound:
    driver, _ = transport_driver
    return Outbound(driver, kind(Route("/here", "/peer", kind.name)))


def open_link(kind: type[Carrier], *incoming: bytes) -> tuple[Outbound, ScriptTransport]:
    """A link to a peer that says this and then nothing, without hanging up."""
    pair = scripted(*incoming, open_ended=True)
    return link_on(pair, kind), pair[1]


def total(link: Outbound) -> int:
    counter = link.counter
    return counter.messages + counter.replaced + counter.drops + counter.unconfirmed


@contextmanager
def connected(kind: type[Carrier] = Tcp) -> Iterator[tuple[Outbound, socket.socket]]:
    if issubclass(kind, UnixStream):
        near, far = socket.socketpair()
        transport: TcpTransport = UnixTransport("", False)
        transport.sock.close()
        transport.use(near)
    else:
        with socket.create_server(("127.0.0.1", 0)) as listener:
            near = socket.create_connection(listener.getsockname())
            far, _ = listener.accept()
        far.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        transport = TcpTransport(near)
    far.settimeout(5)
    link = Outbound(driver_of(transport), kind(Route("/here", "/peer", kind.name)))
    try:
        yield link, far
    finally:
        far.close()
        link.close(quit_=False)


@contextmanager
def at_work(link: Outbound) -> Iterator[None]:
    """Another thread is sending: nothing else leaves meanwhile."""
    held, done = threading.Event(), threading.Event()

    def hold() -> None:
        with link.sender.lock:
            held.set()
            done.wait()

    thread = threading.Thread(target=hold)
    thread.start()
    held.wait()
    try:
        yield
    finally:
        done.set()
        thread.join()


def read_messages(far: socket.socket, count: int, ack: bool = True) -> list[bytes]:
    """Read so many messages of one size, acknowledging each."""
    size = len(b"".join(framing.encode(Packet([0]))))  # type: ignore[arg-type]
    # Through a Unix socket a message is its command and its payload.
    if far.family == getattr(socket, "AF_UNIX", None):
        packet = Packet([0])
        size = len(framing.encode_command(packet.key)) + sum(map(len, packet.blocks))
    found = []
    for _ in range(count):
        data = b""
        while len(data) < size:
            part = far.recv(size - len(data))
            assert part
            data += part
        found.append(data)
        if ack:
            far.sendall(framing.ACK)
    return found
