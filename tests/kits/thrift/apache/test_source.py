"""What a message may hold."""

import pytest

from yarpy.errors import DecodeError, Truncated
from yarpy.kits.thrift.apache.source import Source
from yarpy.limit import THRIFT_ITEMS, THRIFT_LEVELS


def test_bytes_are_taken_in_their_order() -> None:
    source = Source(b"abcd", 1)
    assert bytes(source.take(2)) == b"bc" and source.left == 1
    with pytest.raises(Truncated, match="2 bytes are announced, and 1 are left"):
        source.take(2)
    with pytest.raises(DecodeError, match="a length of -1 bytes"):
        source.take(-1)


def test_counts_are_held_against_what_is_there() -> None:
    source = Source(bytes(8))
    assert source.count(2, 4) == 2
    with pytest.raises(Truncated, match="3 elements are announced"):
        source.count(3, 4)
    with pytest.raises(DecodeError, match="-1 elements"):
        source.count(-1, 1)


def test_levels_and_items_have_limits() -> None:
    source = Source(b"")
    for _ in range(THRIFT_LEVELS):
        source.enter()
    with pytest.raises(DecodeError, match=f"more than {THRIFT_LEVELS} deep"):
        source.enter()
    source.spend(THRIFT_ITEMS)
    with pytest.raises(DecodeError, match=f"more than {THRIFT_ITEMS} values"):
        source.spend(1)
