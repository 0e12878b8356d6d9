"""mqtt: ports write to the topics of a broker and read from them, and MQTT clients read and write
ports without a broker.

    mqtt://BROKER/robot/arm         mqtt+sub://BROKER/robot/#     a port is a client (3.1.1)
    mqtt+rpc://BROKER/ask           mqtt+sub+rpc://BROKER/ask     it asks, it answers (5)
    mosquitto_sub -p PORT -t '#'    mosquitto_pub -p PORT -t x    a port is dialled (3.1.1 or 5)

Rules: `carriers/payload.py` says what a payload holds; `+raw` is YARP's own spelling. To a broker
`+qos.1` waits for acknowledgements, so does `+qos.2`, `+retain` leaves the last message there,
`+will.TEXT` a message for the case that we vanish, `+user`, `+password` log in. A client that dials
us writes, its QoS 1 and 2 are acknowledged once the port's reader has it, until it subscribes to
the port's name: from then on it reads, and misses what it is too slow for. Version 5 may ask: a
message with a response topic is answered there. A client that is silent for half as long again as
it has promised to be is gone; its will is then one more message to the port, if it was writing.
"""

from __future__ import annotations

import os
from typing import Final

from yarpy.carriers.base import Carrier, Delivery, Limits
from yarpy.carriers.payload import to_payload
from yarpy.errors import AccessRefused, LinkClosed, RemoteProtocolError
from yarpy.limit import (
    MQTT_CONNECT,
    MQTT_HEARD,
    MQTT_PATTERNS,
    MQTT_TOPIC,
    MQTT_UNRELEASED,
    MQTT_WILL,
)
from yarpy.peers.mqtt import packet as mqtt
from yarpy.peers.mqtt.broker import Asker, Publisher, Subscriber
from yarpy.peers.mqtt.hello import check
from yarpy.peers.mqtt.session import CLEAN, RPC, WILL, MqttPeer
from yarpy.route import CarrierSpec, Route
from yarpy.wire.effects import May
from yarpy.wire.message import SMALL, Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import Buffer, ByteStream

NOBODY: Final = "mqtt"  # what a client is called
KEEP_ALIVE_FACTOR: Final = 1.5  # times as long as a client has promised to be silent at most


class Mqtt(MqttPeer):
    """A connection that a client has dialled, while it writes; or what `of` finds."""

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self._will: tuple[bytes, bytes] | None = None  # topic and payload

    @classmethod
    def of(cls, spec: CarrierSpec) -> type[Carrier]:
        check(spec)
        if "sub" in spec.tokens:
            return Subscriber
        return Asker if RPC in spec.tokens else Publisher

    @classmethod
    def recognises(cls, first: bytes) -> int:
        if first[:1] != b"\x10":
            return 0
        size = 1 if len(first) > 1 and first[1] < 128 else 2
        return 8 if first[1 + size : 8] == b"\0\4MQTT"[: 7 - size] else 0

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[Carrier | None]:
        stream.unread(len(first))
        _, body = yield from mqtt.read_packet(stream, MQTT_CONNECT)
        said = mqtt.Body(body)
        said.string()
        self.version = said.number(1)
        flags, keep_alive = said.number(1), said.number(2)
        if self.version not in (mqtt.V3, mqtt.V5):
            stream.write(mqtt.packet(mqtt.CONNACK, b"\0\1"))
            raise RemoteProtocolError(f"a client with version {self.version} of MQTT")
        wishes = said.properties() if self.version == mqtt.V5 else {}
        if mqtt.METHOD in wishes:
            stream.write(self._connack(mqtt.NO_METHOD))
            raise RemoteProtocolError("a client that wants to log in in several steps (AUTH)")
        self.most = int.from_bytes(wishes.get(mqtt.MOST_BYTES, b""), "big")
        client = said.string()
        if not client and not flags & CLEAN and self.version == mqtt.V3:
            stream.write(mqtt.packet(mqtt.CONNACK, b"\0\2"))
            raise RemoteProtocolError("a client that wants to be remembered, without a name")
        if flags & WILL:
            self._will = self._read_will(said)
        if keep_alive:
            self.limits = Limits(idle_timeout=KEEP_ALIVE_FACTOR * keep_alive)
        route = self.route
        route.source = NOBODY
        for right in ("read", "write"):
            why = yield May(right, asking=True)
            if not why:
                break
        else:
            why = yield May("read")  # logs it
            stream.write(self._connack(0x87 if self.version == mqtt.V5 else 5))
            raise AccessRefused(why)
        assigned = b""
        if self.version == mqtt.V5:
            assigned = bytes((mqtt.RECEIVE_MAXIMUM, *divmod(MQTT_UNRELEASED, 256)))
            assigned += bytes((mqtt.RETAIN_AVAILABLE, 0, mqtt.SHARING_AVAILABLE, 0))
            if any(wishes.get(mqtt.SESSION_EXPIRY, b"")):
                assigned += bytes((mqtt.SESSION_EXPIRY, 0, 0, 0, 0))
            if not client:
                assigned += b"\x12" + mqtt.string(b"yarpy-" + os.urandom(8).hex().encode())
        stream.write(self._connack(0, assigned))
        return None

    def _read_will(self, said: mqtt.Body) -> tuple[bytes, bytes]:
        """Return the topic and the payload of what is to be published when the client vanishes."""
        if self.version == mqtt.V5:
            said.properties()
        topic, payload = said.string(), said.string()
        if len(topic) > MQTT_TOPIC or len(payload) > MQTT_WILL:
            raise RemoteProtocolError("a will that is longer than anybody needs")
        return topic, payload

    def last_word(self) -> Message | None:
        if self._will is None:
            return None
        self._owed.append((0, 0))
        return self._message(*self._will)

    def left(self, body: Buffer) -> Message:
        if self.version == mqtt.V5 and bytes(body[:1]) == bytes((mqtt.WITH_WILL,)):
            raise LinkClosed("the client leaves, and wants its will published")
        return super().left(body)

    def _connack(self, reason: int, properties: bytes = b"") -> bytes:
        return mqtt.packet(mqtt.CONNACK, bytes((0, reason)) + self.properties(properties))

    def heard(self, stream: ByteStream, first: int, body: Buffer) -> Steps[Message | None]:
        kind = first & 0xF0
        if kind == mqtt.SUBSCRIBE:
            reader = Reader(self)
            why = yield May("read")
            if reader.subscribe(stream, mqtt.Body(body), bool(why)):
                return Message("r", reader)
        elif kind == mqtt.UNSUBSCRIBE:
            said = mqtt.Body(body)
            number = said.take(2)
            if self.version == mqtt.V5:
                said.properties()
            answer = number + self.properties()
            while said:
                said.string()
                answer += b"\0" if self.version == mqtt.V5 else b""
            stream.write(mqtt.packet(mqtt.UNSUBACK, answer))
        else:
            self.obey(stream, first, body)
        return None


class Reader(MqttPeer):
    """A client that has subscribed to us: it gets what the port writes."""

    push = False
    replies = False
    delivery = Delivery(lossy=True, at_once=True, attentive=True)

    def __init__(self, writer: MqttPeer) -> None:
        super().__init__(writer.route)
        self.version = writer.version
        self.limits, self.most = writer.limits, writer.most
        self.acks = False
        self._topic = writer.route.target.removeprefix("/")
        self._wanted: dict[str, int] = {}  # the numbers of subscriptions
        self._numbers = b""  # the properties that tell them
        self._small = False
        self._head = mqtt.string(self._topic.encode())

    def subscribe(self, stream: ByteStream, said: mqtt.Body, refused: bool = False) -> bool:
        """Answer a SUBSCRIBE; whether what the port writes is wanted, and may be had."""
        number, mark = said.take(2), 0
        if self.version == mqtt.V5:
            mark = int.from_bytes(said.properties().get(mqtt.SUBSCRIPTION, b""), "big")
        granted = b""
        while said:
            pattern = said.string().decode("utf-8", "replace")
            said.take(1)
            if len(granted) > 64 or len(pattern) > MQTT_TOPIC:
                raise RemoteProtocolError("more subscriptions than anybody needs")
            if pattern.startswith("$share/"):
                granted += bytes((mqtt.NO_SHARING if self.version == mqtt.V5 else 0x80,))
                continue
            granted += b"\x80" if refused else b"\0"
            if not refused and mqtt.matches(pattern.removeprefix("/"), self._topic):
                self._wanted[pattern] = mark
            if len(self._wanted) > MQTT_PATTERNS:
                raise RemoteProtocolError(f"more than {MQTT_PATTERNS} subscriptions")
        self._number()
        stream.write(mqtt.packet(mqtt.SUBACK, number + self.properties() + granted))
        return bool(self._wanted)

    def _number(self) -> None:
        self._numbers = b"".join(
            bytes((mqtt.SUBSCRIPTION,)) + mqtt.varint(mark)
            for mark in self._wanted.values()
            if mark
        )

    def gathers(self, packet: Packet) -> bool:
        return self._small

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        if not self._wanted:
            self.unwanted += 1
            return
        head = self._head + self._said_beside(packet, self._numbers)
        pieces = mqtt.publish(head, to_payload(packet))
        if 0 < self.most < sum(map(len, pieces)):
            self.lost += 1
            return
        self._small = len(pieces) == 1 and len(pieces[0]) < SMALL
        stream.write(*pieces)

    def listen(self, stream: ByteStream) -> Steps[None]:
        while True:
            while (found := mqtt.parse_packet(stream, MQTT_HEARD)) is not None:
                first, body = found
                kind = first & 0xF0
                if kind == mqtt.DISCONNECT:
                    return
                if kind == mqtt.SUBSCRIBE:
                    self.subscribe(stream, mqtt.Body(body))
                elif kind == mqtt.UNSUBSCRIBE:
                    self.unsubscribe(stream, mqtt.Body(body))
                elif kind == mqtt.PUBLISH:
                    raise RemoteProtocolError(
                        "a client that reads this port wants to write too: it takes a second "
                        "connection for that"
                    )
                else:
                    self.obey(stream, first, body)
            yield from stream.more(stream.waiting + 1)

    def unsubscribe(self, stream: ByteStream, said: mqtt.Body) -> None:
        """Answer an UNSUBSCRIBE."""
        answer = said.take(2)
        if self.version == mqtt.V5:
            said.properties()
        answer += self.properties()
        while said:
            self._wanted.pop(said.string().decode("utf-8", "replace"), None)
            answer += b"\0" if self.version == mqtt.V5 else b""
        self._number()
        stream.write(mqtt.packet(mqtt.UNSUBACK, answer))
