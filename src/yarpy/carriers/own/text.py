"""text and text_ack: what a person types into telnet or netcat.

Rules: a line with the port command, then, for data and admin, a line with the payload in Bottle
text. A payload continues on the next lines while a bracket or quote is open. `text_ack` answers
each command with a line `<ACK>`. Answers are for people: what a terminal would obey is escaped in
them, since a stranger may have stored it here. Data are what was sent, as for C++ YARP.
"""

from __future__ import annotations

from yarpy.carriers.base import ASKS_FOR_KEY, OVER_TCP, Carrier, Limits, introduce
from yarpy.data import codec
from yarpy.data.text_reader import Balance
from yarpy.errors import RemoteProtocolError
from yarpy.limit import TEXT_LINE
from yarpy.wire import framing
from yarpy.wire.message import Lines, Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

_END = b"\r\n"
# What a terminal obeys, not what it ignores, which C++ YARP sends as it is. Bytes beyond ASCII that
# are no UTF-8 are surrogates here.
_SUSPECT = bytes((5, 7, 8, 11, 12, 14, 15, 17, 19, 27, *range(127, 160)))  # bytes of such
_OBEYED = {
    code: f"\\x{code & 0xFF:02x}" for code in (*_SUSPECT, *range(0xDC80, 0xDCA0))
}  # and what is shown of them; a table, for a pattern would take a millisecond to be made


class Text(Carrier):
    """`CONNECT name`, then lines."""

    name = "text"
    words = OVER_TCP
    magic = b"CONNECT "
    spelling = "text"
    limits = Limits(message_timeout=600.0)  # people type slowly
    _welcomed = True  # whether the welcome that answers our greeting was read

    def greet(self, stream: ByteStream) -> Steps[None]:
        stream.write(self.magic + self.route.specifier.encode() + _END)
        self._welcomed = False
        return
        yield

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[None]:
        try:
            line = yield from stream.read_line(framing.MAX_NAME)
        except RemoteProtocolError:
            stream.write(f"* Error. A name has at most {framing.MAX_NAME} bytes.".encode() + _END)
            raise
        yield from introduce(self, stream, line.decode("utf-8", "replace"))
        stream.write(f"Welcome {self.route.source}".encode() + _END)

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        envelope = b" " + packet.envelope if packet.envelope else b""
        stream.write(packet.key.encode() + envelope + _END + packet.line + _END)

    def decode(self, stream: ByteStream) -> Steps[Message]:
        command = yield from stream.read_line(framing.MAX_COMMAND)
        message = framing.parse_command(command.decode("utf-8", "surrogateescape"))
        message.spelling = "text"
        if message.key in ("d", "D", "a"):
            message.payload = yield from read_text(stream, min(stream.limit, TEXT_LINE))
        return message

    def encode_quit(self, stream: ByteStream) -> None:
        stream.write(b"q" + _END)

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        stream.write(reply_text(value))

    def expect_reply(self, stream: ByteStream) -> Steps[Message | None]:
        if not self._welcomed:
            # A C++ sender never reads the welcome; to find a reply, we must skip it.
            self._welcomed = True
            yield from stream.read_line(framing.MAX_NAME + 16)
        line = yield from read_text(stream, min(stream.limit, TEXT_LINE))
        return None if line == b"<ACK>" else Message("d", line, spelling="text")

    def encode_ack(self, stream: ByteStream, count: int) -> None:
        stream.output += ((b"<ACK>" + _END) * count,)

    def expect_ack(self, stream: ByteStream) -> Steps[None]:
        line = yield from stream.read_line(TEXT_LINE)
        if line != b"<ACK>":
            raise RemoteProtocolError(f"expected an acknowledgement, got {line[:40]!r}")

    def encode_lines(self, stream: ByteStream, lines: list[str]) -> None:
        for line in lines:
            stream.write(_tame(line.encode("utf-8", "surrogateescape")) + _END)


class TextAck(Text):
    """`CONNACK name`: the same with acknowledgements; the initiator reads the welcome."""

    name = "text_ack"
    magic = b"CONNACK "
    acks = True

    def greet(self, stream: ByteStream) -> Steps[None]:
        yield from super().greet(stream)
        line = yield from stream.read_line(framing.MAX_NAME + 16)
        if not line.startswith(b"Welcome"):
            if (error := framing.refused(line)) is not None:
                raise error
            raise RemoteProtocolError(f"expected a welcome, got {line[:40]!r}; {ASKS_FOR_KEY}")
        self._welcomed = True

    def expect_reply(self, stream: ByteStream) -> Steps[Message | None]:
        """A reply line, or None if the acknowledgement comes next; it is left unread."""
        yield from stream.more(5)
        if stream.buffer.startswith(b"<ACK>", stream.head):
            return None
        return (yield from super().expect_reply(stream))


def reply_text(value: object) -> bytes:
    """A reply as shown to people: a line of text, or its own lines."""
    return _tame(value.to_text() if isinstance(value, Lines) else codec.encode_text(value) + _END)


def _tame(text: bytes) -> bytes:
    """The text with escapes in place of the control characters that a terminal obeys, those beyond
    ASCII (C1) too."""
    if len(text.translate(None, _SUSPECT)) < len(text):
        shown = text.decode("utf-8", "surrogateescape").translate(_OBEYED)
        return shown.encode("utf-8", "surrogateescape")
    return text


def read_text(stream: ByteStream, limit: int) -> Steps[bytes]:
    """One payload: a line, and more lines while a bracket or quote is open."""
    text = bytearray((yield from stream.read_line(limit)))
    balance = Balance()
    closed = balance.feed(bytes(text))
    while not closed:
        line = b"\n" + (yield from stream.read_line(limit))
        text += line
        if len(text) > limit:
            raise RemoteProtocolError(f"a text message of more than {limit} bytes")
        closed = balance.feed(line)
    return bytes(text)
