"""Places in a message: what is read there, and what is refused with the name of the field."""

from collections.abc import Callable

import pytest

from yarpy.data.bottle import Bottle
from yarpy.data.value import FLOAT64, INT32, LIST, STRING, Vocab
from yarpy.data.yarp4 import FLOAT64_4
from yarpy.errors import DecodeError, Truncated
from yarpy.kits.thrift.wire.cursor import (
    Cursor,
    bytes_of,
    number_of,
    other_kind,
    pair,
    reads_list,
    skip,
    spread,
)


def words(*numbers: int) -> bytes:
    return b"".join(number.to_bytes(4, "little", signed=True) for number in numbers)


def test_what_is_read_moves_the_cursor() -> None:
    cursor = Cursor(words(INT32, 5, STRING, 3) + b"abc" + words(LIST, 0))
    assert (cursor.tag("v"), number_of(INT32, cursor, "v"), cursor.at) == (INT32, 5, 8)
    assert (cursor.tag("v"), bytes(bytes_of(cursor, "v"))) == (STRING, b"abc")
    assert reads_list(cursor, "v") and cursor.tag("v") == LIST
    assert cursor.count("v", 4) == 0 and cursor.at == cursor.end


def test_the_tags_of_yarp_4_are_those_of_3() -> None:
    data = words(FLOAT64_4, LIST | FLOAT64_4)
    cursor = Cursor(data, yarp4=True)
    assert [cursor.tag("v"), cursor.tag("v")] == [FLOAT64, LIST | FLOAT64]
    assert Cursor(data).tag("v") == FLOAT64_4


def test_what_is_cut_off_names_the_field() -> None:
    reads: tuple[Callable[[Cursor], object], ...] = (
        lambda cursor: cursor.number("hand.x"),
        lambda cursor: cursor.take(4, "hand.x"),
        lambda cursor: cursor.take(-1, "hand.x"),
        lambda cursor: number_of(FLOAT64, cursor, "hand.x"),
    )
    for read in reads:
        with pytest.raises(Truncated, match=r"hand\.x"):
            read(Cursor(b"abc"))
    with pytest.raises(Truncated, match=r"hand\.x: 3 elements are announced, there are 8 bytes"):
        Cursor(words(3, 1, 1)).count("hand.x", 4)


def test_an_element_of_another_kind_is_named() -> None:
    for tag, data, told in (
        (LIST, b"", "a list"),
        (STRING, words(2) + b"hi", "'hi'"),
        (INT32, words(7), "7"),
        (77, b"", "the tag 77"),
    ):
        error = other_kind("a blob", tag, Cursor(data), "v")
        assert str(error) == f"v: expected a blob, got {told}"


def test_an_element_is_skipped_whatever_it_is() -> None:
    items = [1, 2.5, "abc", b"xyz", Vocab("a"), [1, [2, "x"]], [1.0, 2.0], []]
    cursor = Cursor(Bottle([*items, 5]).to_bytes(), 8)
    for _ in items:
        skip(cursor, "v")
    assert bytes(cursor.data[cursor.at :]) == words(INT32, 5)
    with pytest.raises(DecodeError, match="no tag of a Bottle"):
        skip(Cursor(words(77)), "v")


def test_depth_is_limited() -> None:
    with pytest.raises(DecodeError, match="lists within each other"):
        skip(Cursor(b"\0\1\0\0\1\0\0\0" * 200), "v")


def test_spread_gives_each_element_its_tag() -> None:
    for items in (["a", "bc"], [1, 2], [], [b"x", b""], [Vocab("a")]):
        mixed = Bottle([*items, [1]]).to_bytes()
        data = spread(Bottle(items).to_bytes())
        assert bytes(data)[8:] == mixed[8 : len(data)]
    for bad in (b"", b"\0\1\0\0", b"\1\0\0\0\1\0\0\0", b"\7\1\0\0\1\0\0\0\0\0\0\0"):
        with pytest.raises(DecodeError):
            spread(bad)
    with pytest.raises(Truncated):
        pair(b"1234567", 0)
