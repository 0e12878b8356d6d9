"""udp: greets over TCP, then sends each message as datagrams with a checksum and a number.

Rules: the acceptor opens a UDP socket and sends its port; the initiator sends from the UDP port
with the number of its TCP port. Nothing comes back; if a piece is lost, its message is dropped and
counted. Anybody can forge a datagram: none ends a connection, and none is a command.
"""

from __future__ import annotations

from yarpy.carriers.base import Delivery, Indexed
from yarpy.errors import RemoteProtocolError, YarpError
from yarpy.route import Route
from yarpy.wire import framing
from yarpy.wire.datagram import MAX_DATAGRAM, Assembler, split
from yarpy.wire.effects import SEND_DATAGRAMS, May, Open, Switch
from yarpy.wire.message import CALL, DATA, Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import Buffer, ByteStream, DatagramStream


class Datagrams(Indexed):
    """The base of udp and mcast: messages split into datagrams."""

    words = ()
    replies = False
    delivery = Delivery(coalesces=False, connectionless=True)
    datagram_size = MAX_DATAGRAM

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self._assembler: Assembler | None = None

    def parse(self, stream: ByteStream) -> Message | None:
        return None

    def find_room(self, stream: ByteStream) -> Steps[None]:
        """Turn the peer away, before it is told where to send to, from a port that has enough
        senders of datagrams. Raises RemoteProtocolError."""
        why = yield May(SEND_DATAGRAMS)
        if why:
            stream.write(framing.encode_refusal(why))
            raise RemoteProtocolError(why)

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        stream.write(*split(framing.encode(packet), self.datagram_size))

    def decode(self, stream: ByteStream) -> Steps[Message]:
        assert isinstance(stream, DatagramStream)
        assembler = self._assembler
        if assembler is None:
            assembler = self._assembler = Assembler(stream.limit)
        while True:
            whole = assembler.add((yield from stream.read_datagram()))
            message = parse_whole(whole, stream.limit) if whole is not None else None
            if message is not None and message.key not in (DATA, CALL):
                message = None  # datagrams carry no commands: anybody could send one
            if whole is not None and message is None:
                assembler.lost += 1
            self.lost = assembler.lost
            if assembler.idle:
                stream.pause()
            if message is not None:
                return message

    def encode_quit(self, stream: ByteStream) -> None:
        """Not sent in datagrams: the closing side tells the peer's port over a text connection."""


def parse_whole(data: Buffer, limit: int) -> Message | None:
    """The message, if `data` is exactly one, or None."""
    stream = ByteStream(limit, size=max(len(data), 1))
    stream.feed(data)
    stream.feed_eof()
    message = framing.parse_plain(stream)
    if message is not None:
        return message
    steps = framing.read_message(stream)
    try:
        next(steps)
    except StopIteration as stop:
        found: Message = stop.value
        return found
    except YarpError:
        pass
    return None


class Udp(Datagrams):
    """Datagrams to one receiver."""

    name = "udp"
    over = "udp"
    code = 0

    def greet(self, stream: ByteStream) -> Steps[None]:
        yield from super().greet(stream)
        port = framing.parse_number((yield from framing.read_answer(stream)))
        if not 0 < port < 65536:
            raise RemoteProtocolError(f"the peer offers UDP port {port}, which is not a valid one")
        handle = yield Open("udp", listen=False, port=port)
        yield Switch(handle, DatagramStream(stream.limit))

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[None]:
        yield from super().welcome(stream, first)
        yield from self.find_room(stream)
        handle = yield Open("udp", listen=True)
        stream.write(framing.number(handle.port))
        yield Switch(handle, DatagramStream(stream.limit))
