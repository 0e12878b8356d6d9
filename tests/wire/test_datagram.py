"""Messages cut into datagrams: golden bytes, losses counted, nothing believed before it came."""

from __future__ import annotations

import struct
from zlib import crc32

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.capture import load_capture
from support.steps import measured

from yarpy.wire import framing
from yarpy.wire.datagram import MAX_DATAGRAM, Assembler, announced, split
from yarpy.wire.message import Packet


def golden(name: str) -> list[bytes]:
    """The datagrams of a capture that carry messages and were recorded whole."""
    steps = load_capture(name).steps
    return [s.data for s in steps if s.transport == "udp datagram" and s.sender == "a"]


class AsOneBlock:
    """A payload that was encoded already."""

    def __init__(self, data: bytes) -> None:
        self.data = data

    def to_wire(self) -> tuple[bytes]:
        return (self.data,)


GOLDEN = [
    # capture, what was sent, its envelope, how many datagrams
    ("conn_udp_stream", 0, [], b"", MAX_DATAGRAM),
    ("conn_udp_stream", 1, [1, "ping", 3.14], b"", MAX_DATAGRAM),
    ("conn_udp_stream_envelope", 0, [], b"1 0.25", MAX_DATAGRAM),
    ("conn_udp_stream_envelope", 1, [1, "ping", 3.14], b"2 1.25", MAX_DATAGRAM),
    ("conn_udp_fragmented", 0, [1, b"x" * 2500], b"1 0.5", 1000),
    ("conn_udp_fragmented", 3, [2], b"1 0.5", 1000),
    ("conn_mcast_stream_envelope", 1, [1, "ping", 3.14], b"2 1.25", MAX_DATAGRAM),
]


@pytest.mark.parametrize(("name", "first", "value", "envelope", "size"), GOLDEN)
def test_golden_datagrams(name: str, first: int, value: object, envelope: bytes, size: int) -> None:
    sent = list(split(framing.encode(Packet(value, envelope)), size))
    recorded = golden(name)[first : first + len(sent)]
    assert sent == recorded
    assembler = Assembler(1 << 20)
    results = [assembler.add(datagram) for datagram in recorded]
    assert results[:-1] == [None] * (len(results) - 1)
    assert results[-1] == b"".join(framing.encode(Packet(value, envelope)))
    assert assembler.lost == 0


def test_long_message_is_cut_where_cpp_cuts_it() -> None:
    """(1 {100000 x}) is 65499 and 34579 bytes; the capture kept the first 2048 of each.

    Our own encoding gives the blob a block of its own, so that it needs no copy: another four bytes
    of index, which no reader minds. Here it is one block, as C++ has it.
    """
    recorded = [s for s in load_capture("conn_udp_stream").steps if s.whole]
    packet = Packet([1, b"x" * 100_000])
    sent = list(split(framing.encode(Packet(AsOneBlock(b"".join(packet.blocks))))))
    assert [len(datagram) for datagram in sent] == [step.whole for step in recorded]
    for datagram, step in zip(sent, recorded, strict=True):
        assert datagram.startswith(step.data)


def test_wake_up_of_a_closing_receiver_is_ignored() -> None:
    wake = load_capture("conn_udp_stream").steps[-1].data
    assert wake == struct.pack("<Ii", crc32(bytes(10)), -1) + bytes(10)
    assembler = Assembler(1000)
    assert assembler.add(wake) is None
    assert assembler.lost == 0


# ---------------------------------------------------------------------------------- losses


def pieces() -> list[bytes]:
    return list(split(framing.encode(Packet([b"x" * 3000])), 1000))


def message() -> bytes:
    return b"".join(framing.encode(Packet([b"x" * 3000])))


@pytest.mark.parametrize(
    ("order", "whole", "lost"),
    [
        ([0, 1, 2, 3], 1, 0),
        ([0, 1, 2, 3] * 3, 3, 0),
        ([0, 2, 3, 0, 1, 2, 3], 1, 1),  # one missing
        ([0, 2, 1, 3, 0, 1, 2, 3], 1, 1),  # out of order
        ([0, 0, 1, 2, 3], 1, 1),  # begun anew
        ([1, 2, 3, 0, 1, 2, 3], 1, 0),  # we came late: not ours to count
        ([0, 1, 2], 0, 0),  # still coming
        ([0, 1, 2, 0, 1, 2, 3], 1, 1),  # the end was lost
        ([0, 1, 2, 3, 1, 2, 3, 0, 1, 2, 3], 2, 1),  # the beginning was lost
        ([0, 1, 2, 3, 2, 3, 2, 3], 1, 2),  # ... twice
        ([0, 1, 2, 1, 2, 3], 0, 2),  # the end of one, and the beginning of the next
        ([0, 2, 3, 1, 2, 3, 0, 1, 2, 3], 1, 2),  # a piece of one, and the beginning of the next
    ],
)
def test_losses_are_counted_by_message(order: list[int], whole: int, lost: int) -> None:
    assembler = Assembler(1 << 20)
    results = [assembler.add(pieces()[number]) for number in order]
    assert [r for r in results if r is not None] == [message()] * whole
    assert assembler.lost == lost


@pytest.mark.parametrize("damage", range(0, 1000, 37))
def test_damaged_datagram_drops_its_message(damage: int) -> None:
    parts = pieces()
    bad = bytearray(parts[1])
    bad[damage] ^= 0x10
    assembler = Assembler(1 << 20)
    results = [assembler.add(d) for d in (parts[0], bytes(bad), parts[2], parts[3], *parts)]
    assert [r for r in results if r is not None] == [message()]
    assert assembler.lost == 1


def test_message_beyond_the_limit_is_dropped_and_the_next_one_comes() -> None:
    assembler = Assembler(2000)
    for datagram in pieces():
        assert assembler.add(datagram) is None
    assert assembler.lost == 1
    small = list(split(framing.encode(Packet([1]))))
    assert assembler.add(small[0]) is not None


def wrapped(piece: bytes, sequence: int) -> bytes:
    return struct.pack("<Ii", crc32(piece), sequence) + piece


@pytest.mark.parametrize("piece", [b"", b"x"])
def test_tiny_pieces_do_not_pile_up(piece: bytes) -> None:
    assembler = Assembler(1 << 30)
    head = framing.INDEX + b"\x02\x01" + b"\xff" * 8 + struct.pack("<3i", 8, 1 << 29, 0)
    assembler.add(wrapped(head, 0))
    with measured() as peak:
        for sequence in range(1, 20_000):
            assert assembler.add(wrapped(piece, sequence)) is None
    assert peak.bytes < 50_000


def test_announced_length_takes_no_memory() -> None:
    head = framing.INDEX + b"\x02\x01" + b"\xff" * 8 + struct.pack("<3i", 8, 1 << 29, 0)
    assert announced(head) == len(head) + 8 + (1 << 29)
    datagram = struct.pack("<Ii", crc32(head), 0) + head
    assembler = Assembler(1 << 30)
    with measured() as peak:
        assert assembler.add(datagram) is None
    assert peak.bytes < 5000


@pytest.mark.parametrize("size", [0, 1, 7, 8])
def test_stump_of_a_datagram_is_a_loss_not_an_error(size: int) -> None:
    assembler = Assembler(1000)
    assert assembler.add(bytes(size)) in (None, b"")
    assert assembler.lost == (size < 8)


@given(st.lists(st.binary(max_size=60), max_size=8))
def test_any_bytes_are_harmless(datagrams: list[bytes]) -> None:
    assembler = Assembler(1000)
    for datagram in datagrams:
        assembler.add(datagram)
        signed = struct.pack("<I", crc32(datagram[4:])) + datagram
        assembler.add(signed)


@given(st.binary(min_size=26, max_size=60), st.integers(0, 3))
def test_any_index_is_harmless(data: bytes, sequence: int) -> None:
    piece = framing.INDEX + data
    assembler = Assembler(1000)
    whole = assembler.add(struct.pack("<Ii", crc32(piece), sequence) + piece)
    assert whole in (None, piece)
