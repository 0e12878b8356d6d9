"""Compiled functions that write: the bytes of the slow way, which are read again."""

from types import ModuleType
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from yarpy.kits.thrift import kind as kinds
from yarpy.kits.thrift.kind import ListOf, MapOf, Part
from yarpy.kits.thrift.wire.fast_reader import load
from yarpy.kits.thrift.wire.fast_writer import dump, slow_dump

i32 = st.integers(-(1 << 31), (1 << 31) - 1)
texts = st.text(st.characters(exclude_categories=["Cs"]), max_size=5)


def made(capt: ModuleType) -> st.SearchStrategy[Any]:
    point = st.builds(capt.Point, i32, i32)
    nest = st.builds(
        capt.Nest,
        point,
        st.lists(point, max_size=3),
        st.dictionaries(texts, point, max_size=3),
        st.lists(st.lists(i32, max_size=3), max_size=3),
        st.dictionaries(texts, st.lists(st.floats(allow_nan=False)), max_size=2),
    )
    prims = st.builds(
        capt.Prims,
        st.booleans(),
        st.integers(-128, 127),
        st.integers(-32768, 32767),
        i32,
        st.integers(-(1 << 63), (1 << 63) - 1),
        st.floats(allow_nan=False),
        texts,
        st.binary(max_size=5),
        st.sampled_from([*capt.Color]),
    )
    return st.one_of(point, nest, prims, st.builds(capt.Deep, nest, texts))


@settings(max_examples=150)
@given(st.data())
def test_fast_and_slow_agree(capt: ModuleType, data: Any) -> None:
    value = data.draw(made(capt))
    part = Part("", type(value), nested=True)
    slow = slow_dump("v", [part], [value])
    assert b"".join(value.to_wire()) == slow
    assert type(value).from_wire(slow) == value
    assert type(value).from_bottle(value.to_bottle()) == value


def test_rows_of_values(capt: ModuleType) -> None:
    parts = [
        Part("a", kinds.I32),
        Part("at", capt.Point, nested=True),
        Part("words", ListOf(kinds.TEXT)),
        Part("map", MapOf(kinds.I32, kinds.I32)),
    ]
    values = (1, capt.Point(2, 3), ["x", "y"], {4: 5})
    data = dump("f", parts, b"head")(*values)
    assert data.startswith(b"head")
    assert load("f", parts)(data, 4) == values
    assert data == slow_dump("f", parts, values, b"head")


def test_errors_have_one_traceback(capt: ModuleType) -> None:
    with pytest.raises(TypeError) as caught:
        dump("f", [Part("a", kinds.I32)])("x")
    context = caught.value.__context__
    assert context is None or caught.value.__suppress_context__
    assert str(caught.value).startswith("f.a: expected")
