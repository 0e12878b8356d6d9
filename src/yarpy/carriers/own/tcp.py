"""tcp and fast_tcp: YARP's own protocols over a TCP stream, with and without acknowledgements.

Rules: the acceptor answers the greeting with a YARP number holding its port, which is ignored.
"""

from __future__ import annotations

from typing import ClassVar

from yarpy.carriers.base import ASKS_FOR_KEY, OVER_TCP, Indexed
from yarpy.errors import RemoteProtocolError
from yarpy.wire import framing
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream


class FastTcp(Indexed):
    """Messages follow one another; only replies come back."""

    name = "fast_tcp"
    words = OVER_TCP
    code = 3

    @classmethod
    def matches(cls, value: int) -> bool:
        return value % 16 == 3 and not value & 128

    def greet(self, stream: ByteStream) -> Steps[None]:
        yield from super().greet(stream)
        answer = yield from framing.read_answer(stream)
        if framing.parse_number(answer) < 0:
            raise RemoteProtocolError(f"expected a number, got {answer!r}; {ASKS_FOR_KEY}")

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[None]:
        yield from super().welcome(stream, first)
        stream.write(framing.number(self.route.port))


class Tcp(FastTcp):
    """The default: each message is acknowledged once the receiver has taken it."""

    name = "tcp"
    code: ClassVar[int] = 3 + 128
    acks = True

    @classmethod
    def matches(cls, value: int) -> bool:
        return value % 16 == 3 and bool(value & 128)


class Tls(Tcp):
    """`tcp+tls` in one word, for the dialling side. The other side sees tcp inside TLS."""

    name = "tls"

    @classmethod
    def recognises(cls, first: bytes) -> int:
        return 0
