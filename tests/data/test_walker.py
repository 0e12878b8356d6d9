import struct
import time

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.message import bottles, walk
from support.table import for_each
from support.vectors import binaries, rows

from yarpy.data.walker import Walker
from yarpy.errors import DecodeError


def packed(*words):
    return struct.pack(f"<{len(words)}i", *words)


@for_each(binaries())
def test_finds_the_end(message):
    for step in (1, 3, 7, len(message)):
        assert walk(message, step) == len(message)
    walker = Walker()
    assert walker.advance(message + b"next") == len(message)
    assert walker.done
    assert walker.advance(message + b"next message") == len(message)


@for_each(binaries())
def test_never_asks_for_bytes_of_the_next_message(message):
    walker = Walker()
    have = 0
    for _ in range(len(message) + 1):
        need = walker.advance(message[:have])
        if walker.done:
            break
        assert have < need <= len(message)
        have = need
    assert walker.done and have == len(message)


def test_knows_a_sound():
    (row,) = (row for row in rows("types") if row["type"] == "sound")
    message = bytes.fromhex(row["binary"])
    for step in (1, 5, len(message)):
        assert walk(message, step) == len(message)
    assert walk(message + b"more", 8) == len(message)
    with pytest.raises(DecodeError):
        Walker().advance(packed(256, 4, 0, 2, 1, 2, 7, 2, 1, 8000))
    with pytest.raises(DecodeError):
        Walker().advance(packed(256, 4, 0, -2, 1, 2, 1, 2, 1, 8000))
    with pytest.raises(DecodeError):
        Walker(1000).advance(packed(256, 4, 0, 2000, 1, 2, 1, 2, 1, 8000))


@pytest.mark.parametrize(
    "head",
    [
        packed(256, 1 << 20),
        packed(257, 1 << 20),
        packed(260, 1 << 20),
        packed(256, 1, 4, 1 << 20),
        packed(268, 1, 1 << 20),
        packed(256, 1, 256, 1 << 20),
        packed(256, 2, 257, 1000, 0),
    ],
    ids=lambda head: head.hex(),
)
def test_limit(head):
    with pytest.raises(DecodeError, match="limit"):
        Walker(limit=4000).advance(head + bytes(40))


def test_limit_of_a_message_that_grows():
    walker = Walker(limit=100)
    message = packed(256, 10) + (packed(4, 20) + bytes(20)) * 10
    with pytest.raises(DecodeError, match="limit"):
        for size in range(len(message)):
            walker.advance(message[:size])
    assert walk(packed(256, 2) + packed(4, 20) + bytes(20) + packed(1, 1)) == 44


@pytest.mark.parametrize(
    "message",
    [packed(256, 1, 77), packed(999, 1), packed(256, -1), packed(256, 1, 4, -1), packed(258, 1)],
    ids=lambda message: message.hex(),
)
def test_refuses_at_once(message):
    with pytest.raises(DecodeError):
        Walker().advance(message)


def test_is_not_quadratic():
    message = packed(260, 50_000) + (packed(3) + b"abc") * 50_000
    view = memoryview(message)
    walker = Walker()
    begin = time.process_time()
    for size in range(0, len(message), 7):
        walker.advance(view[:size])
    assert time.process_time() - begin < 2
    assert walker.advance(view) == len(message)


@settings(max_examples=50)
@given(bottles, st.integers(1, 40))
def test_any_message_in_any_pieces(bottle, step):
    message = bottle.to_bytes()
    assert walk(message, step) == len(message)
    assert walk(message + b"\1\2\3", step) == len(message)
