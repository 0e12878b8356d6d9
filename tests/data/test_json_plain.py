"""The short ways between values and JSON: the same as the long ones, or none."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.data import json
from yarpy.data.bottle import Bottle, Property
from yarpy.data.json_plain import NOT_PLAIN, plain_json, plain_value
from yarpy.data.value import Float32, Int8, Vocab
from yarpy.errors import DecodeError

SCALARS = st.one_of(
    st.integers(),
    st.floats(),
    st.booleans(),
    st.none(),
    st.text(),
    st.sampled_from(["list", "dict", "null", "nan", "\x85", "\udc80"]),
)
VALUES = st.one_of(
    SCALARS,
    st.lists(SCALARS),
    st.lists(SCALARS).map(tuple),
    st.lists(SCALARS).map(Bottle),
    st.dictionaries(st.one_of(st.text(), st.integers()), SCALARS),
)


@given(VALUES)
def test_the_text_is_that_of_the_long_way(value: Any) -> None:
    text = plain_json(value)
    if text is not None:
        assert text == json._writer().encode(json._plain_top(value, "auto", True))


@given(st.one_of(SCALARS, st.lists(SCALARS), st.lists(st.lists(SCALARS))))
def test_the_value_is_that_of_the_long_way(found: Any) -> None:
    value = plain_value(found)
    if value is NOT_PLAIN:
        return
    other = json._message(found, 0)
    assert type(value) is type(other)
    assert repr(value) == repr(other)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ([1, -2.5], "[1, -2.5]"),
        ((1, 1e300), "[1, 1e+300]"),
        (Bottle([3]), "[3]"),
        ([], "[]"),
        ({}, "{}"),
        (["set", 1, "\n", True], '["set", 1, "\\n", "true"]'),
        ({"joint": 3, "angle": 45.0}, '{"joint": 3, "angle": 45.0}'),
        (7, "7"),
        ("x", '"x"'),
    ],
)
def test_what_is_common_takes_the_short_way(value: Any, text: str) -> None:
    assert plain_json(value) == text


@pytest.mark.parametrize(
    "value",
    [
        [1, [2]],
        ["list", 1],
        ["dict"],
        [math.nan],
        [1, math.inf],
        ["x", -math.inf],
        {"x": math.nan},
        {1: 2},
        {"x": []},
        [Vocab("set")],
        [Int8(3)],
        Float32(1.5),
        Property({"a": 1}),
        None,
        [None],
        [b"x"],
    ],
)
def test_what_needs_a_closer_look_does_not(value: Any) -> None:
    assert plain_json(value) is None


@pytest.mark.parametrize("found", [None, [None], [[1]], {}, [1 << 63], -(1 << 63) - 1, ["\xe4"]])
def test_neither_does_what_came(found: Any) -> None:
    assert plain_value(found) is NOT_PLAIN


@pytest.mark.parametrize("text", [" [1, 2]", "[1, 2]\n", "\t[1,2] "])
def test_space_around_it_changes_nothing(text: str) -> None:
    assert json.from_json(text) == Bottle([1, 2])


@pytest.mark.parametrize("text", ["[1, 2] 3", "[1", "", " ", "nul", "[1 << 3]", "NaN", "[NaN]"])
def test_what_is_no_json_is_none(text: str) -> None:
    with pytest.raises(DecodeError, match="this is not JSON"):
        json.from_json(text)
