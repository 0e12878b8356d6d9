"""The roles that read: PULL, SUB and REP."""

from __future__ import annotations

from typing import ClassVar

from yarpy.carriers.payload import message_of, payload_of
from yarpy.peers.zmq import zmtp
from yarpy.peers.zmq.role import RAW, Role, is_raw, received, split
from yarpy.route import Route
from yarpy.wire.message import CALL, DATA, Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import Buffer, ByteStream


class Pull(Role):
    """Messages of a PUSH: a frame, or several as a list."""

    role = "pull"
    partners: ClassVar[tuple[bytes, ...]] = (b"PUSH",)
    push = False
    replies = False

    def parse(self, stream: ByteStream) -> Message | None:
        if self.sealed is not None:
            return None
        body = zmtp.parse_body(stream)  # of one frame, as mostly
        if body is not None:
            return message_of(DATA, (body,))
        frames = zmtp.parse_message(stream)
        return None if frames is None else self.take(frames)

    def decode(self, stream: ByteStream) -> Steps[Message]:
        return self.take((yield from self.read_frames(stream)))

    def take(self, frames: list[Buffer]) -> Message:
        """Return the message for our reader."""
        return received(DATA, frames)


class Sub(Pull):
    """Messages of a PUB: the first of several frames is the topic."""

    role = "sub"
    partners = (b"PUB", b"XPUB")

    def begin(self, stream: ByteStream) -> None:
        topic = b"" if self.accepted else self.topic
        if self.raw:
            topic = RAW + topic
        if self.minor:
            stream.write(self.command(b"SUBSCRIBE", topic))
        else:
            stream.write(*self.pieces([b"\1" + topic]))

    def take(self, frames: list[Buffer]) -> Message:
        is_raw = len(frames) > 1 and frames[0][: len(RAW)] == RAW
        return received(DATA, frames if is_raw or len(frames) == 1 else frames[1:])


class Rep(Role):
    """Questions of a REQ or a DEALER, and the answers to them."""

    role = "rep"
    partners = (b"REQ", b"DEALER")
    push = False

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self._way_back: list[Buffer] = []  # the frames in front of a question
        self._raw_asked = False

    def decode(self, stream: ByteStream) -> Steps[Message]:
        frames = yield from self.read_frames(stream)
        self._way_back, question = split(frames)
        self._raw_asked = is_raw(question)
        return received(CALL, question)

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        if self._raw_asked:
            answer: list[Buffer] = [RAW, b"".join(Packet(value).blocks)]
        else:
            answer = [payload_of(value)]
        stream.write(*self.pieces([*self._way_back, *answer]))
