"""Values written one by one: the bytes of each kind, and paths in errors."""

from types import ModuleType
from typing import Any

import numpy as np
import pytest
from support.thrift import rows

from yarpy.data.bottle import Bottle
from yarpy.data.sig.vector import Vector
from yarpy.data.value import Vocab
from yarpy.kits.thrift import kind as kinds
from yarpy.kits.thrift.kind import External, Kind, ListOf, MapOf, SetOf
from yarpy.kits.thrift.wire.writer import put
from yarpy.limit import THRIFT_LISTS


def wire(kind: Kind, value: Any, bottle: bool = False) -> str:
    parts: list[Any] = []
    put(kind, value, parts.append, "v", bottle)
    return b"".join(parts).hex()


def test_single_values(capt: ModuleType) -> None:
    for kind, value, expected in (
        (kinds.BOOL, True, "090000006f6b0000"),
        (kinds.BOOL, False, "090000006661696c"),
        (kinds.I8, -8, "20000000f8"),
        (kinds.UI8, 255, "20000000ff"),
        (kinds.I16, 0x0102, "400000000201"),
        (kinds.I32, np.int16(7), "0100000007000000"),
        (kinds.UI64, (1 << 64) - 1, "11000000ffffffffffffffff"),
        (kinds.DOUBLE, 1, "0a000000000000000000f03f"),
        (kinds.FLOAT, 1.5, "800000000000c03f"),
        (kinds.TEXT, "hi", "04000000020000006869"),
        (kinds.TEXT, Vocab("hi"), "04000000020000006869"),
        (kinds.BINARY, np.array([0, 1], "u1"), "0c000000020000000001"),
        (kinds.VOCAB, "demo", "0900000064656d6f"),
        (kinds.SIZE, 7, "0100000007000000"),
        (capt.Color, capt.Color.DARK_BLUE, "0100000007000000"),
        (capt.Color, 99, "0100000063000000"),
    ):
        assert wire(kind, value) == expected


def test_lists_of_lists_are_those_of_cpp_or_bottles() -> None:
    kind = ListOf(ListOf(kinds.I32))
    lists = "010100000200000001000000020000000101000001000000 03000000".replace(" ", "")
    assert wire(kind, [[1, 2], [3]]) == "0101000002000000" + lists
    assert wire(kind, [[1, 2], [3]], bottle=True) == "0001000002000000" + lists


def test_sets_are_bottles_in_order() -> None:
    assert wire(SetOf(kinds.I32), {6, 5}) == "01010000020000000500000006000000"
    assert wire(SetOf(kinds.TEXT), {"b", "a"}) == "04010000020000000100000061 0100000062".replace(
        " ", ""
    )
    assert wire(SetOf(kinds.BOOL), set()) == "0901000000000000"


def test_maps_are_pairs_in_order() -> None:
    expected = "0001000001000000 0001000002000000 04000000010000006b 0100000001000000"
    assert wire(MapOf(kinds.TEXT, kinds.I32), {"k": 1}) == expected.replace(" ", "")


def test_types_that_write_themselves() -> None:
    vector = External("yarp::sig::Vector", 1, "yarpy.Vector")
    expected = "0a01000001000000000000000000f03f"
    for value in (Vector([1.0]), [1.0], np.array([1.0])):
        assert wire(vector, value) == expected
    two = External("a::B", 2)
    assert wire(two, Bottle([1, "a"])) == "0100000001000000040000000100000061"
    with pytest.raises(TypeError, match="v: expected a Vector, got 5"):
        wire(vector, 5)
    with pytest.raises(TypeError, match="v: a::B takes 2 elements"):
        wire(two, [1])
    with pytest.raises(TypeError, match="v: expected a::B"):
        wire(two, object())


def test_large_arrays_are_not_copied() -> None:
    array = np.arange(10000.0)
    parts: list[Any] = []
    put(ListOf(kinds.DOUBLE), array, parts.append, "v")
    assert isinstance(parts[1], memoryview) and np.shares_memory(parts[1], array)


@pytest.mark.parametrize(
    ("kind", "value", "error"),
    [
        (kinds.I32, "x", "v: expected an integer, got 'x'"),
        (kinds.I32, 1.0, "v: expected an integer, got 1.0"),
        (kinds.I32, True, "v: expected an integer, got True"),
        (kinds.I8, 128, "v: 128 does not fit in i8"),
        (kinds.UI8, -1, "v: -1 does not fit in ui8"),
        (kinds.SIZE, -1, "v: -1 is negative"),
        (kinds.DOUBLE, "1", "v: expected a number, got '1'"),
        (kinds.FLOAT, 1e300, "does not fit in float32"),
        (kinds.BOOL, "yes", "v: expected True or False, got 'yes'"),
        (kinds.TEXT, 5, "v: expected a string, got 5"),
        (kinds.TEXT, "\ud800", "v: text that cannot be sent"),
        (kinds.BINARY, 5, "v: expected bytes, got 5"),
        (kinds.VOCAB, "large", "v: 'large' is longer than the four bytes"),
        (kinds.VOCAB, 5, "v: expected a word, got 5"),
        (ListOf(kinds.TEXT), "abc", "v: expected a list, got 'abc'"),
        (ListOf(kinds.TEXT), ["a", 1], r"v\[1\]: expected a string, got 1"),
        (ListOf(kinds.I32), 5, "v: expected a list of numbers, got 5"),
        (ListOf(kinds.I32), [[1], [2]], r"v\[0\]: expected an integer, got a list"),
        (ListOf(kinds.I32), np.zeros((2, 2), int), r"v: expected a list of numbers, got the shape"),
        (ListOf(kinds.I32), [0] * 50 + [0.5], r"v\[50\]: expected int32, got 0.5"),
        (ListOf(kinds.UI8), [0] * 50 + [256], r"v\[50\]: 256 does not fit in uint8"),
        (ListOf(kinds.BOOL), [0, 2], r"v\[1\]: expected True or False, got 2"),
        (MapOf(kinds.TEXT, kinds.I32), [1], "v: expected a dict, got a list"),
        (MapOf(kinds.TEXT, kinds.I32), {"a": "b"}, r"v\['a'\]: expected an integer, got 'b'"),
        (MapOf(kinds.TEXT, kinds.I32), {1: 2}, "v, key 1: expected a string"),
    ],
)
def test_errors_say_where(kind: Kind, value: Any, error: str) -> None:
    with pytest.raises((TypeError, OverflowError), match=error):
        wire(kind, value)


def test_errors_of_enums_and_structs(capt: ModuleType) -> None:
    with pytest.raises(TypeError, match=r"expected Color.NAME \(RED, GREEN, D.*\), got 'RED'"):
        wire(capt.Color, "RED")
    with pytest.raises(TypeError, match="v: expected a Point, got a list"):
        wire(capt.Point, [1, 2])


def test_what_contains_itself_ends() -> None:
    kind: Kind = kinds.I32
    value: Any = 1
    for _ in range(THRIFT_LISTS + 5):
        kind, value = ListOf(ListOf(kind)), [[value]]
    with pytest.raises(TypeError, match="lists within each other cannot be sent"):
        wire(kind, value)


def test_structs_are_those_of_cpp(capt: ModuleType) -> None:
    for row in rows("structs"):
        cls = getattr(capt, row["struct"].partition("_")[0])
        if cls is not capt.Sets:
            made = cls.from_wire(bytes.fromhex(row["hex"]))
            assert wire(cls, made) == row["hex"][16:]
