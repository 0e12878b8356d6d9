"""Compressed data with an announced size: whole, damaged, and bombs."""

from __future__ import annotations

import tracemalloc
import zlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.errors import DecodeError
from yarpy.monitors.stock.zlib_limit import unpacked


@given(st.binary(max_size=2000))
def test_there_and_back(data: bytes) -> None:
    assert unpacked(zlib.compress(data), len(data), 2000) == data


@given(st.binary(min_size=1, max_size=300), st.data())
def test_damage_is_a_decode_error(data: bytes, draw: st.DataObject) -> None:
    packed = bytearray(zlib.compress(data))
    index = draw.draw(st.integers(0, len(packed) - 1))
    packed[index] ^= draw.draw(st.integers(1, 255))
    try:
        assert unpacked(bytes(packed), len(data), 1000) == data
    except DecodeError:
        pass


@pytest.mark.parametrize("cut", range(1, 12))
def test_cut_off(cut: int) -> None:
    packed = zlib.compress(b"data of some length")
    with pytest.raises(DecodeError):
        unpacked(packed[:-cut], 19, 1000)


@pytest.mark.parametrize("size", [0, 18, 20, -1, 1001, 2**31 - 1])
def test_sizes_that_are_not_true(size: int) -> None:
    with pytest.raises(DecodeError):
        unpacked(zlib.compress(b"data of some length"), size, 1000)


@pytest.mark.parametrize(("data", "size"), [("text", 4), (b"", 0), (b"x", "1"), (None, None)])
def test_no_compressed_data(data: object, size: object) -> None:
    with pytest.raises(DecodeError):
        unpacked(data, size, 1000)


@pytest.mark.parametrize(("size", "limit"), [(100, 1000), (1 << 30, 1 << 20), (1 << 20, 1 << 30)])
def test_a_bomb_takes_no_more_memory_than_it_announces(size: int, limit: int) -> None:
    bomb = zlib.compress(bytes(50_000_000))
    tracemalloc.start()
    try:
        with pytest.raises(DecodeError):
            unpacked(bomb, size, limit)
        assert tracemalloc.get_traced_memory()[1] < 4_000_000
    finally:
        tracemalloc.stop()


def test_an_announcement_takes_no_memory() -> None:
    tracemalloc.start()
    try:
        with pytest.raises(DecodeError):
            unpacked(zlib.compress(b"little"), 1 << 29, 1 << 30)
        assert tracemalloc.get_traced_memory()[1] < 1_000_000
    finally:
        tracemalloc.stop()
