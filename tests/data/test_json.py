"""JSON of messages: the values of C++ 3.9.1, and valid JSON for all that it has none for."""

from __future__ import annotations

import json
import math

import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

import yarpy
from yarpy.data import codec
from yarpy.data.bottle import Bottle, Property
from yarpy.data.json import from_json, to_json
from yarpy.data.value import Float32, Int8, Int64, Vocab
from yarpy.errors import DecodeError

CPP = [
    # text of a Bottle, and what C++ answers (all captured)
    ("(a 1) (b 2)", '{"a": 1, "b": 2}'),
    ("x (a 1) (b 2)", '{"type": "x", "a": 1, "b": 2}'),
    ("ok (a 1) (b (x 2.5)) [voc]", '["ok", ["a", 1], {"type": "b", "x": 2.5}, "voc"]'),
    ("list (a 1)", '[["a", 1]]'),
    ("list (a 1) (b 2)", '[["a", 1], ["b", 2]]'),
    ("dict (a 1)", '{"a": 1}'),
    ("", "[]"),
    ("[ver] 1 2 3", '["ver", 1, 2, 3]'),
    ("true false", '["true", "false"]'),
    ('port (error -2 "port not known")', '["port", ["error", -2, "port not known"]]'),
    ('"quo\\"te \\\\ \\n \\r"', '["quo\\"te \\\\ \\n \\r"]'),
    ("1.0 -0.5 [set]", '[1.0, -0.5, "set"]'),
]


@pytest.mark.parametrize(("text", "expected"), CPP)
def test_same_as_cpp(text: str, expected: str) -> None:
    assert to_json(Bottle.from_text(text)) == expected


OURS = [
    # where C++ writes what is no JSON, or loses something
    ("(1 2) (3 4)", "[[1, 2], [3, 4]]"),  # {1: 2, 3: 4}
    ("(a 1) (a 2)", '[["a", 1], ["a", 2]]'),  # {"a": 1, "a": 2}
    ("x (type 1)", '["x", ["type", 1]]'),
    ("inf -inf nan", "[null, null, null]"),
    ("{1 2 255}", '[{"type": "blob", "base64": "AQL/"}]'),
    ("12345678901234", "[12345678901234]"),
]


@pytest.mark.parametrize(("text", "expected"), OURS)
def test_valid_where_cpp_is_not(text: str, expected: str) -> None:
    assert to_json(Bottle.from_text(text)) == expected


def test_outer_form_can_be_chosen() -> None:
    items = Bottle.from_text("port (name /x) (ip h)")
    assert to_json(items, "list") == '["port", ["name", "/x"], ["ip", "h"]]'
    assert to_json(items, "dict") == '{"name": "/x", "ip": "h"}'
    assert to_json(Bottle.from_text("(a) (b 1 2) 7"), "dict") == '{"a": null, "b": 1}'


class Foreign:
    """A message whose bytes are no Bottle."""

    def to_wire(self) -> tuple[bytes, ...]:
        return (b"\xff\xff\xff",)


EVERY_KIND = [
    (5, "5"),
    ("x", '"x"'),
    (True, '"true"'),
    (None, "null"),
    (b"ab", '{"type": "blob", "base64": "YWI="}'),
    ([Int8(1), Int64(2), Float32(0.5)], "[1, 2, 0.5]"),
    ({"a": None, "b": [1]}, '{"a": null, "b": [1]}'),
    (Property(a=1, b={"c": 2}), '{"a": 1, "b": {"c": 2}}'),
    ([{"a": 1}, (1, 2)], '[{"a": 1}, [1, 2]]'),
    (yarpy.Vector([1, 2]), "[1.0, 2.0]"),
    (yarpy.Vector([math.nan, 1]), "[null, 1.0]"),
    (yarpy.Matrix(numpy.eye(2)), "[[1.0, 0.0], [0.0, 1.0]]"),
    (
        yarpy.Image(numpy.arange(6, dtype=numpy.uint8).reshape(2, 3)),
        '{"type": "image", "width": 3, "height": 2, "pixel": "mono", "base64": "AAECAwQF"}',
    ),
    (
        yarpy.Sound(numpy.array([[5, -6]], numpy.int16), 44100),
        '{"type": "sound", "frequency": 44100, "channels": [[5, -6]]}',
    ),
    (
        numpy.zeros((1, 2, 3), numpy.uint8),
        '{"type": "image", "width": 2, "height": 1, "pixel": "rgb", "base64": "AAAAAAAA"}',
    ),
    (Foreign(), '{"type": "blob", "base64": "////"}'),
    (yarpy.Stamp(1, 2.5), "[1, 2.5]"),
    (numpy.arange(3), "[0, 1, 2]"),
    ([numpy.float32(1.5), numpy.int16(3)], "[1.5, 3]"),
    (
        numpy.ones((1, 2), bool),
        '{"type": "array", "dtype": "|b1", "shape": [1, 2], "base64": "AQE="}',
    ),
    (
        {"a": {"b": (1, None)}, "c": numpy.ones(2), "d": numpy.ones(2, "u1"), "e": 1 + 2j},
        '{"a": {"b": [1, null]}, "c": [1.0, 1.0], '
        '"d": {"type": "array", "dtype": "|u1", "shape": [2], "base64": "AQE="}, "e": [1.0, 2.0]}',
    ),
    (1 + 2j, "[1.0, 2.0]"),
    ("\udcff", '"\ufffd"'),
    (["\ud800"], '["\ufffd\ufffd\ufffd"]'),
    ("<script>", '"<script>"'),
]


@pytest.mark.parametrize(("value", "expected"), EVERY_KIND, ids=lambda item: repr(item)[:30])
def test_every_kind_of_message(value: object, expected: str) -> None:
    text = to_json(value)
    assert text == expected
    json.loads(text)
    text.encode()


def test_what_cannot_be_sent_has_no_json() -> None:
    with pytest.raises(TypeError):
        to_json(object())


READ = [
    ('[1, 2.5, "a b", true, [], -7]', '1 2.5 "a b" true () -7'),
    ('{"a": 1, "b": [1, 2]}', "(a 1) (b (1 2))"),
    ('{"a": 1, "type": "x"}', "x (a 1)"),
    ('{"type": [1], "a": 1}', "(type (1)) (a 1)"),
    ('[{"type": "blob", "base64": "AQL/"}]', "{1 2 255}"),
    ('{"a": {"b": null}}', "(a ((b [null])))"),
    ("{}", ""),
]


@pytest.mark.parametrize(("text", "expected"), READ)
def test_reading(text: str, expected: str) -> None:
    found = from_json(text.encode())
    wanted = Bottle.from_text(expected)
    assert found == wanted
    assert codec.encode(found) == codec.encode(wanted)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[1,]",
        "nan",
        "[NaN]",
        "[Infinity]",
        "[1e5",
        "\xff",
        "9" * 30,
        "9" * 5000,
        "[" * 200 + "]" * 200,
        "[" * 100_000,
        '{"a":' * 90_000,
        '{"type": "blob", "base64": "???"}',
    ],
    ids=lambda item: item[:12],
)
def test_bad_json_is_our_error(text: str) -> None:
    with pytest.raises(DecodeError):
        from_json(text.encode("latin-1"))


@given(st.binary(max_size=60))
def test_any_bytes_give_a_value_or_our_error(data: bytes) -> None:
    try:
        value = from_json(data)
    except DecodeError:
        return
    codec.encode(value)


SCALARS = st.one_of(
    st.integers(-(1 << 63), (1 << 63) - 1),
    st.floats(),
    st.text(max_size=8),
    st.text(max_size=4).map(Vocab),
    st.booleans(),
    st.binary(max_size=8),
    st.sampled_from(["list", "dict", "type", "\udc80"]),
)
VALUES = st.recursive(
    SCALARS,
    lambda inner: st.one_of(
        st.lists(inner, max_size=4).map(Bottle),
        st.dictionaries(st.text(max_size=4), inner, max_size=3),
    ),
    max_leaves=12,
)


def no_constant(word: str) -> None:
    raise AssertionError(f"{word} in JSON")


@given(VALUES)
def test_every_message_gives_valid_json_that_reads_again(value: object) -> None:
    text = to_json(value)
    json.loads(text.encode("utf-8"), parse_constant=no_constant)
    again = from_json(text)
    codec.encode(again)


@given(st.dictionaries(st.text(min_size=1, max_size=5), st.integers(-9, 9), min_size=2))
def test_objects_come_back(value: dict[str, int]) -> None:
    assert json.loads(to_json(from_json(json.dumps(value)))) == value


def test_pixels_may_stay_at_home() -> None:
    """The facts are the same for an image, an array, and what arrived as one."""
    array = numpy.zeros((48, 64, 3), numpy.uint8)
    message = codec.decode(b"".join(codec.encode(yarpy.Image(array))))
    for value in (yarpy.Image(array), array, message):
        facts = json.loads(to_json(value, pixels=False))
        assert facts == {"type": "image", "width": 64, "height": 48, "pixel": "rgb"}
        assert json.loads(to_json(value)).keys() == {*facts, "base64"}


@pytest.mark.parametrize("digits", [20, 309, 4300, 5000])
def test_long_integers_are_refused(digits: int) -> None:
    with pytest.raises(DecodeError):
        from_json("9" * digits)
    with pytest.raises(DecodeError):
        from_json(f"[1, -{'9' * digits}]")


def test_control_characters_are_escaped_for_terminals() -> None:
    said = "\x1b[2J \x9b2J \x07\x85 é 🙂"
    text = to_json([said])
    assert not any(letter in text for letter in "\x1b\x9b\x07\x85")
    assert json.loads(text) == [said]
    assert from_json(text) == [said]
