"""Compiled functions that read: what is missing, left over, or spelled in another way."""

from typing import Any

import pytest

from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError
from yarpy.kits.thrift import kind as kinds
from yarpy.kits.thrift.kind import ListOf, Part
from yarpy.kits.thrift.wire.fast_reader import load, load_struct, surplus


def test_missing_and_surplus_values() -> None:
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
    result = surplus("the result of f", [Part("", kinds.I32)], 8)
    assert str(result) == "the result of f: too many values: 8 bytes are left over"


def test_what_cpp_would_not_write_is_read_all_the_same() -> None:
    data = Bottle(["x", 1, 2.5]).to_bytes()
    parts = [Part("s", kinds.TEXT), Part("d", kinds.DOUBLE), Part("e", kinds.DOUBLE)]
    assert load("f", parts)(data, 8) == ("x", 1.0, 2.5)


def test_structs_of_many_values() -> None:
    from yarpy.kits import thrift

    fields = {f"f{number}": thrift.i32 for number in range(300)}
    large: Any = type("Large", (thrift.Struct,), {"__annotations__": fields})
    pair: Any = type("Pair", (thrift.Struct,), {"__annotations__": {"a": large, "b": large}})
    value = pair(large(f7=7), large(f299=1))
    assert pair.from_wire(b"".join(value.to_wire())) == value
    found, end = load_struct(large)(b"".join(large(f1=3).to_wire()), 0, 8 + 300 * 8)
    assert found == large(f1=3) and end == 8 + 300 * 8
