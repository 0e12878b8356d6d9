"""A link out of a port, to a peer that does what a test says."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from contextlib import contextmanager

from support.transport import ScriptTransport, scripted

from yarpy.carriers.base import Carrier
from yarpy.carriers.tcp import Tcp
from yarpy.link.driver import Driver
from yarpy.link.outbound import Outbound
from yarpy.route import Route
from yarpy.transports.tcp import TcpTransport
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
    return counter.messages + counter.drops + counter.unconfirmed


@contextmanager
def connected(kind: type[Carrier] = Tcp) -> Iterator[tuple[Outbound, socket.socket]]:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        near = socket.create_connection(listener.getsockname())
        far, _ = listener.accept()
    far.settimeout(5)
    far.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    link = Outbound(Driver(TcpTransport(near)), kind(Route("/here", "/peer", kind.name)))
    try:
        yield link, far
    finally:
        far.close()
        link.close(quit_=False)


def read_messages(far: socket.socket, count: int, ack: bool = True) -> list[bytes]:
    """Read so many messages of one size, acknowledging each."""
    size = len(b"".join(framing.encode(Packet([0]))))  # type: ignore[arg-type]
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
