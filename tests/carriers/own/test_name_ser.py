"""name_ser: lines for name servers, with what is swallowed before each."""

from __future__ import annotations

from typing import Any, ClassVar

import pytest
from support.capture import load_capture
from support.steps import chop

from yarpy.carriers.own.name_ser import NameSer
from yarpy.data.value import Vocab
from yarpy.errors import RemoteProtocolError
from yarpy.route import Route
from yarpy.testing import CarrierConformance
from yarpy.wire.message import Lines, Packet
from yarpy.wire.stream import ByteStream, run


class TestNameSer(CarrierConformance):
    """No names, no envelopes; quotes are stripped by the sender, so only words survive."""

    carrier = NameSer
    names_sender = False
    carries_envelopes = False
    values: ClassVar[Any] = (
        [],
        [1],
        [-1, 2**40, 1.5],
        ["text", "words", "\u00fc\u4f60"],
        [Vocab("set"), [], [1, ["deep", [2.5]]]],
        {"key": 1, "other": ["x"]},
        7,
        2.5,
    )
    sizes = (1, 100, 16384, 65535, 65536, 65537, 300_000)


def read(data: bytes, piece: int = 0) -> list[bytes]:
    """The lines that an acceptor reads from a whole connection."""
    carrier, stream = NameSer(Route("", "/root", "name_ser")), ByteStream()
    feeds = iter(chop(data[8:], piece))
    found = []
    assert NameSer.recognises(data[:8]) == 8
    run(carrier.welcome(stream, data[:8]), stream)
    stream = ByteStream()
    while True:
        steps = carrier.decode(stream)
        while True:
            try:
                next(steps)
            except StopIteration as stop:
                found.append(bytes(stop.value.payload))
                break
            except ConnectionError:
                return found
            part = next(feeds, None)
            stream.feed_eof() if part is None else stream.feed(part)


LINES = [
    (b"NAME_SERVER query /a\n", [b"query /a"]),
    (b"NAME_SERVER query /a\r\nNAME_SERVER list\r\n", [b"query /a", b"list"]),
    (b"NAME_SERVER query /a\nXXXXXXXXXXXXquery /b\n", [b"query /a", b"query /b"]),
    (b"NAME_SERVER \r\n", [b""]),
    (b"NAME_SERNOT  a b\n", [b" a b"]),
]


@pytest.mark.parametrize("piece", [0, 1])
@pytest.mark.parametrize(("data", "lines"), LINES)
def test_what_is_swallowed(data: bytes, lines: list[bytes], piece: int) -> None:
    assert read(data, piece) == lines


def test_golden_stream() -> None:
    capture = load_capture("conn_name_ser_stream")
    carrier, stream = NameSer(Route("/cap/out", "/cap/in", "name_ser")), ByteStream()
    run(carrier.greet(stream), stream)
    for value in ([], [1, "ping", 3.14], [["a", [1, 2]], [1.5, "x y"], Vocab("set")]):
        carrier.encode(stream, Packet(value))
    carrier.encode_quit(stream)
    assert b"".join(stream.take_output()) == capture.steps[0].data
    assert len(read(capture.steps[0].data, 1)) == 3


def test_reply_is_a_line_or_lines() -> None:
    carrier, stream = NameSer(Route("", "/root", "name_ser")), ByteStream()
    carrier.encode_reply(stream, [Vocab("ok"), "echo"])
    carrier.encode_reply(stream, Lines(["registration name /a", "*** end of message"]))
    carrier.encode_ack(stream, 1)
    assert b"".join(stream.take_output()) == (
        b"[ok] echo\r\nregistration name /a\r\n*** end of message\r\n"
    )
    reply = run(carrier.expect_reply(stream), stream, [b"[ok] (1 2)\r\n"])
    assert reply is not None
    assert reply.value == [Vocab("ok"), [1, 2]]


def test_line_is_limited() -> None:
    carrier, stream = NameSer(Route("", "/root", "name_ser")), ByteStream()
    with pytest.raises(RemoteProtocolError):
        run(carrier.decode(stream), stream, [b"VER ", *[b"x" * 60_000] * 20])
