"""json_lines: every message is a line of JSON, for scripts, jq, and a person with netcat.

    $ nc HOST PORT
    JSONLINE me
    ["hello", 1]
    {"data": ["add", 1, 2], "reply": true}

A line that is not an object with `data` in it is the data itself. json_here is the same between two
programs of one computer: once they have greeted they meet over the transport `abstract`.
"""

import json
from typing import Any

from yarpy.carriers.base import CALL, QUIT, Carrier, Message, Packet, Steps
from yarpy.errors import RemoteProtocolError
from yarpy.wire.effects import Open, Switch
from yarpy.wire.stream import ByteStream


class JsonLines(Carrier):
    """An introduction, then lines."""

    name = "json_lines"
    magic = b"JSONLINE"
    spelling = "object"

    def greet(self, stream: ByteStream) -> Steps[None]:
        stream.write(self.magic + f" {self.route.specifier}\n".encode())
        yield from ()

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[None]:
        self.route.introduce((yield from stream.read_line(1000)).decode(errors="replace").strip())

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        item = {"data": packet.value, "envelope": packet.envelope.decode()}
        say(stream, item | {"reply": True} if packet.key == CALL else item)

    def decode(self, stream: ByteStream) -> Steps[Message]:
        line = yield from stream.read_line(stream.limit)
        try:
            item = json.loads(line)
        except (ValueError, RecursionError) as error:
            raise RemoteProtocolError(f"{line[:40]!r} is not JSON") from error
        if not isinstance(item, dict) or not {"data", "quit"} & item.keys():
            item = {"data": item}
        key = QUIT if "quit" in item else CALL if item.get("reply") else "D"
        return Message(key, item.get("data"), str(item.get("envelope", "")), "object")

    def encode_quit(self, stream: ByteStream) -> None:
        say(stream, {"quit": True})

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        say(stream, {"data": value})

    expect_reply = decode


class JsonHere(JsonLines):
    """The same, over a transport of this package."""

    name = "json_here"
    magic = b"JSONHERE"
    over = "abstract"

    def greet(self, stream: ByteStream) -> Steps[None]:
        yield from super().greet(stream)
        yield from self._move(stream, listen=False)

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[None]:
        yield from super().welcome(stream, first)
        yield from self._move(stream, listen=True)

    def _move(self, stream: ByteStream, listen: bool) -> Steps[None]:
        handle = yield Open(self.over, listen=listen)
        yield Switch(handle, ByteStream(stream.limit))


def say(stream: ByteStream, item: dict[str, Any]) -> None:
    stream.write(json.dumps(item, default=list).encode() + b"\n")  # arrays, bytes: lists
