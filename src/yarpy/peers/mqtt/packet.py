"""MQTT 3.1.1 and 5: packets, and what is in them.

    first byte (kind and flags), length (7 bits a byte, low first, at most 4 bytes), body

Rules: pure. Strings are UTF-8 behind a length of two bytes. Version 5 has properties, which version
3.1.1 (number 4 on the wire) has not. Lengths are checked before memory is taken; a body that ends
too early raises RemoteProtocolError.
"""

from __future__ import annotations

from typing import Final

from yarpy.errors import RemoteProtocolError
from yarpy.wire.steps import Steps
from yarpy.wire.stream import Buffer, ByteStream

V3: Final = 4
V5: Final = 5

CONNECT: Final = 0x10
CONNACK: Final = 0x20
PUBLISH: Final = 0x30
PUBACK: Final = 0x40
PUBREC: Final = 0x50
PUBREL: Final = 0x60
PUBCOMP: Final = 0x70
SUBSCRIBE: Final = 0x80
SUBACK: Final = 0x90
UNSUBSCRIBE: Final = 0xA0
UNSUBACK: Final = 0xB0
PINGREQ: Final = 0xC0
PINGRESP: Final = 0xD0
DISCONNECT: Final = 0xE0

RETAIN: Final = 0x01
QOS: Final = 0x06

NO_MATCHING_SUBSCRIBERS: Final = 0x10  # the reason in a PUBACK: nobody has subscribed

NO_SHARING: Final = 0x9E  # the reason in a SUBACK: there are no shared subscriptions

NOT_FOUND: Final = 0x92  # the reason in a PUBCOMP: no message has that number

REFUSED: Final = 0x80  # a reason from here on says that something was not done

NO_METHOD: Final = 0x8C  # the reason in a CONNACK: there are no logins of that kind

WITH_WILL: Final = 0x04  # the reason in a DISCONNECT: the will is to be published all the same

MESSAGE_EXPIRY: Final = 0x02  # of a message, in seconds
RESPONSE_TOPIC: Final = 0x08
CORRELATION_DATA: Final = 0x09
SUBSCRIPTION: Final = 0x0B  # the number of a subscription, which its messages have
SESSION_EXPIRY: Final = 0x11  # of a session, in seconds
SERVER_KEEP_ALIVE: Final = 0x13
WILL_DELAY: Final = 0x18  # of a will, in seconds
METHOD: Final = 0x15  # of a login in several steps
RECEIVE_MAXIMUM: Final = 0x21
MOST_QOS: Final = 0x24
RETAIN_AVAILABLE: Final = 0x25
MOST_BYTES: Final = 0x27  # of a packet that the peer takes
SHARING_AVAILABLE: Final = 0x2A

_BYTES: Final = frozenset((0x01, 0x17, 0x19, 0x24, 0x25, 0x28, 0x29, 0x2A))
_SHORTS: Final = frozenset((0x13, 0x21, 0x22, 0x23))
_LONGS: Final = frozenset((0x02, 0x11, 0x18, 0x27))
_STRINGS: Final = frozenset((0x03, 0x08, 0x09, 0x12, 0x15, 0x16, 0x1A, 0x1C, 0x1F))
USER: Final = 0x26  # a name and a value

#: first byte and body
Packet = tuple[int, Buffer]


# -- writing --------------------------------------------------------------------------------------


def varint(value: int) -> bytes:
    """A length.

    >>> varint(127).hex(), varint(128).hex(), varint(321).hex(" ")
    ('7f', '8001', 'c1 02')
    """
    found = bytearray()
    while True:
        value, low = divmod(value, 128)
        found.append(low | (0x80 if value else 0))
        if not value:
            return bytes(found)


def string(data: bytes) -> bytes:
    """A string, or binary data, of at most 65535 bytes."""
    return len(data).to_bytes(2, "big") + data


def packet(first: int, body: bytes = b"") -> bytes:
    """A packet.

    >>> packet(PINGREQ).hex(" ")
    'c0 00'
    """
    return bytes((first,)) + varint(len(body)) + body


def publish(head: bytes, payload: Buffer, first: int = PUBLISH) -> tuple[Buffer, ...]:
    """A PUBLISH in pieces; a large payload is not copied. `head`: topic, number, properties."""
    start = bytes((first,)) + varint(len(head) + len(payload)) + head
    return (start + payload,) if len(payload) < 1 << 14 else (start, payload)


# -- reading --------------------------------------------------------------------------------------


def read_packet(stream: ByteStream, limit: int) -> Steps[Packet]:
    """A packet with a body of at most `limit` bytes."""
    first = bytes((yield from stream.read_exact(1)))[0]
    size = 0
    for place in range(4):
        byte = bytes((yield from stream.read_exact(1)))[0]
        size |= (byte & 127) << (7 * place)
        if byte < 128:
            break
    else:
        raise RemoteProtocolError("a packet of MQTT whose length has no end")
    if size > limit:
        raise RemoteProtocolError(f"a packet of {size} bytes is announced; the limit is {limit}")
    return first, (yield from stream.read_exact(size))


def parse_packet(stream: ByteStream, limit: int) -> Packet | None:
    """As `read_packet`, for a packet that is already complete in the stream's buffer, or None."""
    buffer, at, tail = stream.buffer, stream.head, stream.tail
    size = 0
    for place in range(4):
        if at + 1 + place >= tail:
            return None
        byte = buffer[at + 1 + place]
        size |= (byte & 127) << (7 * place)
        if byte < 128:
            break
    else:
        raise RemoteProtocolError("a packet of MQTT whose length has no end")
    if size > limit:
        raise RemoteProtocolError(f"a packet of {size} bytes is announced; the limit is {limit}")
    start = at + 2 + place
    if tail - start < size:
        return None
    stream.head = start + size
    return buffer[at], bytes(buffer[start : stream.head])


class Body:
    """A cursor over the body of a packet."""

    def __init__(self, data: Buffer) -> None:
        self._data = memoryview(data)
        self._at = 0

    def __bool__(self) -> bool:
        return self._at < len(self._data)

    def take(self, size: int) -> bytes:
        """So many bytes."""
        start = self._at
        self._at = start + size
        if self._at > len(self._data):
            raise RemoteProtocolError("a packet of MQTT that ends too early")
        return bytes(self._data[start : self._at])

    def number(self, size: int) -> int:
        """An integer of so many bytes."""
        return int.from_bytes(self.take(size), "big")

    def string(self) -> bytes:
        """A string, or binary data."""
        return self.take(self.number(2))

    def varint(self) -> int:
        """A number of one to four bytes."""
        value = 0
        for place in range(4):
            byte = self.number(1)
            value |= (byte & 127) << (7 * place)
            if byte < 128:
                return value
        raise RemoteProtocolError("a number of MQTT that has no end")

    def rest(self) -> memoryview:
        """Everything that is left."""
        found = self._data[self._at :]
        self._at = len(self._data)
        return found

    def properties(self, pairs: list[tuple[bytes, bytes]] | None = None) -> dict[int, bytes]:
        """The properties of version 5 that have one value; of two alike the last. Those of users
        are added to `pairs`."""
        inner = Body(self.take(self.varint()))
        found: dict[int, bytes] = {}
        while inner:
            key = inner.number(1)
            if key in _STRINGS:
                found[key] = inner.string()
            elif key in _BYTES:
                found[key] = inner.take(1)
            elif key in _SHORTS:
                found[key] = inner.take(2)
            elif key in _LONGS:
                found[key] = inner.take(4)
            elif key == SUBSCRIPTION:
                found[key] = inner.varint().to_bytes(4, "big")
            elif key == USER:
                pair = inner.string(), inner.string()
                if pairs is not None:
                    pairs.append(pair)
            else:
                raise RemoteProtocolError(f"a packet of MQTT with the property {key:#04x}")
        return found


def matches(pattern: str, topic: str) -> bool:
    """Return whether a subscription matches a topic.

    >>> matches("robot/+/state", "robot/arm/state"), matches("robot/#", "robot"), matches("#", "x")
    (True, True, True)
    >>> matches("robot/+", "robot/arm/state"), matches("robot", "robot/arm")
    (False, False)
    """
    wanted, levels = pattern.split("/"), topic.split("/")
    for place, want in enumerate(wanted):
        if want == "#":
            return place == len(wanted) - 1
        if place >= len(levels) or want not in ("+", levels[place]):
            return False
    return len(wanted) == len(levels)
