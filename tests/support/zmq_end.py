"""A port's side of a connection that a socket of ZeroMQ has dialled, without a socket."""

from __future__ import annotations

from typing import Any

from yarpy.carriers.base import Carrier
from yarpy.peers.zmq import zmtp
from yarpy.peers.zmq.carrier import Zmq
from yarpy.route import Route
from yarpy.testing import End
from yarpy.wire.message import Message, Packet


def accepted(kind: bytes, piece: int = 0, minor: int = 1) -> tuple[End, Carrier]:
    """The port's side of a connection that a socket has dialled, and what the port is there.

    piece: bytes that come at once, 0 for all. minor: of the version that the socket speaks.
    """
    end = End(piece)
    found: list[Carrier] = []

    def steps() -> Any:
        first = bytes((yield from end.stream.read_exact(8)))
        carrier: Carrier = Zmq(Route("", "/port", "zmq", 10002))
        while (other := (yield from carrier.welcome(end.stream, first))) is not None:
            carrier = other
        found.append(carrier)

    end.begin(steps())
    greeting = bytearray(zmtp.GREETING)
    greeting[11] = minor
    end.feed(bytes(greeting[:11]))
    assert end.take() == zmtp.OPENING  # libzmq waits for that
    end.feed(bytes(greeting[11:]))
    assert zmtp.OPENING + end.take() == zmtp.GREETING
    end.feed(zmtp.ready({"Socket-Type": kind}))
    assert end.done
    return end, found[0]


def hear(end: End, carrier: Carrier, data: bytes) -> bytes:
    """What is answered when a reader says `data`."""
    steps = carrier.listen(end.stream)
    assert steps is not None
    next(steps)
    end.stream.feed(data)
    next(steps)
    return end.take()


def written(end: End, carrier: Carrier, value: Any) -> bytes:
    end.take()
    carrier.encode(end.stream, Packet(value))
    return end.take()


def read(end: End, carrier: Carrier, data: bytes) -> Message:
    end.begin(carrier.decode(end.stream))
    end.feed(data)
    assert end.done
    message: Message = end.result
    return message
