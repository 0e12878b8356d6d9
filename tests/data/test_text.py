import math
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.message import bottles, texts
from support.table import for_each
from support.vectors import rows

from yarpy.data.bottle import Bottle
from yarpy.data.codec import encode_text
from yarpy.data.text import plain_text, print_text
from yarpy.data.text_reader import parse_text
from yarpy.data.value import Float32, Int8, Int64, Vocab


@for_each(rows("bottle"))
def test_golden_texts(row):
    bottle = Bottle.from_text(row["text"])
    assert len(bottle) == row["size"]
    assert bottle.to_text() == row["printed"]
    assert bottle.to_bytes().hex() == row["binary"]
    assert Bottle.from_text(row["text"].encode()) == bottle


@for_each(rows("bottle"))
def test_printed_form_reads_back(row):
    again = Bottle.from_text(row["printed"])
    assert again.to_text() == row["printed"]
    if row["printed"] not in ("null", "nan"):
        assert again.to_bytes().hex() == row["binary"] or "inf" in row["printed"]


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.1, "0.100000000000000005551"),
        (1.0, "1.0"),
        (1e15, "1000000000000000.0"),
        (1e20, "100000000000000000000.0"),
        (1e21, "1e+21"),
        (Float32(0.1), "0.100000001490116119385"),
        (-0.0, "-0.0"),
        (math.inf, "inf"),
        (-math.inf, "-inf"),
        (math.nan, "nan"),
        (struct.unpack("<d", b"\0\0\0\0\0\0\xf8\xff")[0], "-nan.0"),
        (5e-324, "4.94065645841246544177e-324"),
        (Int8(-5), "-5"),
        (Int64(3), "3"),
        (True, "true"),
        (Vocab("set"), "[set]"),
        (Vocab("1"), "true"),
        (Vocab(""), "false"),
        (Vocab.from_code(-7), "[]"),
        ("", '""'),
        ("true", '"true"'),
        ("null", "null"),
        ("nan", "nan"),
        ("a-b.c_9", "a-b.c_9"),
        ("9a", '"9a"'),
        (".a", '".a"'),
        ("-a", '"-a"'),
        ("é", '"é"'),
        ('a"b\\c\n\r\0\t', '"a\\"b\\\\c\\n\\r\\0\t"'),
        ("word\n", '"word\\n"'),
        (b"\x00\xff", "{0 255}"),
        (bytearray(b""), "{}"),
        (memoryview(b"a"), "{97}"),
        ([1, [2, []]], "(1 (2 ()))"),
        ((1, 2), "(1 2)"),
        ({"k": 1, "a": "x y"}, '((a "x y") (k 1))'),
        ({}, "()"),
    ],
)
def test_printing(value, text):
    assert print_text([value]) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ("a b", "a b"),
        (Vocab("set"), "set"),
        (True, "true"),
        ([1, "a b"], '1 "a b"'),
        (None, ""),
        ({"k": 1}, "(k 1)"),
        (b"\x01\x02", "1 2"),
        (1.5, "1.5"),
    ],
)
def test_plain_text(value, text):
    assert plain_text(value) == text


@pytest.mark.parametrize("number", [2**63, -(2**63) - 1, 10**30])
def test_what_reads_back_as_another_number_is_not_printed(number):
    for value in ([number], [[1, number]], {"a": number}):
        with pytest.raises(OverflowError, match="64 bits"):
            encode_text(value)
    for edge in (2**63 - 1, -(2**63)):
        assert parse_text(print_text([edge])) == [edge]


def test_deep_nesting_cannot_be_printed():
    loop: list[object] = []
    loop.append(loop)
    with pytest.raises(ValueError, match="nested"):
        print_text(loop)


def test_unknown_objects_cannot_be_printed():
    for value in (None, object(), 1j):
        with pytest.raises(TypeError):
            print_text([value])


@given(st.lists(texts, max_size=5))
def test_strings_survive(words):
    words = [word for word in words if word not in ("null", "inf", "nan", "-inf")]
    assert parse_text(print_text(words)) == words


def through_text(value):
    """What text makes of a value: it knows two kinds of numbers only, and no dicts."""
    if isinstance(value, list):
        return [through_text(item) for item in value]
    if isinstance(value, str) and not isinstance(value, Vocab):
        return {"null": Vocab("null"), "inf": math.inf}.get(value, value)
    if isinstance(value, (bool, Vocab)):
        return value
    if isinstance(value, int):
        return int(value)
    return float(value) if isinstance(value, float) else value


def readable(value):
    """Vocabs with brackets or quotes do not survive text, in C++ neither; and what is not a number
    equals nothing."""
    if isinstance(value, list):
        return all(readable(item) for item in value)
    if value == "nan":
        return False
    return not isinstance(value, Vocab) or value.isalnum()


@given(bottles.filter(readable))
def test_text_round_trip(bottle):
    again = Bottle.from_text(bottle.to_text())
    assert again == through_text(bottle)
    assert Bottle.from_text(again.to_text()) == again
