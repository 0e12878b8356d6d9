"""TBinaryProtocol, by what Apache's library writes."""

import pytest
from support.thrift_module import ROWS, data, head

from yarpy.errors import DecodeError
from yarpy.kits.thrift.apache.binary import BinaryReader, BinaryWriter


@pytest.mark.parametrize("name", ROWS)
def test_heads(name: str) -> None:
    writer = BinaryWriter()
    writer.head(head(name))
    found = data(name, "binary")
    assert found.startswith(writer.out)
    reader = BinaryReader(found)
    assert reader.head() == head(name) and reader.at == len(writer.out)


def test_numbers_there_and_back() -> None:
    writer = BinaryWriter()
    for method, value in (("i8", -7), ("i16", -300), ("i32", 1 << 30), ("i64", -(1 << 62))):
        getattr(writer, method)(value)
    writer.double(-2.5)
    writer.uuid(bytes(range(16)))
    reader = BinaryReader(writer.out)
    assert (reader.i8(), reader.i16(), reader.i32(), reader.i64()) == (
        -7,
        -300,
        1 << 30,
        -(1 << 62),
    )
    assert reader.double() == -2.5
    reader.skip(16)
    assert reader.left == 0


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("00000003616464", "begins with 80 01"),
        ("80010001 00010000", "at most 1000 bytes"),
        ("80010001 ffffffff", "at most 1000 bytes"),
    ],
)
def test_heads_that_are_none(text: str, error: str) -> None:
    with pytest.raises(DecodeError, match=error):
        BinaryReader(bytes.fromhex(text)).head()


def test_a_type_that_nobody_knows() -> None:
    with pytest.raises(DecodeError, match="99 is no type"):
        BinaryReader(bytes(10)).skip(99)


def test_levels_are_counted_while_values_are_left_out() -> None:
    nested = bytes.fromhex("0f00000001") * 100 + bytes.fromhex("0300000000")
    with pytest.raises(DecodeError, match="nested more than"):
        BinaryReader(nested).skip(15)
