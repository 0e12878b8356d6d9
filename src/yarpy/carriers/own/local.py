"""local: both ports are in this process; objects pass by reference, nothing is encoded.

Rules: the TCP connection only introduces the two ends to each other. A peer in another process
cannot be found in this process's table, so it is refused at once.
"""

from __future__ import annotations

from yarpy.carriers.base import Carrier, Delivery
from yarpy.facts import Reach
from yarpy.wire.effects import Open, Switch
from yarpy.wire.message import Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream, ObjectStream


class Local(Carrier):
    """References within one process."""

    name = "local"
    words = ()
    over = "inproc"
    magic = b"LOCALITY"
    spelling = "object"
    reaches = Reach(same_program=True)
    delivery = Delivery(coalesces=False)

    def greet(self, stream: ByteStream) -> Steps[None]:
        handle = yield Open("inproc", listen=False)
        yield from super().greet(stream)
        yield Switch(handle, ObjectStream())

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[None]:
        yield from super().welcome(stream, first)
        handle = yield Open("inproc", listen=True)
        yield Switch(handle, ObjectStream())

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        assert isinstance(stream, ObjectStream)
        envelope = packet.envelope.decode("utf-8", "replace")
        stream.write_object(Message(packet.key, packet.value, envelope, "object"))

    def decode(self, stream: ByteStream) -> Steps[Message]:
        assert isinstance(stream, ObjectStream)
        message = yield from stream.read_object()
        assert isinstance(message, Message)
        return message

    def encode_quit(self, stream: ByteStream) -> None:
        assert isinstance(stream, ObjectStream)
        stream.write_object(Message("q", spelling="object"))

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        assert isinstance(stream, ObjectStream)
        stream.write_object(Message("d", value, spelling="object"))

    def expect_reply(self, stream: ByteStream) -> Steps[Message | None]:
        return (yield from self.decode(stream))
