"""The roles that write: PUSH, PUB and REQ.

Rules: what a PUB sends has the topic as its first frame: that of the carrier string if it dialled,
or else the port's name.
"""

from __future__ import annotations

from typing import ClassVar, Final

from yarpy.carriers.base import Delivery, Limits
from yarpy.carriers.payload import to_payload
from yarpy.errors import RemoteProtocolError
from yarpy.limit import ZMQ_BACKLOG, ZMQ_HELD, ZMQ_PREFIX, ZMQ_SUBSCRIPTIONS
from yarpy.peers.zmq import zmtp
from yarpy.peers.zmq.role import RAW, Role, received, split
from yarpy.route import Route
from yarpy.wire.message import CALL, SMALL, Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import Buffer, ByteStream

_HEADS: Final = [zmtp.head(size) for size in range(256)]  # of messages of one short frame
HIGH_WATER: Final = 1000  # messages that wait for a SUB, as for one of a PUB with SNDHWM as it is


class Push(Role):
    """Every message in a frame, to a PULL."""

    role = "push"
    partners: ClassVar[tuple[bytes, ...]] = (b"PULL",)
    replies = False
    delivery = Delivery(attentive=True)

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self._small = False

    def gathers(self, packet: Packet) -> bool:
        return self._small

    def prepare(self, packet: Packet) -> bool:
        if self.raw:
            packet.snapshot("binary")
        else:
            to_payload(packet)
        return True

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        if self.raw:
            self.write(stream, [RAW + self.topic, self.raw_of(packet)])
            return
        body = to_payload(packet)
        if len(body) < 256 and self.sealed is None:  # as mostly
            self._small = True
            stream.write(_HEADS[len(body)] + body)
        else:
            self.write(stream, [body])

    def raw_of(self, packet: Packet) -> Buffer:
        """The payload in YARP's own spelling."""
        blocks = packet.blocks
        return blocks[0] if len(blocks) == 1 else b"".join(blocks)

    def write(self, stream: ByteStream, frames: list[Buffer]) -> None:
        """Write a message of these frames."""
        pieces = self.pieces(frames)
        self._small = len(pieces) == 1 and len(pieces[0]) < SMALL
        stream.write(*pieces)


class Pub(Push):
    """The sender of the messages to whose topics its peer has subscribed, as topic and payload."""

    role = "pub"
    partners = (b"SUB", b"XSUB")
    delivery = Delivery(
        lossy=True, backlog=HIGH_WATER, held=ZMQ_BACKLOG, at_once=True, attentive=True
    )

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self._wanted: dict[bytes, int] = {}  # prefixes, and how often each was subscribed to
        self._held = 0  # bytes of them
        self._topic = b""
        self._takes = self._takes_raw = False

    def begin(self, stream: ByteStream) -> None:
        if not self.accepted:
            topic = self.topic or self.route.source.encode("utf-8", "surrogateescape")
        else:
            topic = self.route.target.encode("utf-8", "surrogateescape")
        self._topic = topic

    def obey(self, stream: ByteStream, body: Buffer) -> None:
        name, content = zmtp.parse_command(body)
        if name in (b"SUBSCRIBE", b"CANCEL"):
            self._subscribe(content, name == b"SUBSCRIBE")
        else:
            super().obey(stream, body)

    def hear(self, body: Buffer) -> None:
        data = bytes(body)
        if data[:1] in (b"\0", b"\1"):
            self._subscribe(data[1:], data[0] == 1)

    def _subscribe(self, prefix: bytes, on: bool) -> None:
        wanted = self._wanted
        if len(prefix) > ZMQ_PREFIX:
            raise RemoteProtocolError(f"a subscription of more than {ZMQ_PREFIX} bytes")
        if on:
            if prefix not in wanted:
                self._held += len(prefix)
            wanted[prefix] = wanted.get(prefix, 0) + 1
            if len(wanted) > ZMQ_SUBSCRIPTIONS or self._held > ZMQ_HELD:
                raise RemoteProtocolError(
                    f"more than {ZMQ_SUBSCRIPTIONS} subscriptions, or {ZMQ_HELD} bytes of them"
                )
        elif prefix in wanted:
            wanted[prefix] -= 1
            if not wanted[prefix]:
                del wanted[prefix]
                self._held -= len(prefix)
        if self.raw:
            self._takes, self._takes_raw = False, self._is_wanted(RAW + self._topic, False)
        else:
            self._takes = self._is_wanted(self._topic, False)
            self._takes_raw = self._is_wanted(RAW + self._topic, True)

    def _is_wanted(self, topic: bytes, explicitly: bool) -> bool:
        return any(
            topic.startswith(prefix) and (prefix.startswith(RAW) or not explicitly)
            for prefix in self._wanted
        )

    def prepare(self, packet: Packet) -> bool:
        if self._takes_raw:
            packet.snapshot("binary")
        if self._takes or not self._takes_raw:
            to_payload(packet)  # in memory of its own
        return True

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        if self._takes:
            self.write(stream, [self._topic, to_payload(packet)])
            if self._takes_raw:
                raw = self.pieces([RAW + self._topic, self.raw_of(packet)])
                self._small = False
                stream.write(*raw)
        elif self._takes_raw:
            self.write(stream, [RAW + self._topic, self.raw_of(packet)])
        else:
            self.unwanted += 1


class Req(Role):
    """Questions to a REP. A message that wants no answer gets one all the same, which is read and
    forgotten."""

    role = "req"
    partners = (b"REP", b"ROUTER")
    acks = True
    delivery = Delivery(coalesces=False)
    limits = Limits(ack_timeout=60.0)

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self._confirmed = False  # the answer to our question was read as its reply
        self._owed = 0  # answers that have not come
        self._over = False

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        content = [RAW, b"".join(packet.blocks)] if self.raw else [to_payload(packet)]
        stream.write(*self.pieces([b"", *content]))
        self._owed += 1

    def encode_quit(self, stream: ByteStream) -> None:
        self._over = True  # nothing comes for that

    def expect_reply(self, stream: ByteStream) -> Steps[Message | None]:
        frames = yield from self.read_frames(stream)
        self._confirmed = True
        self._owed -= 1
        return received(CALL, split(frames)[1])

    def expect_ack(self, stream: ByteStream) -> Steps[None]:
        if not (self._confirmed or (self._over and not self._owed)):
            yield from self.expect_reply(stream)
        self._confirmed = False
