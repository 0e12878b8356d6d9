"""Bytes read one by one: what C++ and people send, and what is refused without taking memory."""

from types import ModuleType
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from yarpy.data.bottle import Bottle
from yarpy.data.sig.vector import Vector
from yarpy.data.value import Float32, Int8, Int16, Int64, Vocab
from yarpy.errors import DecodeError, Truncated
from yarpy.kits.thrift import kind as kinds
from yarpy.kits.thrift.kind import External, Kind, ListOf, MapOf, SetOf
from yarpy.kits.thrift.wire.cursor import Cursor, spread
from yarpy.kits.thrift.wire.reader import get


def read(kind: Kind, *items: Any) -> Any:
    """The value of the elements of a Bottle."""
    cursor = Cursor(spread(Bottle(items).to_bytes()), 8)
    found = get(kind, cursor, "v")
    assert cursor.at == cursor.end
    return found


@pytest.mark.parametrize(
    ("kind", "sent", "expected"),
    [
        (kinds.I32, Int8(5), 5),
        (kinds.I32, Int16(-5), -5),
        (kinds.I32, Int64(5), 5),
        (kinds.I32, Vocab("a"), 97),
        (kinds.I8, 5, 5),
        (kinds.UI8, 200, 200),
        (kinds.UI8, Int8(-56), 200),
        (kinds.UI64, Int64(-1), (1 << 64) - 1),
        (kinds.I64, 5, 5),
        (kinds.DOUBLE, 5, 5.0),
        (kinds.DOUBLE, Float32(0.5), 0.5),
        (kinds.FLOAT, 0.5, 0.5),
        (kinds.BOOL, 1, True),
        (kinds.BOOL, 0, False),
        (kinds.BOOL, Vocab("ok"), True),
        (kinds.BOOL, Vocab("fail"), False),
        (kinds.BOOL, True, True),
        (kinds.BOOL, False, False),
        (kinds.TEXT, Vocab("abc"), "abc"),
        (kinds.BINARY, "abc", b"abc"),
        (kinds.VOCAB, "abc", Vocab("abc")),
        (ListOf(kinds.DOUBLE), [1, 2.5], [1.0, 2.5]),
        (ListOf(kinds.I16), [1, 2], [1, 2]),
        (ListOf(kinds.I32), [], []),
        (ListOf(kinds.TEXT), ["a", Vocab("b")], ["a", "b"]),
        (ListOf(kinds.BOOL), [Vocab("ok"), 0], [True, False]),
        (SetOf(kinds.I32), [3, 3, 1], {1, 3}),
        (MapOf(kinds.I32, kinds.I32), [[1, 2], [3, 4]], {1: 2, 3: 4}),
        (MapOf(kinds.TEXT, kinds.BOOL), [["a", 1]], {"a": True}),
    ],
)
def test_what_others_may_send(kind: Kind, sent: Any, expected: Any) -> None:
    found = read(kind, sent)
    if isinstance(found, np.ndarray):
        found = found.tolist()
    assert found == expected and type(found) is type(expected)


@pytest.mark.parametrize(
    ("kind", "sent", "error"),
    [
        (kinds.I32, 2.7, r"v: expected an integer \(i32\), got 2.7"),
        (kinds.I32, "x", "got 'x'"),
        (kinds.I32, [3], "got a list"),
        (kinds.I8, 300, "v: 300 does not fit in i8"),
        (kinds.SIZE, -1, "does not fit in size_t"),
        (kinds.SIZE, Vocab("a"), r"\[a\]"),
        (kinds.TEXT, 5, "v: expected a string, got 5"),
        (kinds.BINARY, 5, "v: expected a blob, got 5"),
        (kinds.BOOL, "true", "v: expected true or false, got 'true'"),
        (kinds.VOCAB, "large", "a word of four bytes"),
        (kinds.VOCAB, 5, "v: expected a word, got 5"),
        (kinds.DOUBLE, b"x", "v: expected a number, got a blob"),
        (ListOf(kinds.I32), 5, "v: expected a list, got 5"),
        (ListOf(kinds.I32), [1, "x"], r"v\[1\]: expected an integer"),
        (MapOf(kinds.I32, kinds.I32), [1], r"v\[0\]: expected a pair"),
        (MapOf(kinds.I32, kinds.I32), 5, "v: expected a list of pairs"),
        (External("yarp::sig::Vector", 1, "yarpy.Vector"), 5, "v: expected yarp::sig::Vector"),
    ],
)
def test_what_they_may_not(kind: Kind, sent: Any, error: str) -> None:
    with pytest.raises(DecodeError, match=error):
        read(kind, sent)


def test_enums_by_number_and_name(capt: ModuleType) -> None:
    assert read(capt.Color, 2) is capt.Color.GREEN
    assert read(capt.Color, "GREEN") is capt.Color.GREEN
    assert read(capt.Color, 99) == 99
    with pytest.raises(DecodeError, match="Color is one of RED, GREEN, DARK_BLUE, not 'GREENx'"):
        read(capt.Color, "GREENx")
    with pytest.raises(DecodeError, match=r"expected a Color, got 1\.5"):
        read(capt.Color, 1.5)


def test_structs_in_lists_have_their_length(capt: ModuleType) -> None:
    assert read(ListOf(capt.Point), [[1, 2], [3, 4]]) == [capt.Point(1, 2), capt.Point(3, 4)]
    with pytest.raises(DecodeError, match=r"v\[1\]: Point has 2 elements, here are 1"):
        read(ListOf(capt.Point), [[1, 2], [3]])
    with pytest.raises(DecodeError, match=r"v\[0\]: expected a list for Point, got 1"):
        read(ListOf(capt.Point), [1, 2])


def test_types_that_read_themselves() -> None:
    assert read(External("yarp::sig::Vector", 1, "yarpy.Vector"), [1.0]) == Vector([1.0])
    assert read(External("a::B"), [1, "a", [2]]) == Bottle([1, "a", [2]])
    assert read(External("a::B"), "x") == "x"
    assert read(External("a::B", 2), 1, "x") == Bottle([1, "x"])


def test_counts_are_checked_before_memory_is_taken() -> None:
    for kind in (ListOf(kinds.I32), ListOf(kinds.TEXT), SetOf(kinds.I32), External("a::B")):
        for code in (256, 257, 260):
            data = b"".join(number.to_bytes(4, "little") for number in (code, 0x7FFFFFFF, 1, 1))
            with pytest.raises(DecodeError):
                get(kind, Cursor(data), "v")
    with pytest.raises(Truncated):
        get(ListOf(kinds.I32), Cursor(b"\1\1\0\0\xff\xff\xff\xff"), "v")


def test_elements_are_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_MAX_ELEMENTS", "10")
    with pytest.raises(DecodeError, match="more than 10 elements"):
        read(ListOf(kinds.TEXT), ["a"] * 11)


@settings(max_examples=300)
@given(st.binary(max_size=80))
def test_rubbish_is_refused(capt: ModuleType, data: bytes) -> None:
    for cls in (capt.Nest, capt.Sets, capt.Anno, capt.Prims, capt.Maps, capt.Lists):
        for head in (b"", b"\0\1\0\0" + bytes([cls._flat(), 0, 0, 0])):
            try:
                cls.from_wire(head + data)
            except DecodeError:
                continue
