import struct
import tracemalloc

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.message import bottles, kinds, walk
from support.table import for_each
from support.vectors import binaries, rows

from yarpy.data import reader
from yarpy.data.bottle import Bottle, Property, read_bottle
from yarpy.data.reader import read_small
from yarpy.data.sig.cloud_head import may_be_cloud
from yarpy.data.value import Float32, Int8, Int16, Int64, Vocab
from yarpy.data.walker import Walker
from yarpy.data.writer import list_blocks
from yarpy.errors import DecodeError, Truncated

GOLDEN = binaries()


def packed(*words):
    return struct.pack(f"<{len(words)}i", *words)


@for_each(rows("bottle"))
def test_golden_messages(row):
    bottle = read_bottle(bytes.fromhex(row["binary"]))
    assert len(bottle) == row["size"]
    assert bottle.to_text() == row["printed"]
    assert bottle.to_bytes() == bytes.fromhex(row["binary"])


@for_each(GOLDEN)
def test_truncated_anywhere(message):
    for size in range(len(message)):
        with pytest.raises(DecodeError):
            read_bottle(message[:size])


def test_truncated_says_how_much_it_takes():
    with pytest.raises(Truncated) as caught:
        read_bottle(packed(257, 3, 1))
    assert caught.value.need == 20


def test_every_kind():
    message = bytes.fromhex(
        "00010000 08000000 20000000fb 400000002c01 0100000007000000"
        "110000000000000000010000 800000000000c03f 0a00000000000000000004c0"
        "0900000061626364 0400000003000000686579"
    )
    bottle = read_bottle(message)
    assert bottle == [-5, 300, 7, 2**40, 1.5, -2.5, "abcd", "hey"]
    assert kinds(bottle) == [Int8, Int16, int, int, Float32, float, Vocab, str]


def test_small_int64_keeps_its_width():
    bottle = read_bottle(packed(256 + 17, 2) + struct.pack("<qq", 5, 2**40))
    assert kinds(bottle) == [Int64, int]
    assert bottle.to_bytes() == packed(256 + 17, 2) + struct.pack("<qq", 5, 2**40)


def test_dict_element():
    message = bytes.fromhex(
        "0001000001000000000300000001000001000000000100000200000004000000010000006b0100000005000000"
    )
    (value,) = read_bottle(message)
    assert type(value) is Property and value == {"k": 5}


def test_only_the_low_byte_of_the_first_code_counts():
    assert read_bottle(packed(1, 1, 5)) == [5]
    assert read_bottle(packed(512, 1, 1, 5)) == [5]
    assert read_bottle(packed(0x7FFFFF01, 1, 5)) == [5]


def test_bytes_behind_the_end_do_not_matter():
    assert read_bottle(packed(257, 1, 5) + b"ZZZZ") == [5]


def test_strings_may_hold_anything():
    raw = bytes(range(256))
    message = packed(260, 1, 256) + raw
    (text,) = read_bottle(message)
    assert text.encode("utf-8", "surrogateescape") == raw
    assert Bottle([text]).to_bytes() == message


@pytest.mark.parametrize(
    "message",
    [
        packed(256, 1, 77, 5),  # captured: C++ refuses
        packed(999, 1, 5),  # captured: C++ refuses
        packed(256, 1, 5, 5),
        packed(256, 1, 0, 5),
        packed(256, 1, 1024, 0),
        packed(256, 1, -1, 0),
        packed(256, -1),
        packed(257, -1),
        packed(256, 1, 4, -1),
        packed(260, 1, -5),
        packed(268, 1, -5),
        packed(256, 1, 257, -2),
        packed(256, 1, 768, 256, -2),
        packed(256, 1, 256 + 5, 1, 0),
        packed(256, 1, 33, 0)[:-1],
    ],
    ids=lambda message: message.hex(),
)
def test_nonsense(message):
    for _ in range(2):
        with pytest.raises(DecodeError) as caught:
            read_bottle(message)
        assert not isinstance(caught.value, Truncated)
        message += bytes(64)


@pytest.mark.parametrize(
    "head",
    [
        packed(256, 0x7FFFFFFF),
        packed(257, 0x7FFFFFFF),
        packed(266, 0x7FFFFFFF),
        packed(260, 0x7FFFFFFF),
        packed(256 + 32, 0x7FFFFFFF),
        packed(256, 1, 4, 0x7FFFFFFF),
        packed(256, 1, 12, 0x7FFFFFFF),
        packed(260, 1, 0x7FFFFFFF),
        packed(256, 1, 256, 0x7FFFFFFF),
        packed(256, 1, 768, 257, 0x7FFFFFFF),
    ],
    ids=lambda head: head.hex(),
)
def test_announced_size_takes_no_memory(head):
    tracemalloc.start()
    try:
        with pytest.raises(Truncated):
            read_bottle(head + bytes(100))
        assert tracemalloc.get_traced_memory()[1] < 100_000
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("tag", [packed(256), packed(768, 256)], ids=["lists", "dicts"])
def test_deep_nesting(tag):
    def nested(depth):
        return packed(256, 1) + (tag + packed(1)) * (depth - 1) + tag + packed(0)

    assert read_bottle(nested(100))
    assert walk(nested(100), 4096) == len(nested(100))
    for depth in (101, 5000, 200_000):
        with pytest.raises(DecodeError, match="nested"):
            read_bottle(nested(depth))
        with pytest.raises(DecodeError, match="nested"):
            Walker().advance(nested(depth))


@pytest.mark.parametrize("count", [5000, 100_000])
def test_large_messages_read_the_same(count):
    items = Bottle([Vocab("set"), *(["word", 1, 2.5] * count), Int8(3)])
    message = items.to_bytes()
    assert read_bottle(message) == items
    assert read_bottle(memoryview(message)) == items
    assert read_bottle(bytearray(message)) == items


@given(bottles)
def test_round_trip(bottle):
    message = bottle.to_bytes()
    again = read_bottle(message)
    assert again == bottle
    assert kinds(again) == kinds(bottle)
    assert again.to_bytes() == message
    assert walk(message) == len(message)


@given(bottles, st.data())
def test_truncated_round_trip(bottle, data):
    message = bottle.to_bytes()
    size = data.draw(st.integers(0, len(message) - 1))
    with pytest.raises(Truncated) as caught:
        read_bottle(message[:size])
    assert size < caught.value.need <= len(message)


@given(st.sampled_from(GOLDEN), st.data())
def test_mutated(message, data):
    changed = bytearray(message)
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(changed) - 1))
        changed[at] = data.draw(st.sampled_from([0, 1, 2, 3, 4, 9, 12, 127, 128, 255]))
    check_agreement(bytes(changed))


@given(st.binary(max_size=80))
def test_garbage(message):
    check_agreement(message)


@pytest.mark.parametrize("count", [-1, 0, 1, 2])
def test_any_code(count):
    """Even one that no list has: with nothing in it, it is an empty list."""
    for code in range(600):
        for begun in range(5):
            check_agreement(struct.pack("<iii", code, count, 0)[: 8 + begun])


def check_agreement(message):
    """Reader and Walker say the same about any bytes, and nothing worse than DecodeError."""
    try:
        bottle = read_bottle(message)
    except Truncated:
        bottle = None
    except DecodeError:
        with pytest.raises(DecodeError):
            read_bottle(message)
        return
    walker = Walker()
    try:
        need = walker.advance(message)
    except DecodeError:
        # the limit, or an error behind the place where the reader ran out of bytes, or a Sound
        assert bottle is None
        return
    if bottle is not None and not walker.done:  # until it is clear that it is no PointCloud
        assert 8 < len(message) < 21 and may_be_cloud(message)
        return
    assert walker.done == (bottle is not None)
    if bottle is not None:
        assert need <= len(message)
        assert read_bottle(message[:need]) == read_bottle(b"".join(list_blocks(bottle))) or (
            "nan" in repr(bottle)
        )


NUMBERS = st.lists(
    st.one_of(st.integers(-(2**40), 2**40), st.integers(-9, 9), st.floats(allow_nan=False)),
    max_size=5,
)


@given(st.lists(st.tuples(NUMBERS, st.binary(max_size=9)), max_size=8))
def test_messages_of_the_same_size_need_not_be_of_the_same_kind(messages):
    for numbers, rest in messages:
        message = Bottle(numbers).to_bytes()
        for found in (
            read_bottle(message + rest),
            read_small(Bottle, Property.from_bottle, message + rest),
        ):
            bottle, end = found if isinstance(found, tuple) else (found, len(message))
            assert (bottle, kinds(bottle), end) == (numbers, kinds(numbers), len(message))


def test_plans_do_not_pile_up():
    message = Bottle([1, 2.5]).to_bytes()
    for size in range(2 * reader._PLANS):
        assert read_small(Bottle, Property.from_bottle, message + bytes(size)) == (
            [1, 2.5],
            len(message),
        )
    assert 0 < len(reader._plans) <= reader._PLANS
