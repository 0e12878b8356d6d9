"""unix_stream: greets over TCP, then both meet on a Unix socket of the same host.

Rules: no index; a port command is followed directly by the payload, which delimits itself. With the
modifier `+ack` (magic `UNIX_ACK`) each message, quit included, is answered with `ACK` and a NUL.
"""

from __future__ import annotations

from typing import ClassVar

from yarpy.carriers.base import Carrier
from yarpy.errors import RemoteProtocolError
from yarpy.facts import MAGIC_SIZE
from yarpy.wire import framing
from yarpy.wire.effects import Open, Switch
from yarpy.wire.message import Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

_ACK = b"ACK\0"


class UnixStream(Carrier):
    """Port commands and payloads on a Unix socket."""

    name = "unix_stream"
    words: ClassVar[tuple[str, ...] | None] = ("ack",)
    over = "unix"
    magic = b"UNIX_STR"

    @classmethod
    def recognises(cls, first: bytes) -> int:
        return MAGIC_SIZE if first in (b"UNIX_STR", b"UNIX_ACK") else 0

    def greet(self, stream: ByteStream) -> Steps[None]:
        self.acks = "ack" in self.route.spec.tokens
        magic = b"UNIX_ACK" if self.acks else b"UNIX_STR"
        stream.write(magic + framing.encode_name(self.route.specifier))
        handle = yield Open("unix", listen=False)
        yield Switch(handle, ByteStream(stream.limit))

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[None]:
        self.acks = first == b"UNIX_ACK"
        yield from super().welcome(stream, first)
        handle = yield Open("unix", listen=True)
        yield Switch(handle, ByteStream(stream.limit))

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        stream.write(framing.encode_command(packet.key, packet.envelope), *packet.blocks)

    def decode(self, stream: ByteStream) -> Steps[Message]:
        command = yield from framing.read_command(stream)
        if command is None:
            raise RemoteProtocolError("a message does not begin with a port command")
        message, _ = command
        if message.key in ("d", "D", "a"):
            message.payload = yield from framing.read_payload(stream)
        return message

    def encode_quit(self, stream: ByteStream) -> None:
        stream.write(framing.encode_command("q"))

    def expect_reply(self, stream: ByteStream) -> Steps[Message | None]:
        yield from stream.more(4)
        if self.acks and stream.buffer.startswith(_ACK, stream.head):
            return None
        return Message("d", (yield from framing.read_payload(stream, self.reply_end)))

    def encode_ack(self, stream: ByteStream, count: int) -> None:
        stream.output += (_ACK * count,)

    def expect_ack(self, stream: ByteStream) -> Steps[None]:
        answer = yield from stream.read_exact(4)
        if answer != _ACK:
            raise RemoteProtocolError(f"expected an acknowledgement, got {bytes(answer)!r}")
