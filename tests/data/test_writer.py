import enum
import math
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.message import bottles, kinds, scalars, texts

from yarpy.data.bottle import Bottle, Property
from yarpy.data.sig.vector import Vector
from yarpy.data.stamp import Stamp
from yarpy.data.text import text_of
from yarpy.data.text_reader import parse_text
from yarpy.data.value import Float32, Int8, Int16, Int64, Vocab
from yarpy.data.writer import dict_elements, list_blocks, value_blocks


@pytest.mark.parametrize(
    ("items", "message"),
    [
        ([], "0001000000000000"),
        ([1, 2, 3], "0101000003000000010000000200000003000000"),
        (["hi", 5], "00010000020000000400000002000000686901000000 05000000"),
        (
            [[1, 2], ["a", "b"], []],
            "00010000030000000101000002000000010000000200000004010000020000000100000061"
            "01000000620001000000000000",
        ),
        ([True, False, Vocab("ok")], "090100000300000031000000000000006f6b0000"),
        ([b"\1\2\3"], "0c0100000100000003000000010203"),
        ([bytearray(b"\1"), memoryview(b"\2")], "0c0100000200000001000000010100000002"),
        ([Int8(-5)], "2001000001000000fb"),
        ([Int16(300), Int16(-1)], "40010000020000002c01ffff"),
        ([Int64(-1)], "1101000001000000ffffffffffffffff"),
        ([Float32(1.5)], "80010000010000000000c03f"),
        (
            [Float32(0.1), Int16(3), Int64(-1)],
            "000100000300000080000000cdcccc3d40000000030011000000ffffffffffffffff",
        ),
        ([2**31, -(2**31) - 1], "11010000020000000000008000000000ffffff7fffffffff"),
        ([2**31, 1], "00010000020000001100000000000080000000000100000001000000"),
        ([2**40, "a"], "0001000002000000110000000000000000010000040000000100000061"),
        ([True, 1], "0001000002000000090000003100000001000000 01000000"),
        ([[2**31]], "0001000001000000110100000100000000000080 00000000"),
    ],
)
def test_messages(items, message):
    assert b"".join(list_blocks(items)) == bytes.fromhex(message)
    assert b"".join(list_blocks(tuple(items))) == bytes.fromhex(message)
    assert b"".join(list_blocks(Bottle(items))) == bytes.fromhex(message)


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (42, "0001000001000000010000002a000000"),
        ("str", "00010000010000000400000003000000737472"),
        (True, "00010000010000000900000031000000"),
        (2**40, "0001000001000000110000000000000000010000"),
        (b"abc", "00010000010000000c00000003000000616263"),
        ([1], "00010000010000000101000001000000 01000000"),
    ],
)
def test_single_values_are_never_specialised(value, message):
    assert b"".join(value_blocks(value)) == bytes.fromhex(message)


class Colour(enum.IntEnum):
    RED = 7


class Word(enum.StrEnum):
    GO = "go"


def test_subclasses_count_as_what_they_are():
    class Narrow(Int8):
        pass

    class Wide(float):
        pass

    class Line(str):
        pass

    class Pair(tuple):
        pass

    items = [Colour.RED, Word.GO, Narrow(1), Wide(0.5), Line("x"), Pair((1,)), b"a"]
    plain = [7, "go", Int8(1), 0.5, "x", [1], b"a"]
    assert list_blocks(items) == list_blocks(plain)


def test_objects_with_a_wire_form():
    class Point:
        def to_wire(self):
            return (b"".join(list_blocks([1, 2.5])),)

    items = [Point(), Stamp(7, 1.5), Vector([1.0, 2.0])]
    assert list_blocks(items) == list_blocks([[1, 2.5], [7, 1.5], [1.0, 2.0]])


@pytest.mark.parametrize("count", [10, 24, 25, 1000])
def test_lists_of_numbers_of_any_length(count):
    for kind, letter, tag in ((int, "i", 1), (float, "d", 10), (Int16, "h", 64)):
        items = [kind(i) for i in range(count)]
        message = struct.pack(f"<ii{count}{letter}", 256 + tag, count, *items)
        assert list_blocks(items) == (message,)
    items = [1] * (count - 1) + [2**31]
    assert Bottle.from_bytes(b"".join(list_blocks(items))) == items


@pytest.mark.parametrize("value", [None, object(), 1j, {1, 2}, Stamp, ..., range(3)])
def test_unknown_elements(value):
    for items in ([value], [1, value], [[value]], [value] * 40):
        with pytest.raises(TypeError, match="cannot be an element of a Bottle"):
            list_blocks(items)


@pytest.mark.parametrize("value", [2**63, -(2**63) - 1, 10**4000])
def test_numbers_that_do_not_fit(value):
    for items in ([value], [1, "a", value], [value] * 40):
        with pytest.raises(OverflowError, match="64 bits"):
            list_blocks(items)


def test_loops_and_depth():
    loop: list[object] = []
    loop.append(loop)
    with pytest.raises(ValueError, match="nested"):
        list_blocks(loop)
    deep: list[object] = [1]
    for _ in range(100):
        deep = [deep]
    assert Bottle.from_bytes(b"".join(list_blocks(deep))) == deep
    with pytest.raises(ValueError, match="nested"):
        list_blocks([deep])


def test_big_blobs_are_not_copied():
    blob = bytearray(5000)
    blocks = list_blocks(["a", blob, 3, b"small"])
    assert [len(block) for block in blocks[:2]] == [8 + 9 + 8, 5000]
    blob[0] = 77
    assert blocks[1][0] == 77
    assert Bottle.from_bytes(b"".join(blocks)) == ["a", bytes(blob), 3, b"small"]
    nested = list_blocks([[blob], blob])
    assert [len(block) for block in nested if isinstance(block, memoryview)] == [5000, 5000]
    assert Bottle.from_bytes(b"".join(nested)) == [[bytes(blob)], bytes(blob)]
    assert len(list_blocks([b"x" * 4095])) == 1
    assert b"".join(value_blocks(blob)) == b"".join(value_blocks(bytes(blob)))


def test_views_of_other_shapes():
    numbers = memoryview(struct.pack("<4i", 1, 2, 3, 4)).cast("i", (2, 2))
    assert Bottle.from_bytes(b"".join(list_blocks([numbers]))) == [bytes(numbers)]
    assert list_blocks([memoryview(b"abcdef")[::2]]) == list_blocks([b"ace"])


@given(st.lists(scalars, max_size=30))
def test_short_ways_write_what_the_long_way_writes(items):
    short = b"".join(list_blocks(items))
    again = Bottle.from_bytes(short)
    # subclasses have no plan, so this is the long way
    long = [type("Sub", (type(i),), {})(i) if type(i) in (int, float) else i for i in items]
    assert b"".join(list_blocks(long)) == short
    assert again.to_bytes() == short


def test_what_cannot_be_an_element_is_named_as_one_says_it() -> None:
    with pytest.raises(TypeError, match=r"^an object cannot be an element"):
        list_blocks([object()])


@given(st.dictionaries(texts, scalars | bottles, max_size=5))
def test_the_message_is_what_the_text_says(values):
    by_text = parse_text(text_of(values))
    assert repr(dict_elements(values)) == repr(by_text)
    assert kinds(dict_elements(values)) == kinds(by_text)
    assert Property(values).to_bytes() == Bottle(by_text).to_bytes()


@pytest.mark.parametrize("word", ["null", "inf", "nan", "-inf", "true", "-nan"])
def test_words_that_change(word):
    changed = {"null": Vocab("null"), "inf": math.inf, "nan": math.nan}.get(word, word)
    assert repr(dict_elements({"k": [word]})) == repr([["k", [changed]]])


def test_values_that_text_changes():
    negative_nan = struct.unpack("<d", b"\0\0\0\0\0\0\xf8\xff")[0]
    assert dict_elements({"k": negative_nan}) == [["k", "-nan.0"]]
    assert math.isnan(dict_elements({"k": math.nan})[0][1])
    assert dict_elements({"k": -math.inf}) == [["k", -math.inf]]
    assert dict_elements({"a": 1, "b": Vocab(")")}) == [["a", 1]], "the bracket swallows its group"
    with pytest.raises(OverflowError):
        Property(k=2**70).to_bytes()
