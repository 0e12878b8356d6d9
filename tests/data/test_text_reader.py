"""Text to elements: what C++ makes of it, and that no text takes long or fails."""

import math
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.data.bottle import Bottle
from yarpy.data.text_reader import Balance, parse_text, tokens
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError


# Answers of a C++ port to what was typed into telnet (its echo of the request).
@pytest.mark.parametrize(
    ("typed", "echoed"),
    [
        (
            b"{1 2 255} {} 0x1F -3 +4 1e-3 .5 5. inf -inf nan true false",
            b"{1 2 255} {} 31 -3 4 0.00100000000000000002082 0.5 5.0 inf -inf nan true false",
        ),
        (
            rb'[a] [abcd] [abcde] () "" "\n\t\"\\" a\ b',
            rb'[a] [abcd] [abcd] () "" "\nt\"\\" "a b"',
        ),
        (
            b"2147483647 2147483648 -2147483649 99999999999999999999 1.0 1.",
            b"2147483647 2147483648 -2147483649 9223372036854775807 1.0 1.0",
        ),
        (
            b"a,b;c #d %e &f 'g h' <i>",
            b'a "b;c" "#d" "%e" "&f" "\'g" "h\'" "<i>"',
        ),
        ("héllo".encode(), '"héllo"'.encode()),
        (b"\x01\x02\xff\xfe", b'"\x01\x02\xff\xfe"'),
        (b"# comment", b'"#" comment'),
        (b'a (b)c d(e) "f"g', b'a () "d(e)" "f\\""'),
        (b"{a b} {1.5} {300}", b"{0 0} {1} {44}"),
        (b"\t tab   spaces \t", b"tab spaces"),
        (b"[1 2] [a b] []", b'false "2]" false "b]" false'),
    ],
)
def test_what_cpp_makes_of_what_people_type(typed, echoed):
    assert Bottle.from_text(typed).to_text().encode("utf-8", "surrogateescape") == echoed


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0", 0),
        ("010", 8),
        ("08", 0),
        ("-017", -15),
        ("00x10", 0),
        ("0x-5", 0),
        ("0xx1", 0),
        ("+x5", 0),
        ("-0x10", -16),
        ("0x12345678", 0x12345678),
        ("0x123456789", "0x123456789"),
        ("0b1", "0b1"),
        ("1_000", "1_000"),
        ("+-1", "+-1"),
        ("-+1", "-+1"),
        ("0-0-1", "0-0-1"),
        ("1--1", 1),
        ("12e", 0.0),
        ("1e5", 1e5),
        ("1E5", 1e5),
        ("1e+5", 1e5),
        ("1e5-", 0.0),
        ("1.5-2", 0.0),
        ("-.", 0.0),
        ("+.5", 0.5),
        (".", "."),
        ("..", ".."),
        (".e5", 0.0),
        ("0x1.8", 1.5),
        ("0x.8", 0.5),
        ("0x.", 0.0),
        ("0x1e5", 0x1E5),
        ("00x1.5", 0.0),
        ("-0x1.8", -1.5),
        ("inf", math.inf),
        ("-inf", -math.inf),
        ("+inf", "+inf"),
        ("Inf", "Inf"),
        ("infinity", "infinity"),
        ("-nan", "-nan"),
        ("-nan.0", "-nan.0"),
        ("true", True),
        ("false", False),
        (r"tru\e", True),
        ('"true"', "true"),
        ("null", Vocab("null")),
        ('"null"', "null"),
        ("[true]", Vocab("true")),
        ("[1]", True),
        ("9" * 5000, 2**63 - 1),
        ("-" + "9" * 5000, -(2**63)),
        ("0" + "7" * 5000, 2**63 - 1),
        ("-9223372036854775809", -(2**63)),
        ("9" * 5000 + ".0", math.inf),
    ],
)
def test_classification(text, value):
    (found,) = parse_text(text)
    assert found == value
    assert type(found) is type(value)


@pytest.mark.parametrize(
    "text", ["(1", "1)", '"abc', "a\\", "((1)", "{1", "1}", "(1 2))", '"a', "(]"]
)
def test_what_is_unbalanced_vanishes(text):
    assert parse_text(text) == []


@pytest.mark.parametrize(
    ("text", "blob"),
    [
        ("{0x10 -1 256 257}", b"\x10\xff\x00\x01"),
        ("{true false null [abc] [a]}", b"1\0naa"),
        ("{1.9 -1.9 1e99 nan inf}", b"\x01\xff\0\0\0"),
        ('{(1 2) {3} word "5"}', bytes(4)),
        ("{99999999999999999999}", b"\xff"),
    ],
)
def test_blobs(text, blob):
    assert parse_text(text) == [blob]


def test_deep_nesting_is_an_error_of_ours():
    text = "(" * 100 + "a" + ")" * 100
    assert Bottle.from_text(text).to_text() == text
    for depth in (101, 3000, 1_000_000):
        with pytest.raises(DecodeError, match="nested"):
            parse_text("(" * depth + "a" + ")" * depth)
        with pytest.raises(DecodeError, match="nested"):
            parse_text("(" * depth)
    assert parse_text("{" * 3000 + "}" * 3000) == [b"\0"]


def test_deep_and_long_text_takes_no_minutes():
    words = "a b " * 5_000
    for depth in (5, 40):
        assert len(parse_text("(" * depth + words + ")" * depth)) == 1
    begin = time.process_time()
    with pytest.raises(DecodeError, match="length"):
        parse_text("(" * 100 + words * 80 + ")" * 100)
    assert time.process_time() - begin < 20


@pytest.mark.parametrize(
    ("text", "complete"),
    [
        ("", True),
        ("a b", True),
        ("(a", False),
        ("a)", False),
        ("{1", False),
        ('"a', False),
        ('"a("', True),
        (r'"a\"', False),
        (r"\(", True),
        ("(a) {1} [x", True),
    ],
)
def test_balanced(text, complete):
    assert Balance().feed(text.encode()) is complete


def slow_balanced(text):
    quoted = back = False
    nested = curly = 0
    for char in text.decode():
        if back:
            back = False
            continue
        back = char == "\\"
        if char == '"':
            quoted = not quoted
        elif not quoted:
            nested += (char == "(") - (char == ")")
            curly += (char == "{") - (char == "}")
    return not quoted and nested == curly == 0


@given(st.lists(st.text('ab"\\\\(){} \n', max_size=6).map(str.encode), max_size=6))
def test_balance_of_pieces(pieces):
    balance = Balance()
    whole = b""
    for piece in pieces:
        whole += piece
        assert balance.feed(piece) is Balance().feed(whole) is slow_balanced(whole)


def test_balance_is_not_quadratic():
    balance = Balance()
    begin = time.process_time()
    for _ in range(200_000):
        assert not balance.feed(b"\n(")
    assert time.process_time() - begin < 5


def slow_tokens(line):
    """The tokeniser once more, one byte at a time."""
    found, token = [], b""
    quoted = back = begun = False
    nested = curly = 0
    for byte in line + b" ":
        char = bytes([byte])
        if back:
            token += char
            back = False
            continue
        begun = begun or char not in b" \t\r\n"
        if not begun:
            continue
        if char == b'"':
            quoted = not quoted
        if not quoted:
            nested += (char == b"(") - (char == b")")
            curly += (char == b"{") - (char == b"}")
        if char == b"\\":
            back = True
            token += char
        elif not quoted and char in b", \t\r\n" and not nested and not curly:
            if token:
                found.append(token)
            token, begun = b"", False
        else:
            token += char
    return found


@given(
    st.lists(st.sampled_from(list(b'ab1 ,\t\n"\\(){}[].')), max_size=30).map(bytes)
    | st.lists(st.sampled_from(list(b'ab ,\n"')), max_size=20).map(bytes)
)
def test_tokens(line):
    assert tokens(line) == slow_tokens(line)


@given(st.binary(max_size=60) | st.text('()[]{}"\\ ,.0123456789abefinxX+-\t\n', max_size=40))
def test_any_text_is_a_bottle(text):
    bottle = Bottle.from_text(text)
    again = Bottle.from_bytes(bottle.to_bytes())
    assert again.to_bytes() == bottle.to_bytes()
    bottle.to_text()
