"""ZMTP: bytes as libzmq 4.3.5 wrote them, whole and one at a time, and bytes that nobody writes."""

from __future__ import annotations

import pytest
from support.steps import chop

from yarpy.errors import AccessRefused, LinkClosed, RemoteProtocolError
from yarpy.peers.zmq import zmtp
from yarpy.wire.stream import ByteStream, run

GREETING = bytes.fromhex("ff00000000000000017f03014e554c4c") + bytes(48)
READY = bytes.fromhex("04190552454144590b536f636b65742d5479706500000003535542")
DEALER = bytes.fromhex(
    "042b0552454144590b536f636b65742d54797065000000064445414c4552084964656e74697479000000026d65"
)
#: frames of a message of three, of which the last is long
THREE = bytes.fromhex("010161010002000000000000012c") + b"x" * 300


def test_our_greeting_is_that_of_libzmq() -> None:
    assert zmtp.GREETING == GREETING
    assert zmtp.GREETING.startswith(zmtp.MAGIC)
    assert zmtp.ready({"Socket-Type": b"SUB"}) == READY
    assert zmtp.ready({"Socket-Type": b"DEALER", "Identity": b"me"}) == DEALER


@pytest.mark.parametrize("size", [1, 7, 1000])
def test_a_greeting_is_read(size: int) -> None:
    for data, minor in ((GREETING, 1), (GREETING[:11] + b"\0" + GREETING[12:], 0)):
        stream = ByteStream()
        assert run(zmtp.read_greeting(stream), stream, chop(data, size)) == minor


@pytest.mark.parametrize("size", [1, 7, 1000])
def test_properties_are_read(size: int) -> None:
    stream = ByteStream()
    found = run(zmtp.read_ready(stream), stream, chop(DEALER, size))
    assert found == {"socket-type": b"DEALER", "identity": b"me"}


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b"\xff" + bytes(8) + b"\x7e" + bytes(54), "does not speak ZMTP"),
        (GREETING[:10] + b"\1" + GREETING[11:], "before 3"),
        (GREETING[:12] + b"CURVE".ljust(20, b"\0") + bytes(32), "mechanism CURVE"),
        (GREETING[:12] + b"PLAIN".ljust(20, b"\0") + bytes(32), "mechanism PLAIN"),
    ],
)
def test_other_greetings_are_refused(data: bytes, why: str) -> None:
    stream = ByteStream()
    with pytest.raises(RemoteProtocolError, match=why):
        run(zmtp.read_greeting(stream), stream, [data])


@pytest.mark.parametrize("size", [1, 7, 1000])
def test_frames_are_read_and_written(size: int) -> None:
    stream = ByteStream()
    found = [run(zmtp.read_frame(stream, 1000), stream, chop(THREE[:3], size))]
    assert found == [(zmtp.MORE, b"a")]
    frames = [b"a", b"", b"x" * 300]
    assert b"".join(map(bytes, zmtp.encode(frames))) == THREE
    stream = ByteStream()
    whole: list[zmtp.Frame] = []
    for part in chop(THREE, size):
        stream.feed(part)
        while (one := zmtp.parse_frame(stream, 1000)) is not None:
            whole.append(one)
    assert whole == [(1, b"a"), (1, b""), (2, b"x" * 300)]


def test_a_large_body_is_not_copied() -> None:
    body = bytes(1 << 20)
    pieces = zmtp.encode([b"topic", body])
    assert pieces[0] == b"\1\5topic\2" + (1 << 20).to_bytes(8, "big")
    assert pieces[1] is body


def test_a_message_is_taken_only_when_it_is_whole() -> None:
    stream = ByteStream()
    for place, byte in enumerate(b"\1\1a\0\2bc"):
        assert zmtp.parse_message(stream) is None, place
        stream.feed(bytes([byte]))
    assert zmtp.parse_message(stream) == [b"a", b"bc"]
    assert not stream.waiting


@pytest.mark.parametrize("data", [b"\4\6\5READY", THREE, b"\1\0" * 70 + b"\0\0"])
def test_the_short_cut_leaves_the_rest_alone(data: bytes) -> None:
    stream = ByteStream()
    stream.feed(data)
    assert zmtp.parse_message(stream) is None
    assert stream.waiting == len(data)


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b"\x08\0", "flags 0x08"),
        (b"\5\1x", "flags 0x05"),
        (b"\0\xff" + bytes(255), "255 bytes"),
        (b"\2" + b"\xff" * 8, "18446744073709551615 bytes"),
        (b"\6" + (1 << 14).to_bytes(8, "big"), "16384 bytes"),
    ],
)
def test_frames_that_nobody_writes_are_refused(data: bytes, why: str) -> None:
    stream = ByteStream()
    with pytest.raises(RemoteProtocolError, match=why):
        run(zmtp.read_frame(stream, 100), stream, [data])
    stream = ByteStream()
    stream.feed(data)
    with pytest.raises(RemoteProtocolError, match=why):
        zmtp.parse_frame(stream, 100)


def test_commands_are_read_and_written() -> None:
    assert zmtp.parse_command(b"\4PING\0\0") == (b"PING", b"\0\0")
    assert zmtp.command(b"SUBSCRIBE", b"cam").hex() == "040d0953554253435249424563616d"
    assert zmtp.echo(b"\0\7context") == b"context"
    assert zmtp.echo(b"\0\7" + b"c" * 90) == b"c" * 16
    for body in (b"", b"\0", b"\4PIN", b"\xff"):
        with pytest.raises(RemoteProtocolError, match="without a name"):
            zmtp.parse_command(body)


def test_a_refusal_arrives() -> None:
    for why, kind in (("out of order", RemoteProtocolError), ("Access refused: x", AccessRefused)):
        stream = ByteStream()
        with pytest.raises(kind, match=why):
            run(zmtp.read_ready(stream), stream, [zmtp.error(why)])
    assert len(zmtp.error("x" * 5000)) < 300


@pytest.mark.parametrize(
    "data", [b"\0\1x", b"\4\5\4PING", b"\4\0", zmtp.command(b"READY", b"\5ab")]
)
def test_other_beginnings_are_refused(data: bytes) -> None:
    stream = ByteStream()
    with pytest.raises(RemoteProtocolError):
        run(zmtp.read_ready(stream), stream, [data])


def test_an_end_is_noticed_anywhere() -> None:
    for size in range(len(READY)):
        stream = ByteStream()
        with pytest.raises(LinkClosed):
            run(zmtp.read_ready(stream), stream, [READY[:size]])
