"""ros2: topics and services of ROS 2 whose nodes speak Zenoh (RMW_IMPLEMENTATION=rmw_zenoh_cpp).

    yarpy connect /out ros2://chatter           the port publishes what it writes
    yarpy connect ros2://camera/image /in       the port subscribes
    yarpy connect /client ros2+srv://add        the port asks a service
    yarpy connect ros2+srv://add /server        the port serves it

    ros2://chatter~std_msgs/msg/String          says the type, which the graph knows otherwise
    ros2+domain.7+node.arm+qos.sensor://...     `qos`: default, sensor, latched, all

Rules: those of `hosted`; `yarpy.ros2` has the endpoints (`Topic`). A message that is not of the
type is not sent, and counted.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final, Protocol

from yarpy.carriers.base import Carrier, Limits
from yarpy.carriers.hosted import LISTENS, SERVICE, Hosted, failure
from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError
from yarpy.log import logger
from yarpy.peers.ros2.body import Ros2Message, encode_body, time_of, value_of
from yarpy.peers.ros2.qos import WORDS
from yarpy.route import Route
from yarpy.wire.message import CALL, DATA, UNSENDABLE, Encoded, Message, Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import Buffer, ByteStream, ObjectStream

log = logger("yarpy.link")

GONE: Final = "who serves"  # so begins why there is no answer, where a server went away meanwhile


class Topic(Protocol):
    """A topic or service of ROS 2, as the carrier sees it."""

    @property
    def name(self) -> str:
        """With its leading slash."""

    @property
    def kind(self) -> Any:
        """The class of its messages, or its Service; None while nobody has said."""

    def settle(self, value: object) -> Any:
        """The class of its messages, chosen by the first value if nobody has said. Raises
        DecodeError for a value that no type is plain for."""

    @property
    def clock(self) -> Callable[[], float]:
        """The time, in seconds."""


class Outgoing:
    """A message, question or answer that goes. `time` is in nanoseconds, 0 for now. `to`: what it
    answers; `failure`: why there is no answer. `size`: in bytes."""

    __slots__ = ("body", "failure", "kind", "size", "time", "to")

    def __init__(
        self,
        kind: Any,
        body: tuple[Buffer, ...],
        time: int = 0,
        to: Any = None,
        failure: str = "",
    ) -> None:
        self.kind, self.body, self.time, self.to, self.failure = kind, body, time, to, failure
        self.size = len(body[0]) if len(body) == 1 else sum(map(len, body))


class Incoming:
    """A message, question or answer that came; `number` and `time` stood beside it. `asked`: the
    question, to be answered. `failure`: why there is no answer. `size`: in bytes."""

    __slots__ = ("asked", "body", "failure", "number", "size", "time")

    def __init__(
        self, body: Buffer, number: int = 0, time: int = 0, asked: Any = None, failure: str = ""
    ) -> None:
        self.body, self.number, self.time = body, number, time
        self.asked, self.failure = asked, failure
        self.size = len(body)


class Ros2(Hosted):
    """A publisher; or one of the classes below."""

    name = "ros2"
    over = "ros2"
    words = (
        *(SERVICE, LISTENS, "domain.N", "node.NAME", "qos.NAME", "dds", "distro.humble"),
        *WORDS,
    )

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self.topic: Topic | None = None
        self._told = ""  # of a message that does not fit

    @classmethod
    def roles(cls) -> tuple[type[Carrier], type[Carrier], type[Carrier]]:
        return Subscriber, Asker, Server

    @property
    def kind(self) -> Any:
        """The class of the messages, or the Service."""
        return None if self.topic is None else self.topic.kind

    def greet(self, stream: ByteStream) -> Steps[None]:
        self.topic = yield from self.read_object(stream)

    def prepare(self, packet: Packet) -> bool:
        try:
            kind, body = self._body(packet)
        except UNSENDABLE as error:
            self._complain(str(error))
            return False
        if any(type(block) is not bytes for block in body):  # it leaves later
            packet.forms["ros2", kind] = tuple(map(bytes, body))
        return True

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        topic = self.topic
        assert topic is not None
        try:  # as `_body`, spelled out
            kind = topic.kind or topic.settle(value_of(packet))
            body = encode_body(packet, kind, topic.clock)
        except UNSENDABLE as error:
            self._complain(str(error))
            self.lost += 1
            return
        self._told = ""
        when = time_of(packet) if packet.envelope else 0
        item: Any = Outgoing(kind, body, when)
        stream.output.append(item)  # as `write_object`, spelled out

    def _body(self, packet: Packet) -> tuple[Any, tuple[Buffer, ...]]:
        topic = self.topic
        assert topic is not None
        kind = topic.kind or topic.settle(value_of(packet))
        return kind, encode_body(packet, kind, topic.clock)

    def _complain(self, text: str) -> None:
        """Say why a message is not sent, once for as long as they follow each other."""
        if text != self._told:
            self._told = text
            route = self.route
            log.warning("%s: a message is not sent to %s: %s", route.source, route.target, text)


class Subscriber(Ros2):
    """The port reads what is published."""

    push = False

    def parse(self, stream: ByteStream) -> Message | None:
        assert isinstance(stream, ObjectStream)
        if not stream.items:
            return None
        came: Any = stream.items.pop(0)
        topic = self.topic
        assert topic is not None
        kind = topic.kind
        return Ros2Message(DATA, came.body, kind, kind._has_header, came.number, came.time)

    def decode(self, stream: ByteStream) -> Steps[Message]:
        came, kind = (yield from self.read_object(stream)), self.kind
        return Ros2Message(DATA, came.body, kind, kind._has_header, came.number, came.time)


class Asker(Ros2):
    """The port asks a service."""

    replies = True
    limits = Limits(message_timeout=None)

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        topic = self.topic
        assert topic is not None
        body = encode_body(packet, topic.kind.Request, topic.clock)
        self.write_object(stream, Outgoing(topic.kind, body, time_of(packet)))

    def prepare(self, packet: Packet) -> bool:
        topic = self.topic
        assert topic is not None
        body = encode_body(packet, topic.kind.Request, topic.clock)
        packet.forms["ros2", topic.kind.Request] = tuple(map(bytes, body))
        return True

    def expect_reply(self, stream: ByteStream) -> Steps[Message | None]:
        came = yield from self.read_object(stream)
        if came.failure:
            return failure(came.failure)
        return Ros2Message(CALL, came.body, self.kind.Response, False, came.number, came.time)


class Server(Ros2):
    """The port serves a service."""

    push = False
    replies = True

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self._asked: Any = None

    def decode(self, stream: ByteStream) -> Steps[Message]:
        while True:
            came = yield from self.read_object(stream)
            try:
                self.kind.Request.from_ros(came.body)
            except DecodeError as error:  # its asker is told; others go on
                self.write_object(
                    stream, Outgoing(self.kind, (), to=came.asked, failure=str(error))
                )
                self.lost += 1
                continue
            self._asked = came.asked
            return Ros2Message(CALL, came.body, self.kind.Request, False, came.number, came.time)

    def encode_reply(self, stream: ByteStream, value: object) -> None:
        topic = self.topic
        assert topic is not None
        reason, body = _reason(value), ()  # type: tuple[str | None, tuple[Buffer, ...]]
        if reason is None:
            try:
                body = encode_body(Packet(value), topic.kind.Response, topic.clock)
            except UNSENDABLE as error:
                if value != Bottle():
                    raise
                reason = f"the service gave no answer ({error})"
        asked, self._asked = self._asked, None
        self.write_object(stream, Outgoing(topic.kind, body, to=asked, failure=reason or ""))


def _reason(value: object) -> str | None:
    """Why there is no answer: the text in `[fail] "text"`."""
    if isinstance(value, Encoded):
        value = codec.decode(value.data)
    is_list = isinstance(value, (list, tuple)) and value
    if is_list and isinstance(value[0], Vocab) and value[0] == "fail":  # type: ignore[index]
        return plain_text(value[1]) if len(value) > 1 else "it failed"  # type: ignore[index, arg-type]
    return None
