"""Compiled functions: they write and read what the slow way does."""

from types import ModuleType
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError
from yarpy.idl.thrift import kind as kinds
from yarpy.idl.thrift.fast import Part, dump, load, load_struct, slow_dump, surplus
from yarpy.idl.thrift.kind import ListOf, MapOf

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


def test_missing_and_surplus_values(capt: ModuleType) -> None:
    parts = [Part("a", kinds.I32), Part("b", kinds.I32), Part("c", ListOf(kinds.I32))]
    read = load("f", parts, [lambda: 7, lambda: [8]])
    assert read(Bottle([1, "x"]).to_bytes()[:16], 8) == (1, 7, [8])
    with pytest.raises(DecodeError, match=r"f\.a is missing"):
        read(b"\0" * 8, 8)
    with pytest.raises(DecodeError, match=r"f\.b is missing"):
        load("f", parts[:2])(Bottle([1, "x"]).to_bytes()[:16], 8)
    with pytest.raises(DecodeError, match="16 bytes are left over; it takes nothing"):
        load("f", [])(b"\0" * 24, 8)
    assert "it takes a" in str(surplus("f", [Part("a", kinds.I32)], 3))


def test_what_cpp_would_not_write_is_read_all_the_same(capt: ModuleType) -> None:
    data = Bottle(["x", 1, 2.5]).to_bytes()
    parts = [Part("s", kinds.TEXT), Part("d", kinds.DOUBLE), Part("e", kinds.DOUBLE)]
    assert load("f", parts)(data, 8) == ("x", 1.0, 2.5)


def test_errors_have_one_traceback(capt: ModuleType) -> None:
    with pytest.raises(TypeError) as caught:
        dump("f", [Part("a", kinds.I32)])("x")
    context = caught.value.__context__
    assert context is None or caught.value.__suppress_context__
    assert str(caught.value).startswith("f.a: expected")


def test_structs_of_many_values() -> None:
    from yarpy.idl import thrift

    fields = {f"f{number}": thrift.i32 for number in range(300)}
    large: Any = type("Large", (thrift.Struct,), {"__annotations__": fields})
    pair: Any = type("Pair", (thrift.Struct,), {"__annotations__": {"a": large, "b": large}})
    value = pair(large(f7=7), large(f299=1))
    assert pair.from_wire(b"".join(value.to_wire())) == value
    found, end = load_struct(large)(b"".join(large(f1=3).to_wire()), 0, 8 + 300 * 8)
    assert found == large(f1=3) and end == 8 + 300 * 8
