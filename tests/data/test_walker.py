import struct
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.message import bottles, walk
from support.table import for_each
from support.vectors import binaries, rows

from yarpy.data.sig.pointcloud import KINDS, PointCloud
from yarpy.data.walker import Walker
from yarpy.errors import DecodeError
from yarpy.wire import framing


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
    [
        packed(256, 1, 77),
        packed(999, 1, 7),
        packed(256, -1),
        packed(256, 1, 4, -1),
        packed(258, 1, 0),
    ],
    ids=lambda message: message.hex(),
)
def test_refuses_at_once(message):
    with pytest.raises(DecodeError):
        Walker().advance(message)


def cloud(width, height, kind="xyz"):
    fields = len(KINDS[kind].dtype.names)
    numbers = np.arange(width * height * fields) % 100
    return b"".join(PointCloud(numbers.reshape(height, width, fields), kind).to_wire())


# Widths that no list has as its code, and those that one has: of numbers, and of anything.
@pytest.mark.parametrize("width", [1, 2, 3, 4, 10, 255, 256, 257, 260, 266, 320, 384, 640])
@pytest.mark.parametrize("height", [1, 2, 4])
@pytest.mark.parametrize("kind", ["xy", "xyz", "xyz_i", "interest", "normal"])
def test_clouds_of_points(width, height, kind):
    message = cloud(width, height, kind)
    assert walk(message + b"D" * 40, 21) == len(message)
    walker = Walker()
    assert walker.advance(message[:21]) == len(message) and not walker.done
    assert walker.advance(message) == len(message) and walker.done


@pytest.mark.parametrize("width", [2, 3, 77, 260, 640])
def test_clouds_byte_by_byte(width):
    message = cloud(width, 2)
    walker = Walker()
    for size in range(len(message)):
        assert walker.advance(message[:size]) > size and not walker.done
    assert walker.advance(message) == len(message) and walker.done


@pytest.mark.parametrize("kind", ["xy", "xyz", "xyz_i", "interest", "normal"])
@pytest.mark.parametrize("height", [1, 2, 3])
@pytest.mark.parametrize("width", [1, 4, 255, 256, 257, 260, 265, 266, 288, 320, 384, 512, 640])
def test_clouds_whose_header_comes_in_two_parts(width, height, kind):
    """A list is complete where it ends, unless more has come, which may be the rest of a header."""
    message = cloud(width, height, kind)
    ends = []
    for size in range(21):
        walker = Walker()
        walker.advance(message[:size])
        if walker.done:
            ends.append(size)
        else:
            assert walker.advance(message) == len(message) and walker.done
    assert len(ends) <= 1 and all(walk(message[:end], 1) == end for end in ends)
    assert len(ends) == 0 or width not in (256, 512), "which has elements of no kind"


def test_a_list_before_what_cannot_be_the_rest_of_a_header_is_complete():
    for rest in (framing.ACK, framing.number(7), packed(256, 0), packed(257, 1, 2)):
        walker = Walker()
        message = packed(257, 1, 2) + rest
        need = 12
        while not walker.done and need <= len(message):
            need = walker.advance(message[:need])
        assert walker.done and need == 12
        assert Walker().advance(message) == 12


def test_a_list_within_a_message_is_no_cloud():
    walker = Walker(nested=True)
    assert walker.advance(packed(257, 1, 2) + b"\0") == 12 and walker.done


def test_short_lists_do_not_wait_for_a_header_of_a_cloud():
    for message in (packed(257, 1, 2), packed(256, 1, 1, 5), packed(256, 0), packed(257, 2, 2, 1)):
        walker = Walker()
        assert walker.advance(message) == len(message) and walker.done


def test_the_limit_of_clouds():
    with pytest.raises(DecodeError, match="limit"):
        Walker(limit=1000).advance(cloud(100, 1)[:21])
    huge = struct.pack("<iiibii", 1 << 15, 1 << 15, 2, 1, 266, 1 << 30)
    with pytest.raises(DecodeError, match="limit"):
        Walker().advance(huge)


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
