"""shmem: greets over TCP as C++ does, then speaks tcp's messages elsewhere."""

from __future__ import annotations

import json
import struct

import pytest
from support.capture import CAPTURES, load_capture

from yarpy.carriers.own.shmem import Shmem
from yarpy.errors import RemoteProtocolError
from yarpy.route import Route
from yarpy.testing import CarrierConformance, End
from yarpy.transports.shared.sysv import available
from yarpy.wire import framing
from yarpy.wire.message import Packet
from yarpy.wire.stream import ByteStream, run

pytestmark = pytest.mark.skipif(not available(), reason="no memory of System V here")

GREETING, ANSWER = (step.data for step in load_capture("shmem_handshake").steps)


class TestShmem(CarrierConformance):
    carrier = Shmem


def test_golden_greeting() -> None:
    end = End()
    end.begin(Shmem(Route("/cap/out", "/cap/in", "shmem")).greet(end.stream))
    assert end.take() == GREETING
    end.feed(ANSWER)
    assert end.done
    assert [(place.kind, place.listen, place.port) for place in end.opened] == [
        ("shmem", False, 57381)
    ]


def test_golden_welcome() -> None:
    end, carrier = End(), Shmem(Route("", "/cap/in", "shmem"))
    end.begin(carrier.welcome(end.stream, GREETING[:8]))
    end.feed(GREETING[8:])
    assert end.done
    assert carrier.route.source == "/cap/out"
    assert [(place.kind, place.listen) for place in end.opened] == [("shmem", True)]
    assert end.take()[:2] == ANSWER[:2]


def ring(name: str, after: int) -> bytes:
    """What C++ had written into one of its rings."""
    found = json.loads((CAPTURES / "shmem_second_socket.json").read_text())
    memory = bytes.fromhex(found["segments"][after][f"{name}_segment_head"])
    return memory[28 : 28 + struct.unpack_from("<i", memory, 12)[0]]


def test_golden_messages() -> None:
    said, carrier, stream = ring("writer", 3), Shmem(Route("/a", "/b")), ByteStream()
    values = []
    stream.feed(said)
    while stream.waiting:
        values.append(run(carrier.decode(stream), stream, []).value)
    assert values[:2] == [[], [1, "ping", 3.14]]
    assert len(values) == 3
    for value in values:
        carrier.encode(stream, Packet(value))
    assert b"".join(stream.take_output()) == said


def test_golden_acknowledgements() -> None:
    carrier, stream = Shmem(Route("/a", "/b")), ByteStream()
    carrier.encode_ack(stream, 3)
    assert b"".join(stream.take_output()) == ring("reader", 3)


@pytest.mark.parametrize("answer", [framing.number(0), framing.number(70000), b"* Error.\r\n"])
def test_an_answer_that_is_no_port(answer: bytes) -> None:
    end = End()
    end.begin(Shmem(Route("/a", "/b", "shmem")).greet(end.stream))
    with pytest.raises(RemoteProtocolError, match="use tcp"):
        end.feed(answer)


def test_a_peer_without_the_carrier() -> None:
    end = End()
    end.begin(Shmem(Route("/a", "/b", "shmem")).greet(end.stream))
    with pytest.raises(RemoteProtocolError, match="use tcp"):
        end.feed_eof()
