"""TCompactProtocol, by what Apache's library writes."""

import numpy as np
import pytest
from support.thrift_module import ROWS, data, head

from yarpy.errors import DecodeError
from yarpy.kits.thrift.apache.compact import CompactReader, CompactWriter


@pytest.mark.parametrize("name", ROWS)
def test_heads(name: str) -> None:
    writer = CompactWriter()
    writer.head(head(name))
    found = data(name, "compact")
    assert found.startswith(writer.out)
    reader = CompactReader(found)
    assert reader.head() == head(name) and reader.at == len(writer.out)


@pytest.mark.parametrize("value", [0, 1, -1, 63, -64, 64, 300, -(1 << 31), (1 << 31) - 1])
def test_integers_there_and_back(value: int) -> None:
    writer = CompactWriter()
    writer.i32(value)
    writer.i64(value << 32)
    reader = CompactReader(writer.out)
    assert (reader.i32(), reader.i64(), reader.left) == (value, value << 32, 0)


def test_numbers_that_do_not_fit() -> None:
    with pytest.raises(OverflowError, match="40000 does not fit in 16 bits"):
        CompactWriter().i16(40000)
    with pytest.raises(DecodeError, match="more than 16 bits"):
        CompactReader(b"\xff\xff\xff\x01").i16()
    with pytest.raises(DecodeError, match="more than ten bytes"):
        CompactReader(b"\xff" * 11).i64()


def test_numbers_of_fields_far_apart_or_falling() -> None:
    writer = CompactWriter()
    writer.begin()
    for number in (1, 16, 32, 5, -1):
        writer.field(3, number)
        writer.i8(number)
    writer.truth_field(False, 7)
    writer.stop()
    reader = CompactReader(writer.out)
    reader.begin()
    for number in (1, 16, 32, 5, -1):
        assert reader.field() == (3, number) and reader.i8() == number
    assert reader.field() == (2, 7) and reader.truth() is False
    assert reader.field() == (0, 0)


def test_arrays() -> None:
    writer = CompactWriter()
    assert writer.numbers(np.array([1.5, 2.0])) and not writer.numbers(np.array([1, 2], "<i4"))
    assert CompactReader(writer.out).array("d", 2).tolist() == [1.5, 2.0]
    # Libraries write a false element as 2, or as 0.
    assert CompactReader(b"\x01\x02\x00").array("?", 3).tolist() == [True, False, False]
    assert CompactReader(b"\x02\x01").array("h", 2).tolist() == [1, -1]


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("8121 00", "begins with 82"),
        ("8222 00", "version 1"),
        ("822101 ff7f", "at most 1000 bytes"),
    ],
)
def test_heads_that_are_none(text: str, error: str) -> None:
    with pytest.raises(DecodeError, match=error):
        CompactReader(bytes.fromhex(text)).head()


def test_a_type_that_nobody_knows() -> None:
    reader = CompactReader(b"\x1e")
    reader.begin()
    with pytest.raises(DecodeError, match="14 is no type"):
        reader.field()
