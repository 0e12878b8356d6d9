"""memory: references instead of large payloads, tcp where nothing is shared, bad references."""

from __future__ import annotations

import struct
from dataclasses import replace

import pytest
from support.system import NO_MEMFD

from yarpy.carriers.own.memory import Memory
from yarpy.carriers.own.tcp import Tcp
from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.route import Route, parse_carrier
from yarpy.testing import CarrierConformance, Dialogue, End
from yarpy.testing.drive import SimulatedMemory, said
from yarpy.wire import framing
from yarpy.wire.message import Packet
from yarpy.wire.shared_stream import SharedStream
from yarpy.wire.stream import ByteStream, run

PORT = framing.number(21605)


class TestMemory(CarrierConformance):
    carrier = Memory
    missing = NO_MEMFD


def reference(
    mark: bytes = b"\0MEM",
    key: bytes = b"D",
    slot: int = 0,
    envelope: bytes = b"",
    offset: int = 0,
    size: int = 20000,
    length: int | None = None,
    where: int = 0,
) -> bytes:
    length = len(envelope) if length is None else length
    return struct.pack("<4scxH3I2Q", mark, key, where, slot, 1, length, offset, size) + envelope


def joined(kept: list[bytes]) -> tuple[Memory, SharedStream]:
    """A sender after its greeting."""
    end = End()
    end.payloads = kept
    carrier = Memory(Route("/out", "/in", "memory"))
    end.begin(carrier.greet(end.stream))
    assert end.take() == b"YARPYME1\x05\0\0\0/out\0" + struct.pack("<Q", 1)
    end.feed(PORT)
    assert end.done
    assert isinstance(end.stream, SharedStream)
    return carrier, end.stream


def test_a_large_payload_is_a_reference() -> None:
    kept: list[bytes] = []
    carrier, stream = joined(kept)
    packet = Packet([bytes(20000)], b"7 1.5")
    carrier.encode(stream, packet)
    size = len(kept[0])
    assert kept == [b"".join(packet.blocks)]
    assert b"".join(stream.take_output()) == reference(envelope=b"7 1.5", size=size)
    assert stream.aside == size


def test_a_small_one_goes_as_over_tcp() -> None:
    kept: list[bytes] = []
    carrier, stream = joined(kept)
    carrier.encode(stream, Packet([1, 2]))
    assert stream.take_output() == framing.encode(Packet([1, 2]))
    assert (kept, stream.aside) == ([], 0)


def test_one_copy_for_several_connections() -> None:
    kept: list[bytes] = []
    memory = SimulatedMemory(kept)
    packet = Packet([bytes(20000)])
    for _ in range(3):
        carrier, stream = joined([])
        carrier._memory = memory
        assert carrier.prepare(packet)
        carrier.encode(stream, packet)
    assert len(kept) == 1


def test_a_payload_in_memory_that_others_have_shown() -> None:
    carrier, stream = joined([])
    memory = SimulatedMemory([])
    memory.lend = lambda payload: 0x103  # type: ignore[method-assign]
    carrier._memory = memory
    packet = Packet([bytes(20000)])
    carrier.encode(stream, packet)
    size = sum(map(len, packet.blocks))
    assert b"".join(stream.take_output()) == reference(where=0x103, size=size)


def test_a_reader_that_cannot_have_it_gets_it_through_the_socket() -> None:
    carrier, stream = joined([])
    memory = SimulatedMemory([])
    memory.lend = lambda payload: -1  # type: ignore[method-assign]
    carrier._memory = memory
    carrier.encode(stream, Packet([bytes(20000)]))
    assert b"".join(stream.take_output()) == b"".join(framing.encode(Packet([bytes(20000)])))


def test_without_room_the_payload_goes_through_the_socket() -> None:
    carrier, stream = joined([])
    memory = SimulatedMemory([])
    memory.place = lambda blocks, size: None  # type: ignore[method-assign,assignment,return-value]
    carrier._memory = memory
    packet = Packet([bytes(20000)])
    carrier.encode(stream, packet)
    assert b"".join(stream.take_output()) == b"".join(framing.encode(Packet([bytes(20000)])))


def test_who_sees_nothing_goes_on_as_tcp() -> None:
    """Where nobody asked for memory, it is not worth a word."""

    spec = replace(parse_carrier("memory"), chosen=True)
    end = End()
    carrier = Memory(Route("/out", "/in", spec))
    end.begin(carrier.greet(end.stream))
    end.feed(framing.number(0))
    assert end.done
    assert type(end.stream) is ByteStream
    assert carrier.route.carrier == "tcp"
    carrier.encode(end.stream, Packet([bytes(20000)]))
    assert b"".join(end.stream.take_output()) == b"".join(framing.encode(Packet([bytes(20000)])))


def test_who_asked_for_memory_is_told() -> None:
    end = End()
    carrier = Memory(Route("/out", "/in", "memory"))
    end.begin(carrier.greet(end.stream))
    end.take()
    end.feed(framing.number(0))
    assert end.take() == framing.QUIT  # the other side has a connection by now
    with pytest.raises(LocalProtocolError, match="use tcp"):
        end.feed(framing.ACK)


def test_a_receiver_that_sees_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    def grant(end: End, effect: object) -> None:
        return None

    monkeypatch.setattr(End, "_grant", grant)
    end = End()
    carrier = Memory(Route("", "/in", "memory", 21605))
    end.begin(carrier.welcome(end.stream, b"YARPYME1"))
    end.feed(b"\x0c\0\0\0/out (key 1)"[:4] + b"/out (k v)\0\0" + bytes(8))
    assert end.take() == framing.number(0)
    other = end.result
    assert isinstance(other, Tcp)
    end.begin(other.welcome(end.stream, b"YARPYME1"))
    assert end.done
    assert (other.route.source, other.route.carrier) == ("/out", "tcp+k.v")


def test_a_later_release_that_dials_goes_on_over_tcp() -> None:
    end = End()
    end.begin(Memory(Route("", "/in", "memory")).welcome(end.stream, b"YARPYME2"))
    end.feed(b"\x05\0\0\0/out\0" + bytes(8))
    assert end.take() == framing.number(65536 + ord("1"))
    assert isinstance(end.result, Tcp)
    assert end.opened == []


def test_a_later_release_that_answers_goes_on_over_tcp() -> None:
    answer = framing.number(65536 + ord("2"))
    end, route = End(), Route("/out", "/in", "memory")
    route.spec = replace(route.spec, chosen=True)
    end.begin(Memory(route).greet(end.stream))
    end.feed(answer)
    assert (end.done, route.spec.base) == (True, "tcp")
    end = End()
    end.begin(Memory(Route("/out", "/in", "memory")).greet(end.stream))
    end.feed(answer)
    with pytest.raises(LocalProtocolError, match=r"version 2 .* this one 1: .* use tcp"):
        end.feed(framing.ACK)


def test_a_peer_that_answers_something_else() -> None:
    end = End()
    end.begin(Memory(Route("/out", "/in", "memory")).greet(end.stream))
    with pytest.raises(RemoteProtocolError, match="expected a number"):
        end.feed(b"Yarp 3.8")


BAD = {
    "mark": reference(b"\0XXX"),
    "command": reference(key=b"q"),
    "envelope": reference(length=1 << 31),
    "slot": reference(slot=7),
    "memory": reference(where=1),
    "place": reference(offset=19999, size=2),
    "far": reference(offset=(1 << 64) - 1),
    "size": reference(size=1 << 63),
}


@pytest.mark.parametrize("piece", [1, 100])
@pytest.mark.parametrize("data", BAD.values(), ids=BAD.keys())
def test_bad_references(data: bytes, piece: int) -> None:
    stream = SharedStream(SimulatedMemory([bytes(20000)]))
    pieces = [data[at : at + piece] for at in range(0, len(data), piece)]
    with pytest.raises(RemoteProtocolError):
        run(Memory(Route("/a", "/b")).decode(stream), stream, pieces)


def test_a_reference_on_a_connection_without_memory() -> None:
    stream = ByteStream()
    with pytest.raises(RemoteProtocolError, match="not shared"):
        run(Memory(Route("/a", "/b")).decode(stream), stream, [reference()])


def test_the_limit_of_a_port_holds_for_what_lies_in_memory() -> None:
    stream = SharedStream(SimulatedMemory([bytes(20000)]), limit=10000)
    with pytest.raises(RemoteProtocolError, match="the limit is 10000"):
        run(Memory(Route("/a", "/b")).decode(stream), stream, [reference()])


def test_payloads_are_counted_where_they_come() -> None:
    talk = Dialogue(Memory)
    talk.greet()
    message = talk.send([bytes(20000)])
    assert talk.acceptor.stream.came_aside == len(message.payload)
    assert len(said(talk.traffic, "initiator")) < 1000
