"""Asking: what our client says over either way to a server, a socket (`carrier.py`) or HTTP
(`post.py`).

Rules: a call is known by its number, those of a connection follow each other. Only the clients of
a service speak.
"""

from __future__ import annotations

from yarpy.carriers.base import Carrier, Delivery, Limits
from yarpy.data.value import Buffer
from yarpy.errors import DecodeError, RemoteProtocolError
from yarpy.facts import SOCKET
from yarpy.kits.thrift.apache.decode import READERS
from yarpy.kits.thrift.apache.message import Asked, Returned, written
from yarpy.kits.thrift.apache.protocol import CALL, Head
from yarpy.route import Route
from yarpy.wire.message import Packet
from yarpy.wire.stream import ByteStream


class Asking(Carrier):
    """The base of connections to a server."""

    name = "thrift"
    acks = True
    reaches = SOCKET
    delivery = Delivery(coalesces=False)
    limits = Limits(ack_timeout=60.0)

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self.spelled = "compact" if "compact" in route.spec.tokens else "binary"
        self._number = 0  # of our last call
        self._awaits = False  # our last call has an answer that was not read

    def _send(self, stream: ByteStream, data: bytes) -> None:
        """Write a whole message."""
        raise NotImplementedError

    def prepare(self, packet: Packet) -> bool:
        return isinstance(packet.value, Asked)

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        asked = packet.value
        if not isinstance(asked, Asked) or asked.thrift != self.spelled:
            raise TypeError(
                "over thrift only the clients of a service speak: Camera.connect(...) of "
                "yarpy.idl.load(...)"
            )
        self._number = self._number % 0x7FFFFFFF + 1
        self._awaits = asked.kind == CALL
        head = Head(asked.kind, asked.name, self._number)
        self._send(stream, written(self.spelled, head, asked.body))

    def encode_quit(self, stream: ByteStream) -> None:
        """Only closing ends the connection."""

    def _returned(self, data: Buffer) -> Returned:
        """Return the answer to our last call. RemoteProtocolError for anything else."""
        try:
            reader = READERS[self.spelled](data)
            head = reader.head()
        except DecodeError as error:
            raise RemoteProtocolError(f"no answer of {self.route.spec}: {error}") from error
        if head.number != self._number:
            raise RemoteProtocolError(
                f"an answer to the call {head.number}, where {self._number} was asked last"
            )
        return Returned(self.spelled, head, data, reader.at)
