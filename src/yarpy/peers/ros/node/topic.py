"""The topics of a node of ROS 1: a port that publishes one, a port that subscribes to one.

Rules: they are ports of YARP, too, of whatever name the topic has. What is written and read are
objects of the topic's type.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, TypeAlias

from yarpy.data.stamp import Stamp
from yarpy.errors import (
    YarpError,
)
from yarpy.link.send.outbound import Outbound
from yarpy.peers.ros.carrier import TcpRos
from yarpy.peers.ros.membership import Membership
from yarpy.peers.ros.message.message import Message as RosMessage
from yarpy.peers.ros.message.message import Time
from yarpy.port.mailbox import Callback, Mailbox
from yarpy.port.port import MessagePort, envelope_of
from yarpy.wire.message import Message, Packet

#: opens the port of a membership
Open: TypeAlias = Callable[[Membership, Mailbox], Any]


def _complete(message: Any, now: Stamp) -> None:
    """Write the number into the header of a message, and the time where it says none."""
    header = message.header
    header.seq = now.count
    if not any(header.stamp):
        header.stamp = Time.from_sec(now.time)


class Publisher(MessagePort):
    """Publishes a topic: `publisher.write(value)`."""

    def __init__(self, open_: Open, member: Membership, kind: type[RosMessage]) -> None:
        self.type = kind
        self._member = member
        self._count = 0
        self._headed = kind._has_header
        super().__init__(open_(member, Callback(lambda message: None)))

    def write(
        self,
        value: object,
        stamp: Stamp | str | None = None,
        *,
        wait: bool = False,
        timeout: float | None = None,
    ) -> int:
        """Send `value` to every subscriber; returns how many connections took it.

        `stamp` goes into the header, if the type has one. Without it messages are counted there
        from 1, as rospy does; dicts that say no time, images and other values of YARP get the
        present one, and objects of the type keep their own. Raises PortClosed;
        TypeError, ValueError or OverflowError for a value that does not fit the type.
        """
        if stamp is None:
            self._count = (self._count + 1) & 0x7FFFFFFF
            if self._headed and isinstance(value, RosMessage):
                header: Any = value
                header.header.seq = self._count
        plain = stamp is None and timeout is None and not wait and not self._member.latched
        if plain and type(value) is self.type:
            return self._write_at_once(value)
        if not isinstance(value, RosMessage):
            from yarpy.peers.ros.message.convert.native import to_message

            now = Stamp(self._count, self._member.clock()) if stamp is None else None
            value = to_message(value, self.type, now)
            if self._headed and now is not None:
                _complete(value, now)
        elif type(value) is not self.type and _identity(type(value)) != _identity(self.type):
            raise TypeError(f"{self.name} takes {self.type._type}, not {value._type}")
        if self._member.latched:
            envelope = envelope_of(stamp) if stamp is not None else b""
            self._member.last = Packet(value, envelope)
        return super().write(value, stamp, wait=wait, timeout=timeout)

    def _write_at_once(self, value: object) -> int:
        """As `write`, for an object of the type and nothing else: what is small is encoded once and
        sent to all that can take it now. The usual way takes three times as long."""
        hub, kind = self._hub, self.type
        outputs = hub.outputs.links
        if (
            hub.life.closing
            or hub.life.interrupted
            or hub.monitoring.output is not None
            or not outputs
        ):
            return super().write(value)
        took, data = 0, None
        rest: list[Outbound] = []
        for link in outputs:
            carrier = link.carrier
            if type(carrier) is TcpRos and carrier.kind is kind:
                data = carrier.whole(value) if data is None else data
                if data is None:
                    return super().write(value)  # to all: it is large, or not what its type says
                try:
                    if link.active and not link.log and link.send_whole(data):
                        took += 1
                        continue
                except YarpError as error:
                    self._lose(link, error)
                    continue
            rest.append(link)
        return took + self._send_all(Packet(value), tuple(rest), False, None) if rest else took


class Subscriber(MessagePort):
    """Subscribes to a topic: `subscriber.read()`, or `for message in subscriber.messages()`."""

    def __init__(
        self, open_: Open, member: Membership, kind: type[RosMessage] | None, mailbox: Mailbox
    ) -> None:
        self.type = kind
        super().__init__(open_(member, mailbox))

    def take(self, timeout: float | None = None) -> Any:
        """The next message, as an object of the type. Raises Timeout, PortClosed, DecodeError."""
        return value_of(self.read(timeout))

    def messages(self) -> Iterator[Any]:
        """Messages as objects of the type, until the port is closed."""
        for message in self:
            yield value_of(message)


def value_of(message: Message) -> Any:
    """A received message as an object of its type; one that came without a type as its value."""
    return getattr(message, "ros", None) or message.value


def _identity(kind: type[RosMessage]) -> tuple[str, str]:
    return kind._type, kind._md5sum
