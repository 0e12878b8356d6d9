"""frame_stream: what wsproto says and hears, cut anywhere; peers that break the rules."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.steps import chop
from wsproto import ConnectionType
from wsproto.connection import Connection
from wsproto.events import BytesMessage, CloseConnection, Ping

from yarpy.errors import LinkClosed, RemoteProtocolError
from yarpy.wire.frame_stream import BINARY, FrameStream, frame
from yarpy.wire.stream import ByteStream, run


@given(st.lists(st.binary(max_size=300), max_size=5), st.booleans(), st.integers(1, 400))
def test_what_wsproto_says_is_read(said: list[bytes], masks: bool, piece: int) -> None:
    peer = Connection(ConnectionType.SERVER if masks else ConnectionType.CLIENT)
    stream = FrameStream(ByteStream(), masks)
    data = b"".join(peer.send(BytesMessage(data=item)) for item in said)
    wanted = b"".join(said)
    assert run(stream.read_exact(len(wanted)), stream, chop(data, piece)) == wanted
    assert stream.take_output() == []


@pytest.mark.parametrize("masks", [False, True])
@pytest.mark.parametrize("size", [0, 125, 126, 1 << 12, 65535, 65536, 200_000])
def test_wsproto_reads_what_is_written(size: int, masks: bool) -> None:
    peer = Connection(ConnectionType.SERVER if masks else ConnectionType.CLIENT)
    stream = FrameStream(ByteStream(), masks)
    payload = bytes(range(250)) * (size // 250) + bytes(size % 250)
    stream.write(payload[:1], payload[1:])
    peer.receive_data(b"".join(map(bytes, stream.take_output())))
    event, *more = peer.events()
    assert isinstance(event, BytesMessage)
    assert (bytes(event.data), event.message_finished, more) == (payload, True, [])


def test_a_large_message_lands_in_memory_of_its_own() -> None:
    stream = FrameStream(ByteStream(), masks=True)
    payload = bytes(range(256)) * 4096
    data = b"".join(map(bytes, frame(BINARY, False, payload)))
    assert run(stream.read_exact(len(payload)), stream, [data]) == payload


def test_what_came_behind_the_greeting_is_kept() -> None:
    below = ByteStream()
    below.feed(b"\x82\x03abc\x82")
    stream = FrameStream(below, masks=True)
    assert (below.waiting, stream.waiting) == (0, 3)
    assert run(stream.read_exact(5), stream, [b"\x02de"]) == b"abcde"


def test_a_message_comes_in_frames_with_pings_between_them() -> None:
    stream = FrameStream(ByteStream(), masks=True)
    said = b"\x02\x01a\x89\x02hi\x00\x01b\x8a\x00\x80\x01c"
    assert run(stream.read_exact(3), stream, [said]) == b"abc"
    assert stream.take_output() == [b"\x8a\x82\0\0\0\0hi"]


def test_a_close_is_answered_and_is_the_end() -> None:
    peer = Connection(ConnectionType.CLIENT)
    stream = FrameStream(ByteStream(), masks=False)
    stream.feed(peer.send(Ping(b"x")) + peer.send(CloseConnection(1000, "bye")))
    with pytest.raises(LinkClosed, match="closed the connection"):
        run(stream.read_exact(1), stream)
    assert b"".join(map(bytes, stream.take_output())) == b"\x8a\x01x\x88\x02\x03\xe8"


@pytest.mark.parametrize(
    ("said", "why", "answer"),
    [
        (b"\x81\x01a", "with text", b"\x88\x82\0\0\0\0\x03\xeb"),
        (b"\x00\x01a", "mixed", b"\x88\x82\0\0\0\0\x03\xea"),
        (b"\x02\x01a\x82\x01b", "mixed", b"\x88\x82\0\0\0\0\x03\xea"),
        (b"\xf2\x01a", "broken WebSocket frame", b"\x88\x82\0\0\0\0\x03\xea"),
        (b"\x82\x81aaaaa", "broken WebSocket frame", b"\x88\x82\0\0\0\0\x03\xea"),
    ],
)
def test_who_breaks_the_rules_is_told(said: bytes, why: str, answer: bytes) -> None:
    stream = FrameStream(ByteStream(), masks=True)
    with pytest.raises(RemoteProtocolError, match=why):
        run(stream.read_exact(2), stream, [said])
    assert stream.take_output() == [answer]
