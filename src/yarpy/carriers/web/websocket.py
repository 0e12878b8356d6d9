"""websocket: web pages read and write a port, over `ws://HOST:PORT/?ws`.

    new WebSocket("ws://host:port/?ws")                     port commands and binary Bottles, as C++
    new WebSocket("ws://host:port/?ws", "yarp.json")        each text frame is a message in JSON
    new WebSocket("ws://host:port/?ws&read", "yarp.json")   everything that the port writes, as JSON
    new WebSocket("ws://host:port/", "mqtt")                the protocol of another carrier

Rules: in binary, the payloads of all frames form one byte stream, as on a unix_stream connection;
each outgoing block is a frame. In JSON each frame is a message or a reply; `&admin` sends them to
the administration, `&envelope` wraps what is read as `{"envelope": "7 1.5", "data": [...]}`;
pictures and clouds are sent as size and kind only, or whole with `&pixels`. Pings are answered, a
close is answered and ends the connection. A page that reads too slowly misses messages. `origin`
says which pages may write. wsproto reads and writes the frames.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Final, TypeVar

from yarpy import registry
from yarpy.carriers.base import OVER_TCP, Carrier, Delivery
from yarpy.carriers.web.http.header import read_headers
from yarpy.carriers.web.http.refusal import refuse, screen, screen_page
from yarpy.carriers.web.http.token import claim
from yarpy.carriers.web.upgrade import ask_for_websocket, grant_websocket
from yarpy.data import codec
from yarpy.data.json import from_json, to_json
from yarpy.data.value import Vocab
from yarpy.errors import AccessRefused, DecodeError, LinkClosed, RemoteProtocolError
from yarpy.facts import MAGIC_SIZE, Reach
from yarpy.limit import HTTP_LINE, WEBSOCKET_TEXT
from yarpy.route import Route
from yarpy.wire import framing
from yarpy.wire.effects import HEAR, Switch
from yarpy.wire.frame_stream import (
    BINARY,
    CLOSE,
    CONTINUATION,
    PING,
    PONG,
    PROTOCOL_ERROR,
    TEXT,
    FrameStream,
    frame,
)
from yarpy.wire.message import ADMIN, CALL, QUIT, Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

if TYPE_CHECKING:
    from wsproto.frame_protocol import FrameDecoder

T = TypeVar("T")

JSON: Final = "yarp.json"


class WebSocket(Carrier):
    """One page's connection, or ours to another port."""

    name = "websocket"
    words = OVER_TCP
    magic = b"GET /?ws"
    reaches = Reach(tells=False, page=True)
    delivery = Delivery(backlog=8, coalesces=False)

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self.json = False
        self.enveloped = False
        self.pixels = False
        self._page = False  # we are the server, and have accepted the page
        self._masks = False  # the client masks its frames
        self._key = CALL
        self._frames: FrameDecoder | None = None
        self._bytes = ByteStream()  # the frames' payloads, joined
        self._rest = memoryview(b"")  # the rest of a frame's payload
        self._text = bytearray()  # the JSON message so far
        self._inside = False  # inside a message of several frames
        self._begun = False  # a binary message has begun
        self._ended = False  # a close frame came

    # -- beginning --------------------------------------------------------------------------------

    def greet(self, stream: ByteStream) -> Steps[None]:
        yield from ask_for_websocket(stream, self.route, "/?ws", "yarp")
        self._masks = True
        self._begin(stream)

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[Carrier | None]:
        line = yield from stream.read_line(HTTP_LINE)
        headers = yield from read_headers(stream)
        self.route.source = "web"
        target = (first + line).decode("latin-1").split(" ")[1]
        offered = headers.get("sec-websocket-protocol", "").replace(",", " ").split()
        guest = registry.carriers.subprotocol(offered)
        if guest is not None:
            return (yield from self._hand_over(stream, headers, target, guest))
        options = target.removeprefix("/?ws").split("&")
        self.push = "read" not in options
        self._key = ADMIN if "admin" in options else CALL
        self.enveloped = "envelope" in options
        self.pixels = "pixels" in options
        yield from screen_page(stream, headers, self.route, acts=self.push)
        right = HEAR if not self.push else "write" if self._key == CALL else "ask"
        yield from screen(stream, target, headers, right)
        self.json = JSON in offered
        chosen = JSON if self.json else offered[0] if offered else ""
        yield from grant_websocket(stream, headers, chosen)
        self.delivery = replace(self.delivery, lossy=True)
        self._page = True
        self._begin(stream)
        return None

    def _hand_over(
        self, stream: ByteStream, headers: Mapping[str, str], target: str, guest: str
    ) -> Steps[Carrier]:
        """Return the carrier whose bytes come in the frames of this page or program."""
        kind: type[Carrier] = registry.carriers.load(guest)
        yield from screen_page(stream, headers, self.route, acts=True)
        shown = yield from claim(target, headers)
        if shown.refusal:
            yield from refuse(stream, 403, shown.refusal, error=AccessRefused)
        yield from grant_websocket(stream, headers, kind.subprotocol)
        inside = FrameStream(stream, masks=False)
        yield Switch(None, inside)
        first = bytes((yield from inside.read_exact(MAGIC_SIZE)))
        if not kind.recognises(first):
            raise RemoteProtocolError(f"a WebSocket for {kind.subprotocol} that begins otherwise")
        return kind(self.route)

    def _begin(self, stream: ByteStream) -> None:
        from wsproto.frame_protocol import FrameDecoder

        self._frames = FrameDecoder(client=self._masks)
        self._bytes = ByteStream(stream.limit)

    # -- messages ---------------------------------------------------------------------------------

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        if self.json:
            self._write(stream, TEXT, self._as_json(packet))
            return
        blocks = packet.blocks  # or it cannot be sent, and then nothing of it may leave
        self._write(stream, BINARY, framing.encode_command(packet.key, packet.envelope))
        for block in blocks:
            self._write(stream, BINARY, block)

    def prepare(self, packet: Packet) -> bool:
        if self.json:
            self._as_json(packet)
        else:
            packet.snapshot("binary")
        return True

    def _as_json(self, packet: Packet) -> bytes:
        key = (JSON, self.enveloped, self.pixels)
        if key not in packet.forms:
            text = to_json(packet.value, pixels=self.pixels)
            if self.enveloped:
                envelope = to_json(packet.envelope.decode("utf-8", "replace"))
                text = f'{{"envelope": {envelope}, "data": {text}}}'
            packet.forms[key] = (text.encode(),)
        return bytes(packet.forms[key][0])

    def encode_quit(self, stream: ByteStream) -> None:
        if self._masks:
            self._write(stream, BINARY, framing.encode_command("q"))
        self._write(stream, CLOSE, b"")

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        if self.json:
            self._write(stream, TEXT, to_json(value).encode())
            return
        for block in codec.encode(value):
            self._write(stream, BINARY, block)

    def decode(self, stream: ByteStream) -> Steps[Message]:
        try:
            if self.json:
                return (yield from self._read_json(stream))
            self._begun = bool(self._bytes.waiting)
            return (yield from self._through(stream, self._read_message()))
        except LinkClosed:
            if self._ended:
                return Message(QUIT)
            raise

    def expect_reply(self, stream: ByteStream) -> Steps[Message | None]:
        steps = framing.read_payload(self._bytes, self.reply_end)
        return Message(CALL, (yield from self._through(stream, steps)))

    def listen(self, stream: ByteStream) -> Steps[None] | None:
        return self._listen(stream) if self._page else None

    def _listen(self, stream: ByteStream) -> Steps[None]:
        """While we write: answer pings, and return when the page says goodbye."""
        while True:
            yield from self._next_payload(stream)
            self._rest = memoryview(b"")
            if self._ended:
                return

    def _read_message(self) -> Steps[Message]:
        command = yield from framing.read_command(self._bytes)
        if command is None:
            raise RemoteProtocolError("a message does not begin with a port command")
        message, _ = command
        if message.key in ("d", "D", "a"):
            message.payload = yield from framing.read_payload(self._bytes)
        return message

    def _read_json(self, stream: ByteStream) -> Steps[Message]:
        """The next message in JSON; a frame that is not JSON is answered with an error, and the
        connection stays open."""
        while True:
            complete = False
            while not complete:
                complete = yield from self._next_payload(stream)
                if self._ended:
                    raise LinkClosed("the page has closed the connection")
                self._text += self._rest
                self._rest = memoryview(b"")
                if len(self._text) > min(WEBSOCKET_TEXT, stream.limit):
                    self._write(stream, CLOSE, (1009).to_bytes(2, "big"))
                    raise RemoteProtocolError(f"a JSON message of more than {WEBSOCKET_TEXT} bytes")
            text, self._text = self._text, bytearray()
            try:
                value = from_json(text)
                payload = b"".join(map(bytes, codec.encode(value)))
            except DecodeError as error:
                self.encode_reply(stream, [Vocab("fail"), str(error)])
                continue
            return Message(self._key, payload)

    # -- frames -----------------------------------------------------------------------------------

    def _write(
        self, stream: ByteStream, kind: int, payload: bytes | bytearray | memoryview
    ) -> None:
        stream.write(*frame(kind, self._masks, payload))

    def _through(self, stream: ByteStream, steps: Steps[T]) -> Steps[T]:
        """Run `steps`, which read the frames' payloads."""
        while True:
            try:
                next(steps)
            except StopIteration as stop:
                value: T = stop.value
                return value
            while not self._rest:
                yield from self._next_payload(stream)
                if self._ended:
                    raise LinkClosed("the peer has closed the connection")
            self._begun = True
            room = len(self._bytes.get_buffer())
            self._bytes.feed(self._rest[:room])
            self._rest = self._rest[room:]

    def _next_payload(self, stream: ByteStream) -> Steps[bool]:
        """Put the next piece of a data frame into `_rest`; returns whether it ends a message.

        Control frames are handled on the way.
        """
        from wsproto.frame_protocol import ParseFailed

        frames = self._frames
        assert frames is not None
        while True:
            try:
                found = frames.process_buffer()
            except ParseFailed as error:
                self._write(stream, CLOSE, PROTOCOL_ERROR)
                raise RemoteProtocolError(f"a broken WebSocket frame: {error}") from error
            if found is None:
                yield from stream.more(1)
                frames.receive_bytes(bytes(stream.buffer[stream.head : stream.tail]))
                stream.head = stream.tail
                continue
            payload = found.payload
            assert isinstance(payload, bytes)
            if found.opcode == CLOSE:
                self._ended = True
                self._write(stream, CLOSE, payload[:2])
                return True
            elif found.opcode in (PING, PONG):
                if found.opcode == PING:
                    self._write(stream, PONG, payload)
                if not (self._inside or self._begun):
                    stream.pause()
            else:
                if (found.opcode == CONTINUATION) != self._inside:
                    self._write(stream, CLOSE, PROTOCOL_ERROR)
                    raise RemoteProtocolError("WebSocket frames of two messages are mixed")
                self._rest = memoryview(payload)
                self._inside = not (found.frame_finished and found.message_finished)
                return not self._inside
