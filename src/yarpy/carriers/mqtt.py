"""mqtt: ports write to the topics of a broker and read from them, and MQTT clients read and write
ports without a broker.

    mqtt://BROKER/robot/arm         mqtt+sub://BROKER/robot/#     a port is a client (3.1.1)
    mqtt+rpc://BROKER/ask           mqtt+sub+rpc://BROKER/ask     it asks, it answers (5)
    mosquitto_sub -p PORT -t '#'    mosquitto_pub -p PORT -t x    a port is dialled (3.1.1 or 5)

Rules: `payload.py` says what a payload holds; `+raw` is YARP's own spelling. To a broker `+qos.1`
waits for acknowledgements, `+retain` leaves the last message there, `+user`, `+password` log in. A
client that dials us writes, its QoS 1 is acknowledged once the port's reader has it, until it
subscribes to the port's name: from then on it reads, and misses what it is too slow for. Version 5
may ask: a message with a response topic is answered there. There is no QoS 2.
"""

from __future__ import annotations

import os
import re
from collections import deque
from typing import ClassVar, Final

from yarpy.carriers import mqtt_packet as mqtt
from yarpy.carriers.base import Carrier, Delivery
from yarpy.carriers.payload import message_of, payload_of, to_payload
from yarpy.data import codec
from yarpy.data.value import Vocab
from yarpy.errors import AccessRefused, LocalProtocolError, LoginRefused, RemoteProtocolError
from yarpy.log import readable
from yarpy.route import CarrierSpec, Route
from yarpy.wire.effects import May
from yarpy.wire.message import CALL, DATA, QUIT, SMALL, Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import Buffer, ByteStream

NOBODY: Final = "mqtt"  # what a client is called
RPC: Final = "rpc"
CLEAN: Final = 0x02
MAX_HEARD: Final = 1 << 14  # bytes of a packet of somebody who reads
MAX_CONNECT: Final = 1 << 16  # bytes of the packet that begins a connection
MAX_TOPIC: Final = 1 << 12  # bytes
MAX_PATTERNS: Final = 64  # of one reader
_BROKER: Final = re.compile(r"/mqtt://[^/]++/")
_REFUSALS: Final = {
    1: "it does not speak version 3.1.1",
    2: "it does not like the client's name",
    3: "it is not ready",
    4: "the name or the password is wrong: say +user.NAME+password.WORD",
    5: "it does not admit us: say +user.NAME+password.WORD",
    0x84: "it does not speak version 5, which +rpc needs",
    0x86: "the name or the password is wrong: say +user.NAME+password.WORD",
    0x87: "it does not admit us: say +user.NAME+password.WORD",
}
_LOGIN: Final = frozenset((4, 5, 0x86, 0x87))


class Mqtt(Carrier):
    """A connection that a client has dialled, while it writes; or one of the classes below."""

    name = "mqtt"
    magic = b""
    foreign = True
    nameless = True
    role: ClassVar[str] = ""

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self.version = mqtt.V5 if RPC in route.spec.tokens else mqtt.V3
        self.raw = "raw" in route.spec.tokens
        self._owed: deque[int] = deque()  # for each message its number, 0 for QoS 0
        self._asked: tuple[bytes, bytes | None] | None = None  # where the answer goes

    @classmethod
    def of(cls, spec: CarrierSpec) -> type[Carrier]:
        if "sub" in spec.tokens:
            return Subscriber
        return Asker if RPC in spec.tokens else Publisher

    @classmethod
    def recognises(cls, first: bytes) -> int:
        if cls.role or first[:1] != b"\x10":
            return 0  # who dials in is always served by this class
        size = 1 if len(first) > 1 and first[1] < 128 else 2
        return 8 if first[1 + size : 8] == b"\0\4MQTT"[: 7 - size] else 0

    @property
    def topic(self) -> bytes:
        """The topic at a broker: what stands behind its address, or the name of a port."""
        name = self.route.target
        found = _BROKER.match(name)
        if name.endswith("/") and not found:
            return b""  # a broker and no topic
        text = name[found.end() :] if found else name.removeprefix("/")
        return text.encode("utf-8", "surrogateescape")

    # -- a client dials us ------------------------------------------------------------------------

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[Carrier | None]:
        stream.unread(len(first))
        _, body = yield from mqtt.read_packet(stream, MAX_CONNECT)
        said = mqtt.Body(body)
        said.string()
        self.version = said.number(1)
        flags, _ = said.number(1), said.number(2)
        if self.version not in (mqtt.V3, mqtt.V5):
            stream.write(mqtt.packet(mqtt.CONNACK, b"\0\1"))
            raise RemoteProtocolError(f"a client with version {self.version} of MQTT")
        if self.version == mqtt.V5:
            said.properties()
        client = said.string()
        if not client and not flags & CLEAN and self.version == mqtt.V3:
            stream.write(mqtt.packet(mqtt.CONNACK, b"\0\2"))
            raise RemoteProtocolError("a client that wants to be remembered, without a name")
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
            assigned = bytes((mqtt.MAXIMUM_QOS, 1, mqtt.RETAIN_AVAILABLE, 0))
            if not client:
                assigned += b"\x12" + mqtt.string(b"yarpy-" + os.urandom(8).hex().encode())
        stream.write(self._connack(0, assigned))
        return None

    def _connack(self, reason: int, properties: bytes = b"") -> bytes:
        return mqtt.packet(mqtt.CONNACK, bytes((0, reason)) + self._properties(properties))

    def _properties(self, data: bytes = b"") -> bytes:
        return mqtt.varint(len(data)) + data if self.version == mqtt.V5 else b""

    def decode(self, stream: ByteStream) -> Steps[Message]:
        while True:
            first, body = yield from mqtt.read_packet(stream, stream.limit)
            kind = first & 0xF0
            if kind == mqtt.PUBLISH:
                return self.take(first, body)
            if kind == mqtt.DISCONNECT:
                return Message(QUIT)
            if kind == mqtt.SUBSCRIBE and not self.role:
                reader = Reader(self)
                why = yield May("read")
                if reader.subscribe(stream, mqtt.Body(body), bool(why)):
                    return Message("r", reader)
            else:
                self.obey(stream, first, body)
            stream.pause()

    def obey(self, stream: ByteStream, first: int, body: Buffer) -> None:
        """A packet that needs no more than an answer."""
        kind = first & 0xF0
        if kind == mqtt.PINGREQ:
            stream.write(mqtt.packet(mqtt.PINGRESP))
        elif kind == mqtt.UNSUBSCRIBE and not self.role:
            said = mqtt.Body(body)
            number = said.take(2)
            if self.version == mqtt.V5:
                said.properties()
            answer = number + self._properties()
            while said:
                said.string()
                answer += b"\0" if self.version == mqtt.V5 else b""
            stream.write(mqtt.packet(mqtt.UNSUBACK, answer))
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

    acks = True

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

    # -- a port dials -----------------------------------------------------------------------------

    def _connect(self, stream: ByteStream) -> Steps[None]:
        """Become a client of the broker."""
        stream.write(self._hello())
        first, body = yield from mqtt.read_packet(stream, MAX_CONNECT)
        if first != mqtt.CONNACK or len(body) < 2:
            raise RemoteProtocolError("what was dialled is no broker of MQTT")
        reason = bytes(body)[1]
        if reason:
            why = _REFUSALS.get(reason, f"for reason {reason}")
            kind = LoginRefused if reason in _LOGIN else RemoteProtocolError
            raise kind(f"the broker refuses: {why}")

    def _subscribe(self, stream: ByteStream, topic: bytes, qos: int) -> None:
        """Subscribe, at a broker."""
        body = b"\0\1" + self._properties() + mqtt.string(topic) + bytes((qos,))
        stream.write(mqtt.packet(mqtt.SUBSCRIBE | 2, body))

    def _subscribed(self, topic: bytes, first: int, body: Buffer) -> None:
        """See whether the broker agrees."""
        if first != mqtt.SUBACK or len(body) < 3:
            raise RemoteProtocolError("the broker does not answer a subscription")
        if bytes(body)[-1] > 2:
            shown = readable(topic[:80].decode("utf-8", "replace"))
            raise RemoteProtocolError(f"the broker refuses the subscription to {shown}")

    def _one_topic(self) -> bytes:
        """The topic, where it has to be a single one."""
        topic = self.topic
        if not topic or b"#" in topic or b"+" in topic or len(topic) > MAX_TOPIC:
            raise LocalProtocolError(
                "a port writes to one topic, which stands behind the broker: mqtt://HOST/TOPIC"
            )
        return topic

    def _hello(self) -> bytes:
        from urllib.parse import unquote_to_bytes

        route = self.route
        client = f"yarpy{route.source.replace('/', '-')}-{os.urandom(4).hex()}"
        words = [route.spec.value(key) for key in ("user", "password")]
        user, password = (
            None if word is None else unquote_to_bytes(word.encode("utf-8", "surrogateescape"))
            for word in words
        )
        if password is not None and user is None:
            raise LocalProtocolError("a password for a broker needs a name: say +user.NAME")
        flags = CLEAN | (0x80 if user is not None else 0) | (0x40 if password is not None else 0)
        body = mqtt.string(b"MQTT") + bytes((self.version, flags, 0, 0)) + self._properties()
        for part in (client.encode("utf-8", "replace")[:1000], user, password):
            if part is not None:
                body += mqtt.string(part)
        return mqtt.packet(mqtt.CONNECT, body)

    @property
    def qos(self) -> int:
        """What the carrier string says, 0 or 1."""
        text = self.route.spec.value("qos") or "0"
        if text not in ("0", "1"):
            raise LocalProtocolError(f"+qos.{text[:20]}: a port speaks QoS 0 and 1")
        return int(text)

    def encode_quit(self, stream: ByteStream) -> None:
        stream.write(mqtt.packet(mqtt.DISCONNECT))


class Publisher(Mqtt):
    """A port that writes to a broker's topic."""

    role = "pub"
    replies = False

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self._head = b""
        self._first = mqtt.PUBLISH
        self._number = 0
        self._small = False
        self._open = deque[int]()  # numbers that were not acknowledged
        self._over = False
        self.acks = False

    def greet(self, stream: ByteStream) -> Steps[None]:
        self.acks = bool(self.qos)
        self._head = mqtt.string(self._one_topic())
        retain = mqtt.RETAIN if "retain" in self.route.spec.tokens else 0
        self._first = mqtt.PUBLISH | (self.qos << 1) | retain
        yield from self._connect(stream)

    def gathers(self, packet: Packet) -> bool:
        return self._small

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        if self.raw:
            blocks = packet.blocks
            payload = blocks[0] if len(blocks) == 1 else b"".join(blocks)
        else:
            payload = to_payload(packet)
        head = self._head
        if self.acks:
            self._number = self._number % 65535 + 1
            self._open.append(self._number)
            head += self._number.to_bytes(2, "big")
        pieces = mqtt.publish(head, payload, self._first)
        self._small = len(pieces) == 1 and len(pieces[0]) < SMALL
        stream.write(*pieces)

    def encode_quit(self, stream: ByteStream) -> None:
        super().encode_quit(stream)
        self._over = True

    def expect_ack(self, stream: ByteStream) -> Steps[None]:
        while self._open:
            first, body = yield from mqtt.read_packet(stream, MAX_HEARD)
            if first & 0xF0 != mqtt.PUBACK:
                self.obey(stream, first, body)
                continue
            if mqtt.Body(body).number(2) != self._open.popleft():
                raise RemoteProtocolError("the broker acknowledges another message")
            return
        if not self._over:
            raise RemoteProtocolError("the broker acknowledges what was not sent")


class Subscriber(Mqtt):
    """A port that reads from a broker's topics."""

    role = "sub"
    push = False

    def greet(self, stream: ByteStream) -> Steps[None]:
        topic = self.topic
        if not topic or len(topic) > MAX_TOPIC:
            raise LocalProtocolError("the topic stands behind the broker: mqtt+sub://HOST/TOPIC")
        qos = self.qos
        yield from self._connect(stream)
        self._subscribe(stream, topic, qos)
        first, body = yield from mqtt.read_packet(stream, MAX_HEARD)
        self._subscribed(topic, first, body)


class Asker(Mqtt):
    """A port that asks whoever has subscribed to a broker's topic (version 5)."""

    role = RPC
    acks = False

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self._topic = b""
        self._answers = b"yarpy/answers/" + os.urandom(8).hex().encode()
        self._number = 0  # of the last question

    def greet(self, stream: ByteStream) -> Steps[None]:
        self._topic = self._one_topic()
        yield from self._connect(stream)
        self._subscribe(stream, self._answers, 1)  # answered before any question is

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        payload = b"".join(packet.blocks) if self.raw else to_payload(packet)
        properties = b""
        if packet.key == CALL:
            self._number = self._number % 65535 + 1
            properties = bytes((mqtt.RESPONSE_TOPIC,)) + mqtt.string(self._answers)
            properties += bytes((mqtt.CORRELATION,)) + mqtt.string(self._correlation)
        head = mqtt.string(self._topic)
        if packet.key == CALL:  # its acknowledgement tells whether there is anybody
            head += self._correlation
        head += self._properties(properties)
        first = mqtt.PUBLISH | (2 if packet.key == CALL else 0)
        stream.write(*mqtt.publish(head, payload, first))

    @property
    def _correlation(self) -> bytes:
        return self._number.to_bytes(2, "big")

    def expect_reply(self, stream: ByteStream) -> Steps[Message | None]:
        while True:
            first, body = yield from mqtt.read_packet(stream, stream.limit)
            kind = first & 0xF0
            if kind == mqtt.PUBLISH:
                answer = self._answer(stream, first, body)
                if answer is not None:
                    return answer
            elif kind == mqtt.SUBACK:
                self._subscribed(self._answers, first, body)
            elif kind != mqtt.PUBACK:
                self.obey(stream, first, body)
            elif bytes(body[:3]) == self._correlation + bytes((mqtt.NOT_HEARD,)):
                topic = readable(self._topic.decode("utf-8", "replace"))
                why = f"nobody has subscribed to {topic} at the broker"
                return Message(CALL, b"".join(codec.encode([Vocab("fail"), why])))

    def _answer(self, stream: ByteStream, first: int, body: Buffer) -> Message | None:
        """The answer to our last question; None for one that came too late."""
        said = mqtt.Body(body)
        said.string()
        if first & mqtt.QOS:
            stream.write(mqtt.packet(mqtt.PUBACK, said.take(2)))
        if said.properties().get(mqtt.CORRELATION) != self._correlation:
            return None
        payload = said.rest()
        return Message(CALL, payload) if self.raw else message_of(CALL, [payload])


class Reader(Mqtt):
    """A client that has subscribed to us: it gets what the port writes."""

    role = "reader"
    push = False
    replies = False
    attentive = True
    delivery = Delivery(lossy=True, at_once=True)

    def __init__(self, writer: Mqtt) -> None:
        super().__init__(writer.route)
        self.version = writer.version
        self.acks = False
        self._topic = writer.route.target.removeprefix("/")
        self._wanted: set[str] = set()
        self._small = False
        self._head = mqtt.string(self._topic.encode()) + self._properties()

    def subscribe(self, stream: ByteStream, said: mqtt.Body, refused: bool = False) -> bool:
        """Answer a SUBSCRIBE; whether what the port writes is wanted, and may be had."""
        number = said.take(2)
        if self.version == mqtt.V5:
            said.properties()
        granted = b""
        while said:
            pattern = said.string().decode("utf-8", "replace")
            said.take(1)
            if len(granted) > 64 or len(pattern) > MAX_TOPIC:
                raise RemoteProtocolError("more subscriptions than anybody needs")
            granted += b"\x80" if refused else b"\0"
            if not refused and mqtt.matches(pattern.removeprefix("/"), self._topic):
                self._wanted.add(pattern)
            if len(self._wanted) > MAX_PATTERNS:
                raise RemoteProtocolError(f"more than {MAX_PATTERNS} subscriptions")
        stream.write(mqtt.packet(mqtt.SUBACK, number + self._properties() + granted))
        return bool(self._wanted)

    def gathers(self, packet: Packet) -> bool:
        return self._small

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        if not self._wanted:
            self.unwanted += 1
            return
        pieces = mqtt.publish(self._head, to_payload(packet))
        self._small = len(pieces) == 1 and len(pieces[0]) < SMALL
        stream.write(*pieces)

    def listen(self, stream: ByteStream) -> Steps[None]:
        while True:
            while (found := mqtt.parse_packet(stream, MAX_HEARD)) is not None:
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
        answer += self._properties()
        while said:
            self._wanted.discard(said.string().decode("utf-8", "replace"))
            answer += b"\0" if self.version == mqtt.V5 else b""
        stream.write(mqtt.packet(mqtt.UNSUBACK, answer))
