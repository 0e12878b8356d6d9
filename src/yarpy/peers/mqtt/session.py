"""A session of MQTT, from either side: messages of both versions, and their acknowledgements.

Rules: `carriers/payload.py` says what a payload holds; `+raw` is YARP's own spelling. A message
with QoS 2 is received when the port's reader has it, and once: its number is known until the sender
lets go.
"""

from __future__ import annotations

import re
from collections import deque
from typing import Final

from yarpy.carriers.base import Carrier
from yarpy.carriers.payload import message_of, payload_of
from yarpy.data import codec
from yarpy.errors import RemoteProtocolError
from yarpy.facts import Reach
from yarpy.limit import MQTT_TOPIC, MQTT_UNRELEASED
from yarpy.peers.mqtt import packet as mqtt
from yarpy.peers.mqtt import user
from yarpy.route import Route
from yarpy.wire.message import CALL, DATA, QUIT, Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import Buffer, ByteStream

RPC: Final = "rpc"
SESSION: Final = "session"
DELAY: Final = "will_delay"
EXPIRY: Final = "expiry"
HANDLING: Final = "retain_handling"
CLEAN: Final = 0x02
WILL: Final = 0x04
BROKER: Final = re.compile(r"/mqtt://[^/]++/")


class MqttPeer(Carrier):
    """Either side of a connection that speaks MQTT."""

    name = "mqtt"
    magic = b""
    subprotocol = "mqtt"
    reaches = Reach("broker", number=1883, number_tls=8883)
    acks = True

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        tokens = route.spec.tokens
        newer = {RPC, "v5"} & {*tokens} or any(
            map(route.spec.value, (SESSION, HANDLING, DELAY, EXPIRY))
        )
        self.version = mqtt.V5 if newer else mqtt.V3
        self.raw = "raw" in tokens
        self._owed: deque[tuple[int, int]] = deque()  # for each message its QoS and number
        self._unreleased: set[int] = set()  # numbers of those with QoS 2 that may come once more
        self._asked: tuple[bytes, bytes | None] | None = None  # where the answer goes
        self.most = 0  # bytes of a packet that the peer takes; 0: any

    @property
    def topic(self) -> bytes:
        """The topic at a broker: what stands behind its address, or the name of a port."""
        name = self.route.target
        found = BROKER.match(name)
        if name.endswith("/") and not found:
            return b""  # a broker and no topic
        text = name[found.end() :] if found else name.removeprefix("/")
        return text.encode("utf-8", "surrogateescape")

    def _said_beside(self, packet: Packet, data: bytes = b"") -> bytes:
        """Return the properties of a message, its envelope among them."""
        if packet.envelope and self.version == mqtt.V5:
            data += user.properties_of(packet.envelope)
        return self.properties(data)

    def properties(self, data: bytes = b"") -> bytes:
        """Return properties behind their length; version 3.1.1 has none."""
        return mqtt.varint(len(data)) + data if self.version == mqtt.V5 else b""

    def decode(self, stream: ByteStream) -> Steps[Message]:
        while True:
            first, body = yield from mqtt.read_packet(stream, stream.limit)
            kind = first & 0xF0
            if kind == mqtt.PUBLISH:
                message = self.take(stream, first, body)
                if message is not None:
                    return message
                stream.pause()
                continue
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
        elif kind == mqtt.PUBREL:
            number = mqtt.Body(body).number(2)
            self._unreleased.discard(number)
            stream.write(mqtt.packet(mqtt.PUBCOMP, number.to_bytes(2, "big")))
        elif kind not in (mqtt.PINGRESP, mqtt.UNSUBACK, mqtt.SUBACK):
            raise RemoteProtocolError(f"a packet of MQTT that does not belong here ({first:#04x})")

    def take(self, stream: ByteStream, first: int, body: Buffer) -> Message | None:
        """Return the message in a PUBLISH; None for one that we have already."""
        said = mqtt.Body(body)
        topic = said.string()
        qos = (first & mqtt.QOS) >> 1
        if qos > 2:
            raise RemoteProtocolError("a message with QoS 3, which there is not")
        if len(topic) > MQTT_TOPIC:
            raise RemoteProtocolError(f"a topic of {len(topic)} bytes")
        number = said.number(2) if qos else 0
        if qos == 2 and number in self._unreleased:
            if (2, number) not in self._owed:  # else it is answered as soon as the reader has it
                stream.write(mqtt.packet(mqtt.PUBREC, number.to_bytes(2, "big")))
            return None
        asked = None
        pairs: list[user.Pair] = []
        if self.version == mqtt.V5:
            properties = said.properties(pairs)
            if mqtt.RESPONSE_TOPIC in properties:
                asked = properties[mqtt.RESPONSE_TOPIC], properties.get(mqtt.CORRELATION_DATA)
        self._asked = asked
        payload = said.rest()
        self._owe(qos, number)
        message = self._message(topic, payload, CALL if asked else DATA)
        if pairs:
            message.envelope = user.envelope_of(pairs)
        return message

    def _owe(self, qos: int, number: int) -> None:
        """Note that a message is to be acknowledged. Raises RemoteProtocolError for a peer that
        never lets go."""
        if qos == 2:
            if len(self._unreleased) >= MQTT_UNRELEASED:
                raise RemoteProtocolError(
                    f"more than {MQTT_UNRELEASED} messages with QoS 2 that it does not release"
                )
            self._unreleased.add(number)
        self._owed.append((qos, number))

    def _message(self, topic: bytes, payload: Buffer, key: str = DATA) -> Message:
        """Hand the port a message that somebody has published."""
        message = Message(key, payload) if self.raw else message_of(key, [payload])
        message.source = self.source_of(topic)
        return message

    def source_of(self, topic: Buffer) -> str:
        """Return where a message comes from, if its topic says so; "" for the connection's name."""
        return ""

    def encode_ack(self, stream: ByteStream, count: int) -> None:
        for _ in range(min(count, len(self._owed))):
            qos, number = self._owed.popleft()
            if qos:
                kind = mqtt.PUBREC if qos == 2 else mqtt.PUBACK
                stream.write(mqtt.packet(kind, number.to_bytes(2, "big")))

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        if self._asked is None:
            return
        topic, correlation = self._asked
        properties = b""
        if correlation is not None:
            properties = bytes((mqtt.CORRELATION_DATA,)) + mqtt.string(correlation)
        head = mqtt.string(topic) + self.properties(properties)
        payload = b"".join(codec.encode(value)) if self.raw else payload_of(value)
        stream.write(*mqtt.publish(head, payload))
