"""mcast: one sender, one group, any number of receivers.

Rules: after its name the initiator sends the group's address and port (big-endian, unlike anything
else here); both sides then leave TCP. All mcast connections of a port share a group, and one of
them sends for all.
"""

from __future__ import annotations

from yarpy.carriers.base import Delivery
from yarpy.carriers.own.udp import Datagrams
from yarpy.errors import RemoteProtocolError
from yarpy.wire.effects import Group, Open, Switch
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream, DatagramStream


class Mcast(Datagrams):
    """Datagrams to a group."""

    name = "mcast"
    over = "mcast"
    code = 1
    delivery = Delivery(coalesces=False, connectionless=True, broadcast=True)

    def greet(self, stream: ByteStream) -> Steps[None]:
        yield from super().greet(stream)
        group, port = yield Group()
        stream.write(bytes(map(int, group.split("."))) + port.to_bytes(2, "big"))
        handle = yield Open("mcast", listen=False, group=group, port=port)
        yield Switch(handle, DatagramStream(stream.limit))

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[None]:
        yield from super().welcome(stream, first)
        where = bytes((yield from stream.read_exact(6)))
        if not 224 <= where[0] <= 239:
            raise RemoteProtocolError(f"{'.'.join(map(str, where[:4]))} is not a multicast address")
        group, port = ".".join(map(str, where[:4])), int.from_bytes(where[4:], "big")
        yield from self.find_room(stream)
        handle = yield Open("mcast", listen=True, group=group, port=port)
        yield Switch(handle, DatagramStream(stream.limit))
