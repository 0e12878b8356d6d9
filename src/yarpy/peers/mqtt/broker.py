"""A port as a client of MQTT's brokers: it publishes, subscribes, and asks.

Rules: version 3.1.1, which every broker understands; 5 for questions and sessions, and with `+v5`.
Sessions are clean, unless `+session.SECONDS` says for how long the broker keeps what comes while
the port is away: then the port has the same name there each time. The broker is promised a sign of
life within KEEP_ALIVE, or what it wishes instead; the port sends it (`ping`). `+ws` comes in the
frames of a WebSocket.
"""

from __future__ import annotations

import os
from collections import deque
from dataclasses import replace
from typing import Final
from zlib import crc32

from yarpy.carriers.base import Limits, refuse_unknown
from yarpy.carriers.payload import message_of, to_payload
from yarpy.carriers.web.upgrade import ask_for_websocket
from yarpy.data import codec
from yarpy.data.value import Vocab
from yarpy.errors import LocalProtocolError, LoginRefused, RemoteProtocolError
from yarpy.limit import MQTT_CONNECT, MQTT_HEARD, MQTT_TOPIC
from yarpy.log import readable
from yarpy.peers.mqtt import packet as mqtt
from yarpy.peers.mqtt.session import BROKER, CLEAN, HANDLING, RPC, SESSION, WILL, MqttPeer
from yarpy.route import CarrierSpec, Route
from yarpy.wire.effects import Switch
from yarpy.wire.frame_stream import BINARY, FrameStream, frame
from yarpy.wire.message import CALL, SMALL, Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import Buffer, ByteStream

MOST_IN_FLIGHT: Final = 20  # messages with QoS 2 under way; of more, mosquitto loses some
FOREVER: Final = 0xFFFFFFFF  # seconds of a session that never expires
KEEP_ALIVE: Final = 60  # seconds of silence that we promise not to exceed
WEBSOCKET: Final = "ws"
_REFUSALS: Final = {
    1: "it does not speak version 3.1.1: say +v5",
    2: "it does not like the client's name",
    3: "it is not ready",
    4: "the name or the password is wrong: say +user.NAME+password.WORD",
    5: "it does not admit us: say +user.NAME+password.WORD",
    0x84: "it does not speak version 5, which +rpc and +v5 need",
    0x86: "the name or the password is wrong: say +user.NAME+password.WORD",
    0x87: "it does not admit us: say +user.NAME+password.WORD",
}
_WORDS: Final = (
    *("sub", RPC, "session.SECONDS", "qos.1", "qos.2", "retain", "will.TEXT", "retain_handling.N"),
    *("user.NAME", "password.WORD", "v5", "raw", "ws", "ws.PATH"),
)
_LOGIN: Final = frozenset((4, 5, 0x86, 0x87))


_ENDS: Final = {
    0x00: "it says goodbye",
    0x87: "it does not admit us any more",
    0x8B: "it is shutting down",
    0x8D: "it did not hear from us",
    0x8E: "another client has our name",
    0x93: "it got more than it can take",
    0x95: "a message was too large for it",
    0x97: "it got more than we are allowed to send",
}


def check(spec: CarrierSpec) -> None:
    """Raise LocalProtocolError for what no broker can be asked for."""
    refuse_unknown(spec, _WORDS)
    qos = spec.value("qos")
    if qos not in (None, "0", "1", "2"):
        raise LocalProtocolError(f"+qos.{qos[:20]}: there are QoS 0, 1 and 2")
    if spec.value("will") is not None and {"sub", RPC} & {*spec.tokens}:
        raise LocalProtocolError("+will.TEXT is for ports that write to a topic of a broker")
    handling = spec.value(HANDLING) or "0"
    if handling not in ("0", "1", "2") or (handling != "0" and "sub" not in spec.tokens):
        raise LocalProtocolError("+retain_handling.N is for ports that read: N is 0, 1 or 2")
    _check_session(spec)
    if spec.value("password") is not None and spec.value("user") is None:
        raise LocalProtocolError("a password for a broker needs a name: say +user.NAME")


def _check_session(spec: CarrierSpec) -> None:
    seconds = spec.value(SESSION)
    if seconds is None:
        return
    if "sub" not in spec.tokens or RPC in spec.tokens:
        raise LocalProtocolError("+session.SECONDS is for ports that read from topics of a broker")
    if not (seconds.isascii() and seconds.isdecimal() and 0 < int(seconds[:20]) <= FOREVER):
        raise LocalProtocolError(f"+session.{seconds[:20]}: say seconds, {FOREVER} for no end")
    if spec.value("qos") not in ("1", "2"):
        raise LocalProtocolError("a broker keeps what has a QoS: say +qos.1 beside +session")


class Client(MqttPeer):
    """A port that has dialled a broker."""

    ping = (mqtt.packet(mqtt.PINGREQ), KEEP_ALIVE / 2)

    def _enter(self, stream: ByteStream) -> Steps[ByteStream]:
        """Return the stream of what the broker says: that of the connection, or of what is in the
        frames of a WebSocket."""
        from urllib.parse import quote, unquote

        path = self.route.spec.value(WEBSOCKET)
        if path is None and WEBSOCKET not in self.route.spec.tokens:
            return stream
        path = quote(unquote(path or "/mqtt"))
        if not path.startswith("/"):
            path = f"/{path}"
        yield from ask_for_websocket(stream, self.route, path, self.subprotocol)
        inside = FrameStream(stream, masks=True)
        self.ping = b"".join(frame(BINARY, True, self.ping[0])), self.ping[1]
        yield Switch(None, inside)
        return inside

    def _connect(self, stream: ByteStream) -> Steps[bool]:
        """Become a client of the broker; return whether it knows us from before."""
        stream.write(self._hello())
        first, body = yield from mqtt.read_packet(stream, MQTT_CONNECT)
        if first != mqtt.CONNACK or len(body) < 2:
            raise RemoteProtocolError("what was dialled is no broker of MQTT")
        said = mqtt.Body(body)
        reason = said.number(2) & 0xFF
        if reason:
            why = _REFUSALS.get(reason, f"for reason {reason}")
            kind = LoginRefused if reason in _LOGIN else RemoteProtocolError
            raise kind(f"the broker refuses: {why}")
        ahead = MOST_IN_FLIGHT if self.qos == 2 else self.limits.ahead
        if self.version == mqtt.V5:
            wishes = said.properties()
            if (wish := wishes.get(mqtt.SERVER_KEEP_ALIVE)) is not None:
                self.ping = self.ping[0], int.from_bytes(wish, "big") / 2
            if (most := wishes.get(mqtt.RECEIVE_MAXIMUM)) is not None:
                ahead = min(ahead, max(1, int.from_bytes(most, "big")))
            self.most = int.from_bytes(wishes.get(mqtt.MOST_BYTES, b""), "big")
        self.limits = replace(self.limits, ahead=ahead)
        return bool(body[0] & 1)

    def left(self, body: Buffer) -> Message:
        reason = bytes(body[:1])
        why = _ENDS.get(reason[0], f"for reason {reason[0]:#04x}") if reason else "without a reason"
        raise RemoteProtocolError(f"the broker ends the connection: {why}")

    def listen(self, stream: ByteStream) -> Steps[None] | None:
        return self._listen(stream) if self.push else None

    def _listen(self, stream: ByteStream) -> Steps[None]:
        """Read what a broker sends between messages and questions: the answers to our pings."""
        while True:
            while (found := mqtt.parse_packet(stream, MQTT_HEARD)) is not None:
                self.aside(stream, *found)
            yield from stream.more(stream.waiting + 1)

    def aside(self, stream: ByteStream, first: int, body: Buffer) -> None:
        """A packet that nobody waits for."""
        if first & 0xF0 == mqtt.DISCONNECT:
            self.left(body)
        self.obey(stream, first, body)

    def _subscribe(self, stream: ByteStream, topic: bytes, options: int) -> None:
        """Subscribe, at a broker. `options`: the QoS, and what else MQTT has there."""
        body = b"\0\1" + self._properties() + mqtt.string(topic) + bytes((options,))
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
        if not topic or b"#" in topic or b"+" in topic or len(topic) > MQTT_TOPIC:
            raise LocalProtocolError(
                "a port writes to one topic, which stands behind the broker: mqtt://HOST/TOPIC"
            )
        return topic

    def _hello(self) -> bytes:
        from urllib.parse import unquote_to_bytes

        route = self.route
        seconds = route.spec.value(SESSION)
        mark = os.urandom(4).hex() if seconds is None else f"{crc32(self.topic):08x}"
        client = f"yarpy{route.source.replace('/', '-')}-{mark}"
        words = [route.spec.value(key) for key in ("user", "password")]
        user, password = (
            None if word is None else unquote_to_bytes(word.encode("utf-8", "surrogateescape"))
            for word in words
        )
        flags = (
            (CLEAN if seconds is None else 0)
            | (0x80 if user is not None else 0)
            | (0x40 if password is not None else 0)
        )
        will: tuple[bytes, ...] = ()
        if (text := route.spec.value("will")) is not None:
            will = self._one_topic(), unquote_to_bytes(text.encode("utf-8", "surrogateescape"))
            flags |= WILL | (self.qos << 3) | (0x20 if "retain" in route.spec.tokens else 0)
        body = mqtt.string(b"MQTT") + bytes((self.version, flags))
        kept = (
            b""
            if seconds is None
            else bytes((mqtt.SESSION_EXPIRY,)) + int(seconds).to_bytes(4, "big")
        )
        body += KEEP_ALIVE.to_bytes(2, "big") + self._properties(kept)
        body += mqtt.string(client.encode("utf-8", "replace")[:1000])
        if will:
            body += self._properties() + b"".join(map(mqtt.string, will))
        for part in (user, password):
            if part is not None:
                body += mqtt.string(part)
        return mqtt.packet(mqtt.CONNECT, body)

    @property
    def qos(self) -> int:
        """The quality of service that the carrier string names: 0, 1 or 2."""
        return int(self.route.spec.value("qos") or 0)

    def encode_quit(self, stream: ByteStream) -> None:
        stream.write(mqtt.packet(mqtt.DISCONNECT))


class Publisher(Client):
    """A port that writes to a broker's topic."""

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
        stream = yield from self._enter(stream)
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
        head += self._said_beside(packet)
        pieces = mqtt.publish(head, payload, self._first)
        if not self.acks and 0 < self.most < sum(map(len, pieces)):
            self.lost += 1
            return
        self._small = len(pieces) == 1 and len(pieces[0]) < SMALL
        stream.write(*pieces)

    def encode_quit(self, stream: ByteStream) -> None:
        super().encode_quit(stream)
        self._over = True

    def expect_ack(self, stream: ByteStream) -> Steps[None]:
        while self._open:
            first, body = yield from mqtt.read_packet(stream, MQTT_HEARD)
            kind = first & 0xF0
            if kind == mqtt.PUBREC:  # the broker has it, and forgets its number once we say so
                stream.write(mqtt.packet(mqtt.PUBREL | 2, bytes(body[:2])))
                continue
            if kind not in (mqtt.PUBACK, mqtt.PUBCOMP):
                self.aside(stream, first, body)
                continue
            if mqtt.Body(body).number(2) != self._open.popleft():
                raise RemoteProtocolError("the broker acknowledges another message")
            return
        if not self._over:
            raise RemoteProtocolError("the broker acknowledges what was not sent")


class Subscriber(Client):
    """A port that reads from a broker's topics."""

    push = False

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        # Once it has dialled, the broker is the source, and the port the target.
        self._topic, self._place = self.topic, BROKER.match(route.target)

    def greet(self, stream: ByteStream) -> Steps[None]:
        topic = self._topic
        if not topic or len(topic) > MQTT_TOPIC:
            raise LocalProtocolError("the topic stands behind the broker: mqtt+sub://HOST/TOPIC")
        stream = yield from self._enter(stream)
        known = yield from self._connect(stream)
        handling = int(self.route.spec.value(HANDLING) or 0)
        self._subscribe(stream, topic, self.qos | handling << 4)
        if known:  # what it has kept may come before its answer
            return
        first, body = yield from mqtt.read_packet(stream, MQTT_HEARD)
        self._subscribed(topic, first, body)

    def obey(self, stream: ByteStream, first: int, body: Buffer) -> None:
        if first == mqtt.SUBACK:
            self._subscribed(self._topic, first, body)
        else:
            super().obey(stream, first, body)

    def source_of(self, topic: Buffer) -> str:
        shown = readable(bytes(topic).decode("utf-8", "replace"))
        return f"{self._place[0]}{shown}" if self._place else ""


class Asker(Client):
    """A port that asks whoever has subscribed to a broker's topic (version 5)."""

    acks = False
    limits = Limits(message_timeout=None)  # who answers may take as long as it likes

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self._topic = b""
        self._answers = b"yarpy/answers/" + os.urandom(8).hex().encode()
        self._number = 0  # of the last question

    def greet(self, stream: ByteStream) -> Steps[None]:
        self._topic = self._one_topic()
        stream = yield from self._enter(stream)
        yield from self._connect(stream)
        self._subscribe(stream, self._answers, 1)  # answered before any question is

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        payload = b"".join(packet.blocks) if self.raw else to_payload(packet)
        properties = b""
        if packet.key == CALL:
            self._number = self._number % 65535 + 1
            properties = bytes((mqtt.RESPONSE_TOPIC,)) + mqtt.string(self._answers)
            properties += bytes((mqtt.CORRELATION_DATA,)) + mqtt.string(self._correlation)
        head = mqtt.string(self._topic)
        if packet.key == CALL:  # its acknowledgement tells whether there is anybody
            head += self._correlation
        head += self._said_beside(packet, properties)
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
            elif kind != mqtt.PUBACK:
                self.aside(stream, first, body)
            elif bytes(body[:3]) == self._correlation + bytes((mqtt.NO_MATCHING_SUBSCRIBERS,)):
                topic = readable(self._topic.decode("utf-8", "replace"))
                why = f"nobody has subscribed to {topic} at the broker"
                return Message(CALL, b"".join(codec.encode([Vocab("fail"), why])))

    def aside(self, stream: ByteStream, first: int, body: Buffer) -> None:
        kind = first & 0xF0
        if kind == mqtt.PUBLISH:
            self._answer(stream, first, body)  # too late
        elif kind == mqtt.SUBACK:
            self._subscribed(self._answers, first, body)
        elif kind != mqtt.PUBACK:
            super().aside(stream, first, body)

    def _answer(self, stream: ByteStream, first: int, body: Buffer) -> Message | None:
        """The answer to our last question; None for one that came too late."""
        said = mqtt.Body(body)
        said.string()
        if first & mqtt.QOS:
            stream.write(mqtt.packet(mqtt.PUBACK, said.take(2)))
        if said.properties().get(mqtt.CORRELATION_DATA) != self._correlation:
            return None
        payload = said.rest()
        return Message(CALL, payload) if self.raw else message_of(CALL, [payload])
