"""name_ser: the line protocol of name servers, `NAME_SERVER command`, spoken by every C++ client.

Rules: after the eight bytes of magic, four more (`VER `) are skipped; then each line is a message,
and the twelve bytes after it are skipped, whatever they are. No sender, no port commands.
"""

from __future__ import annotations

from yarpy.carriers.base import OVER_TCP, Carrier
from yarpy.carriers.own.text import reply_text
from yarpy.facts import Reach
from yarpy.limit import NAME_LINE
from yarpy.route import Route
from yarpy.wire.message import CALL, Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

_PREFIX = b"NAME_SERVER "


class NameSer(Carrier):
    """Lines for a name server."""

    name = "name_ser"
    words = OVER_TCP
    magic = b"NAME_SER"
    reaches = Reach(tells=False)
    spelling = "text"

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self._swallow = 4

    def greet(self, stream: ByteStream) -> Steps[None]:
        return
        yield

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[None]:
        self.route.source = "anon"
        return
        yield

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        stream.write(_PREFIX + packet.line.replace(b'"', b"") + b"\r\n")

    def decode(self, stream: ByteStream) -> Steps[Message]:
        yield from stream.skip(self._swallow)
        self._swallow = len(_PREFIX)
        line = yield from stream.read_line(NAME_LINE)
        return Message(CALL, line, spelling="text")

    def encode_quit(self, stream: ByteStream) -> None:
        """Only closing ends this protocol."""

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        stream.write(reply_text(value))

    def expect_reply(self, stream: ByteStream) -> Steps[Message | None]:
        return Message(CALL, (yield from stream.read_line(NAME_LINE)), spelling="text")

    def encode_ack(self, stream: ByteStream, count: int) -> None:
        """No acknowledgements."""
