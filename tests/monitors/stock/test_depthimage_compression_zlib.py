"""depthimage_compression_zlib: there and back, with the rows of C++, damage."""

from __future__ import annotations

import zlib
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.monitor import damaged, received, sent, through

from yarpy import Bottle, Image
from yarpy.errors import DecodeError
from yarpy.monitors.stock.depthimage_compression_zlib import DepthZlib


def depth(height: int, width: int) -> Any:
    return (np.arange(height * width, dtype="f4") / 7).reshape(height, width)


@pytest.mark.parametrize("quantum", [1, 4, 8, 16])
@pytest.mark.parametrize("shape", [(0, 0), (1, 1), (3, 4), (4, 3), (48, 64), (7, 33)])
def test_there_and_back(shape: tuple[int, int], quantum: int) -> None:
    image = Image(depth(*shape), quantum=quantum)
    assert through(DepthZlib, image).value == image
    flipped = Image(depth(*shape), quantum=quantum, top_down=False)
    assert through(DepthZlib, flipped).value == flipped


def test_bytes_of_cpp() -> None:
    """Width, height, compressed and uncompressed size, and the rows as they lie in C++."""
    data = sent(DepthZlib, Image(depth(2, 4)))
    wire, rows = Bottle.from_bytes(data), depth(2, 4).tobytes()
    assert wire[:4] == [4, 2, len(wire[4]), 32]
    assert zlib.decompress(wire[4]) == rows
    assert data == Bottle([*wire[:4], zlib.compress(rows)]).to_bytes()


def test_rows_with_and_without_padding_are_taken() -> None:
    wire = Bottle.from_bytes(sent(DepthZlib, Image(depth(2, 3))))
    assert wire[3] == 32  # two rows of 12 bytes, padded to 16
    packed = zlib.compress(depth(2, 3).tobytes())
    bare = Bottle([3, 2, len(packed), 24, packed])
    assert (received(DepthZlib, bare.to_bytes()).value.array == depth(2, 3)).all()


def test_a_black_image_packs_a_thousandfold_and_passes() -> None:
    black = Image(np.zeros((1080, 1920), "f4"))
    assert 900 * len(sent(DepthZlib, black)) < 1080 * 1920 * 4
    assert through(DepthZlib, black).value == black


def test_limit_of_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    data = sent(DepthZlib, Image(depth(48, 64)))
    monkeypatch.setenv("YARPY_MAX_PICTURE", "10000")
    with pytest.raises(DecodeError, match="the limit is 10000"):
        received(DepthZlib, data)


@given(st.data())
def test_damage_is_a_decode_error(data: st.DataObject) -> None:
    wire = damaged(data, sent(DepthZlib, Image(depth(3, 5))))
    try:
        received(DepthZlib, wire, limit=100_000)
    except DecodeError:
        pass


@pytest.mark.parametrize(
    "values",
    [
        [],
        ["hi"],
        [4, 2, 9, 31, b"data"],
        [-4, -2, 9, 32, b"data"],
        [4, 2, 9, 32, "data"],
        [0, 5, 9, 0, b"data"],
        [2**30, 1, 9, 2**32, b"data"],
    ],
)
def test_what_was_not_compressed(values: list[object]) -> None:
    with pytest.raises(DecodeError):
        received(DepthZlib, Bottle(values).to_bytes())


def test_other_pixels_are_refused_by_the_sender() -> None:
    with pytest.raises(DecodeError, match='pixels dec, got "mono"'):
        sent(DepthZlib, np.zeros((3, 4), "u1"))
