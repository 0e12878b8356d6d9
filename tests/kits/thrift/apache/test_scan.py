"""The end of a message without a length."""

import pytest
from support.thrift_module import ROWS, SPELLINGS, data

from yarpy.errors import DecodeError
from yarpy.kits.thrift.apache.scan import Scan


@pytest.mark.parametrize("spelling", SPELLINGS)
@pytest.mark.parametrize("name", ROWS)
def test_every_message_ends_where_it_does(name: str, spelling: str) -> None:
    found = data(name, spelling)
    scan = Scan(spelling)
    assert scan.advance(found + b"more") == len(found) and scan.done


@pytest.mark.parametrize("spelling", SPELLINGS)
@pytest.mark.parametrize("name", ROWS)
def test_byte_by_byte(name: str, spelling: str) -> None:
    found = data(name, spelling)
    scan, here = Scan(spelling), 0
    while not scan.done:
        need = scan.advance(found[:here])
        assert need <= len(found) and (scan.done or need > here)
        here += not scan.done
    assert here == len(found)


@pytest.mark.parametrize(
    ("spelling", "text", "error"),
    [
        ("binary", "80010001 00000fff", "at most 1000 bytes"),
        ("binary", "80010001 00000001 61 00000001 63 0001", "99 is no type"),
        ("binary", "80010001 00000001 61 00000001 0b0001 ffffffff", "-1 bytes"),
        ("binary", "80010001 00000001 61 00000001 0f0001 0c fffffff0", "-2 elements"),
        ("binary", "80010001 00000001 61 00000001 0f0001 08 fffffff0", "bytes"),
        ("binary", "80010001 00000001 61 00000001 0f0001 00 00000002", "of no type"),
        ("binary", "80010001 00000001 61 00000001" + "0c0001" * 70, "nested more than"),
        ("compact", "8221 01 ff7f", "at most 1000 bytes"),
        ("compact", "8221 01 01 61 1e", "14 is no type"),
        ("compact", "8221 01 01 61 15 ffffffffffffffffffff", "more than ten bytes"),
        ("compact", "8221 01 01 61" + "1c" * 70, "nested more than"),
    ],
)
def test_what_is_no_message(spelling: str, text: str, error: str) -> None:
    with pytest.raises(DecodeError, match=error):
        Scan(spelling).advance(bytes.fromhex(text))


def test_a_long_list_is_passed_over_at_once() -> None:
    start = bytes.fromhex("80010001 00000001 61 00000001 0f0001 04 00100000")
    scan = Scan("binary")
    assert scan.advance(start) == len(start) + (8 << 20) and not scan.done
