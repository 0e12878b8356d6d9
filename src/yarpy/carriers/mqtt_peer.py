"""What both sides of MQTT share: the messages of either version, and their acknowledgements.

Rules: `payload.py` says what a payload holds; `+raw` is YARP's own spelling. There is no QoS 2.
"""

from __future__ import annotations

import re
from collections import deque
from typing import Final

from yarpy.carriers import mqtt_packet as mqtt
from yarpy.carriers.base import Carrier
from yarpy.carriers.payload import message_of, payload_of
from yarpy.data import codec
from yarpy.errors import RemoteProtocolError
from yarpy.route import Route
from yarpy.wire.message import CALL, DATA, QUIT, Message
from yarpy.wire.steps import Steps
from yarpy.wire.stream import Buffer, ByteStream

RPC: Final = "rpc"
CLEAN: Final = 0x02
MAX_HEARD: Final = 1 << 14  # bytes of a packet of somebody who reads
MAX_CONNECT: Final = 1 << 16  # bytes of the packet that begins a connection
MAX_TOPIC: Final = 1 << 12  # bytes
_BROKER: Final = re.compile(r"/mqtt://[^/]++/")


class MqttPeer(Carrier):
    """Either side of a connection that speaks MQTT."""

    name = "mqtt"
    magic = b""
    foreign = True
    nameless = True
    acks = True

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        tokens = route.spec.tokens
        self.version = mqtt.V5 if RPC in tokens or "v5" in tokens else mqtt.V3
        self.raw = "raw" in tokens
        self._owed: deque[int] = deque()  # for each message its number, 0 for QoS 0
        self._asked: tuple[bytes, bytes | None] | None = None  # where the answer goes

    @property
    def topic(self) -> bytes:
        """The topic at a broker: what stands behind its address, or the name of a port."""
        name = self.route.target
        found = _BROKER.match(name)
        if name.endswith("/") and not found:
            return b""  # a broker and no topic
        text = name[found.end() :] if found else name.removeprefix("/")
        return text.encode("utf-8", "surrogateescape")

    def _properties(self, data: bytes = b"") -> bytes:
        return mqtt.varint(len(data)) + data if self.version == mqtt.V5 else b""

    def decode(self, stream: ByteStream) -> Steps[Message]:
        while True:
            first, body = yield from mqtt.read_packet(stream, stream.limit)
            kind = first & 0xF0
            if kind == mqtt.PUBLISH:
                return self.take(first, body)
            if kind == mqtt.DISCONNECT:
                return self.left(body)
            became = yield from self.heard(stream, first, body)
            if became is not None:
                return became
            stream.pause()

    def left(self, body: Buffer) -> Message:
        """The peer says goodbye."""
        return Message(QUIT)

    def heard(self, stream: ByteStream, first: int, body: Buffer) -> Steps[Message | None]:
        """A packet that is no message; what it makes of the connection, if it does."""
        self.obey(stream, first, body)
        return None
        yield

    def obey(self, stream: ByteStream, first: int, body: Buffer) -> None:
        """A packet that needs no more than an answer."""
        kind = first & 0xF0
        if kind == mqtt.PINGREQ:
            stream.write(mqtt.packet(mqtt.PINGRESP))
        elif kind not in (mqtt.PINGRESP, mqtt.UNSUBACK, mqtt.SUBACK):
            raise RemoteProtocolError(f"a packet of MQTT that does not belong here ({first:#04x})")

    def take(self, first: int, body: Buffer) -> Message:
        """The message in a PUBLISH."""
        said = mqtt.Body(body)
        topic = said.string()
        qos = (first & mqtt.QOS) >> 1
        if qos > 1:
            raise RemoteProtocolError("a message with QoS 2, which a port does not take: use 1")
        if len(topic) > MAX_TOPIC:
            raise RemoteProtocolError(f"a topic of {len(topic)} bytes")
        self._owed.append(said.number(2) if qos else 0)
        asked = None
        if self.version == mqtt.V5:
            properties = said.properties()
            if mqtt.RESPONSE_TOPIC in properties:
                asked = properties[mqtt.RESPONSE_TOPIC], properties.get(mqtt.CORRELATION)
        self._asked = asked
        payload = said.rest()
        key = CALL if asked else DATA
        return Message(key, payload) if self.raw else message_of(key, [payload])

    def encode_ack(self, stream: ByteStream, count: int) -> None:
        for _ in range(min(count, len(self._owed))):
            number = self._owed.popleft()
            if number:
                stream.write(mqtt.packet(mqtt.PUBACK, number.to_bytes(2, "big")))

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        if self._asked is None:
            return
        topic, correlation = self._asked
        properties = b""
        if correlation is not None:
            properties = bytes((mqtt.CORRELATION,)) + mqtt.string(correlation)
        head = mqtt.string(topic) + self._properties(properties)
        payload = b"".join(codec.encode(value)) if self.raw else payload_of(value)
        stream.write(*mqtt.publish(head, payload))
