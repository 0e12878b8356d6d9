"""udp: the greeting over TCP, messages as datagrams, losses counted by message."""

from __future__ import annotations

from struct import pack
from zlib import crc32

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.capture import load_capture
from support.steps import chop

from yarpy.carriers.own.udp import Udp, parse_whole
from yarpy.errors import RemoteProtocolError
from yarpy.route import Route
from yarpy.testing import CarrierConformance, Dialogue, End
from yarpy.testing.drive import UDP_PORT
from yarpy.wire import framing
from yarpy.wire.effects import BE_CALLED, SEND_DATAGRAMS, May
from yarpy.wire.message import Message, Packet
from yarpy.wire.stream import ByteStream, DatagramStream


class TestUdp(CarrierConformance):
    carrier = Udp


def test_golden_greeting_of_the_initiator() -> None:
    capture = load_capture("conn_udp_stream")
    end = End()
    end.begin(Udp(Route("/cap/out", "/cap/in", "udp")).greet(end.stream))
    assert end.take() == capture.steps[0].data
    end.feed(capture.steps[1].data)
    assert end.done
    assert end.opened[0].port == framing.parse_number(capture.steps[1].data)
    assert isinstance(end.stream, DatagramStream)


@pytest.mark.parametrize("piece", [0, 1])
def test_golden_greeting_is_welcomed_with_a_port_number(piece: int) -> None:
    data = load_capture("conn_udp_stream").steps[0].data
    end = End()
    carrier = Udp(Route("", "/cap/in", "udp"))
    end.begin(carrier.welcome(end.stream, data[:8]))
    for part in chop(data[8:], piece):
        end.feed(part)
    assert end.done
    assert end.take() == framing.number(UDP_PORT)
    assert carrier.route.source == "/cap/out"
    assert end.opened[0].listen


@pytest.mark.parametrize("answer", [framing.number(0), framing.number(65536), b"nonsense"])
def test_port_number_that_cannot_be_is_refused(answer: bytes) -> None:
    end = End()
    end.begin(Udp(Route("/a", "/b", "udp")).greet(end.stream))
    with pytest.raises(RemoteProtocolError, match="UDP port"):
        end.feed(answer)


def datagrams(value: object) -> list[bytes]:
    talk = Dialogue(Udp)
    talk.greet()
    talk.initiating.encode(talk.initiator.stream, Packet(value))
    talk.initiator.collect()
    return list(talk.initiator.outbox)


def receive(pieces: list[bytes], limit: int = 1 << 20) -> tuple[list[object], int]:
    """What a receiver makes of datagrams, and how many messages it counts as lost."""
    messages, lost = received(pieces, limit)
    return [message.value for message in messages], lost


def received(pieces: list[bytes], limit: int = 1 << 20) -> tuple[list[Message], int]:
    stream, carrier = DatagramStream(limit), Udp(Route("/a", "/b", "udp"))
    for piece in pieces:
        stream.feed(piece)
    messages: list[Message] = []
    while True:
        steps = carrier.decode(stream)
        try:
            next(steps)
        except StopIteration as stop:
            messages.append(stop.value)
            continue
        return messages, carrier.lost


def test_messages_keep_their_datagrams_apart() -> None:
    small, large = datagrams([1]), datagrams([b"x" * 150_000])
    assert (len(small), len(large)) == (1, 3)
    values, lost = receive([*small, *large, *small])
    assert values == [[1], [b"x" * 150_000], [1]]
    assert lost == 0


def test_every_kind_of_loss_is_counted_and_survived() -> None:
    large, small = datagrams([b"x" * 150_000]), datagrams([1])
    bad = bytearray(small[0])
    bad[20] ^= 1
    assert receive([large[0], large[2], *small]) == ([[1]], 1)
    assert receive([bytes(bad), *small]) == ([[1]], 1)
    assert receive([b"tiny", *small]) == ([[1]], 1)
    assert receive([*large, *small], limit=10_000) == ([[1]], 1)


def wrapped(data: bytes) -> bytes:
    return pack("<Ii", crc32(data), 0) + data


def test_whole_datagram_without_a_message_in_it_is_a_loss() -> None:
    whole = datagrams([1])[0][8:]
    broken_list = whole[:18] + pack("<3i", 8, 7, 0) + whole[30:38] + b"\x00\x01\0\0\xff\xff\xff\xff"
    for data in (
        *(b"", b"nonsense", whole[:-1], whole[:20], framing.INDEX + b"\x02\x01" + bytes(30)),
        broken_list,
    ):
        assert receive([wrapped(data), wrapped(whole)]) == ([[1]], 1), data


@pytest.mark.parametrize("key", ["q", "r", "a", "/elsewhere", "~", "!", "i"])
def test_nobody_commands_by_datagrams(key: str) -> None:
    """Anybody can send one: a goodbye would end somebody else's connection."""
    small = datagrams([1])
    command = b"".join(map(bytes, framing.encode_text_command(key[0], key[1:].encode())))
    assert receive([wrapped(command), *small]) == ([[1]], 1)
    question = b"".join(map(bytes, framing.encode(Packet(["list"], key="a"))))
    assert receive([wrapped(question), *small]) == ([[1]], 1)


@given(st.integers(0, 3), st.lists(st.tuples(st.integers(0, 79), st.integers(0, 255)), max_size=6))
def test_any_forged_message_is_survived(which: int, changes: list[tuple[int, int]]) -> None:
    value: object = ([], [1, "ping", 3.5], [[1, [2]], "a"], [b"x" * 50])[which]
    data = bytearray(b"".join(map(bytes, framing.encode(Packet(value, b"1 2.5")))))
    for place, byte in changes:
        data[place % len(data)] = byte
    messages, _ = received([wrapped(bytes(data)), *datagrams([7])])
    assert messages[-1].value == [7]


def test_loss_is_known_as_soon_as_it_happened() -> None:
    """Not only with the next datagram: whoever looks at the counters sees it."""
    stream, carrier = DatagramStream(), Udp(Route("/a", "/b", "udp"))
    steps = carrier.decode(stream)
    next(steps)
    data = b"nonsense"
    stream.feed(pack("<Ii", crc32(data), 0) + data)
    next(steps)
    assert carrier.lost == 1


def test_odd_but_whole_messages_are_read() -> None:
    five = b"\x01\x01\0\0\x01\0\0\0\x05\0\0\0"
    command = b"\0\0\0\0~D\0\1"
    index = framing.INDEX + b"\x01\x00" + bytes(8) + b"\x14\0\0\0"
    message = parse_whole(index + command + five, 1000)
    assert message is not None
    assert message.value == [5]
    assert parse_whole(b"", 1000) is None


def test_nothing_says_goodbye() -> None:
    talk = Dialogue(Udp)
    talk.greet()
    assert talk.quit() is None
    assert not Udp.replies
    assert Udp.delivery.connectionless


def test_a_port_without_a_place_says_so_before_the_number() -> None:
    stream = ByteStream()
    stream.feed(framing.encode_name("/out"))
    steps = Udp(Route("", "/in", "udp")).welcome(stream, framing.number(framing.BASE))
    assert next(steps) == May("write")
    assert steps.send("") == May(BE_CALLED, name="/out")
    assert steps.send("") == May(SEND_DATAGRAMS)
    with pytest.raises(RemoteProtocolError, match="full"):
        steps.send("it is full")
    assert b"".join(stream.take_output()) == b"* it is full\r\n"
