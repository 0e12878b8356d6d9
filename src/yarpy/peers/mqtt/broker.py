"""A port as a client of MQTT's brokers: it publishes, subscribes, and asks.

Rules: `hello` says what a broker is asked for. It is promised a sign of life within KEEP_ALIVE, or
what it wishes instead; the port sends it (`ping`). `+ws` comes in the frames of a WebSocket. A
message that a broker of version 5 acknowledges with a reason not to pass it on is counted as lost,
and the log says why.
"""

from __future__ import annotations

import os
from collections import deque
from dataclasses import replace
from typing import Final

from yarpy.carriers.base import Limits
from yarpy.carriers.payload import message_of, to_payload
from yarpy.carriers.web.upgrade import ask_for_websocket
from yarpy.data import codec
from yarpy.data.value import Vocab
from yarpy.errors import LocalProtocolError, LoginRefused, RemoteProtocolError
from yarpy.limit import MQTT_CONNECT, MQTT_HEARD, MQTT_TOPIC
from yarpy.log import logger, readable
from yarpy.peers.mqtt import packet as mqtt
from yarpy.peers.mqtt.hello import KEEP_ALIVE, WEBSOCKET, hello, one_topic, qos_of, seconds_of
from yarpy.peers.mqtt.session import BROKER, DELAY, EXPIRY, HANDLING, MqttPeer
from yarpy.route import Route
from yarpy.wire.effects import Switch
from yarpy.wire.frame_stream import BINARY, FrameStream, frame
from yarpy.wire.message import CALL, SMALL, Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import Buffer, ByteStream

log = logger("yarpy.link")

MOST_IN_FLIGHT: Final = 20  # messages with QoS 2 under way; of more, mosquitto loses some
_NUMBERS: Final = 2 * MOST_IN_FLIGHT  # of messages in a session that the broker keeps
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
_LOGIN: Final = frozenset((4, 5, 0x86, 0x87))


_NOT_PASSED_ON: Final = {
    0x87: "it does not allow us to write to this topic",
    0x90: "it does not like the topic",
    0x97: "it has no room for more",
    0x99: "the payload is not in the form that it wants",
}
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


class Client(MqttPeer):
    """A port that has dialled a broker."""

    limits = Limits(ping=mqtt.packet(mqtt.PINGREQ), ping_interval=KEEP_ALIVE / 2)

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
        ping = b"".join(frame(BINARY, True, self.limits.ping))
        self.limits = replace(self.limits, ping=ping)
        yield Switch(None, inside)
        return inside

    def _connect(self, stream: ByteStream) -> Steps[bool]:
        """Become a client of the broker; return whether it knows us from before."""
        stream.write(hello(self))
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
        every = self.limits.ping_interval
        if self.version == mqtt.V5:
            wishes = said.properties()
            if (wish := wishes.get(mqtt.SERVER_KEEP_ALIVE)) is not None:
                every = int.from_bytes(wish, "big") / 2
            if (most := wishes.get(mqtt.RECEIVE_MAXIMUM)) is not None:
                ahead = min(ahead, max(1, int.from_bytes(most, "big")))
            self._agree(wishes)
            self.most = int.from_bytes(wishes.get(mqtt.MOST_BYTES, b""), "big")
        self.limits = replace(self.limits, ahead=ahead, ping_interval=every)
        return bool(body[0] & 1)

    def _agree(self, wishes: dict[int, bytes]) -> None:
        """Raise RemoteProtocolError if the broker does not do what it is to be asked for."""
        most = wishes.get(mqtt.MOST_QOS, b"\2")[0]
        if self.push and self.qos > most:
            raise RemoteProtocolError(f"the broker knows QoS 0 to {most} alone: say +qos.{most}")
        if "retain" in self.route.spec.tokens and wishes.get(mqtt.RETAIN_AVAILABLE) == b"\0":
            raise RemoteProtocolError("the broker retains nothing: leave +retain out")

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
        body = b"\0\1" + self.properties() + mqtt.string(topic) + bytes((options,))
        stream.write(mqtt.packet(mqtt.SUBSCRIBE | 2, body))

    def _subscribed(self, topic: bytes, first: int, body: Buffer) -> None:
        """See whether the broker agrees."""
        if first != mqtt.SUBACK or len(body) < 3:
            raise RemoteProtocolError("the broker does not answer a subscription")
        if bytes(body)[-1] > 2:
            shown = readable(topic[:80].decode("utf-8", "replace"))
            raise RemoteProtocolError(f"the broker refuses the subscription to {shown}")

    @property
    def qos(self) -> int:
        """The quality of service that the carrier string names: 0, 1 or 2."""
        return qos_of(self.route.spec)

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
        self._refused = set[int]()  # of those the ones that the broker did not take
        self._reasons = set[int]()  # that the log has told
        self._over = False
        self.acks = False
        self._kept = route.spec.value(DELAY) is not None  # the broker keeps a session for us
        self._expiry = seconds_of(mqtt.MESSAGE_EXPIRY, route.spec.value(EXPIRY))
        self._numbers = _NUMBERS if self._kept and self.qos == 2 else 65535

    def greet(self, stream: ByteStream) -> Steps[None]:
        self.acks = bool(self.qos)
        self._head = mqtt.string(one_topic(self))
        stream = yield from self._enter(stream)
        retain = mqtt.RETAIN if "retain" in self.route.spec.tokens else 0
        self._first = mqtt.PUBLISH | (self.qos << 1) | retain
        known = yield from self._connect(stream)
        if known and self.qos == 2:
            yield from self._release(stream)

    def _release(self, stream: ByteStream) -> Steps[None]:
        """Let go of the numbers of messages that the last connection had under way: the broker
        would take new messages with them for the same once more."""
        for number in range(1, _NUMBERS + 1):
            stream.write(mqtt.packet(mqtt.PUBREL | 2, number.to_bytes(2, "big")))
        for _ in range(_NUMBERS):
            first, _ = yield from mqtt.read_packet(stream, MQTT_HEARD)
            if first & 0xF0 != mqtt.PUBCOMP:
                raise RemoteProtocolError("the broker does not let go of messages of before")

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
            self._number = self._number % self._numbers + 1
            self._open.append(self._number)
            head += self._number.to_bytes(2, "big")
        head += self._said_beside(packet, self._expiry)
        pieces = mqtt.publish(head, payload, self._first)
        if not self.acks and 0 < self.most < sum(map(len, pieces)):
            self.lost += 1
            return
        self._small = len(pieces) == 1 and len(pieces[0]) < SMALL
        stream.write(*pieces)

    def encode_quit(self, stream: ByteStream) -> None:
        if self._kept:  # a goodbye that ends the session, too
            end = bytes((mqtt.SESSION_EXPIRY, 0, 0, 0, 0))
            stream.write(mqtt.packet(mqtt.DISCONNECT, b"\0" + self.properties(end)))
        else:
            super().encode_quit(stream)
        self._over = True

    def expect_ack(self, stream: ByteStream) -> Steps[None]:
        while self._open:
            if self._open[0] in self._refused:
                self._refused.discard(self._open.popleft())
                return
            first, body = yield from mqtt.read_packet(stream, MQTT_HEARD)
            kind = first & 0xF0
            if kind in (mqtt.PUBACK, mqtt.PUBREC) and self._is_refusal(body):
                self._refused.add(mqtt.Body(body).number(2))
                continue
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

    def _is_refusal(self, body: Buffer) -> bool:
        """Return whether an acknowledgement says that the message goes nowhere; it is lost then."""
        if self.version != mqtt.V5 or len(body) < 3 or body[2] < mqtt.REFUSED:
            return False
        reason = body[2]
        self.lost += 1
        if reason not in self._reasons:
            self._reasons.add(reason)
            why = _NOT_PASSED_ON.get(reason, f"for reason {reason:#04x}")
            log.warning("%s: the broker does not pass on what it gets: %s", self.route.source, why)
        return True


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
    # Who answers may take as long as it likes.
    limits = replace(Client.limits, message_timeout=None)

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self._topic = b""
        self._answers = b"yarpy/answers/" + os.urandom(8).hex().encode()
        self._number = 0  # of the last question

    def greet(self, stream: ByteStream) -> Steps[None]:
        self._topic = one_topic(self)
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
