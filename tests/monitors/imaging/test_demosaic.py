"""Demosaicing beside what C++ YARP makes: numbers of its own, checksums of libdc1394's results."""

from __future__ import annotations

import zlib
from typing import Any

import numpy as np
import pytest

from yarpy.monitors.imaging import demosaic

NARROW = np.array(
    [
        [0, 3, 6, 9, 12, 15],
        [125, 128, 131, 134, 137, 140],
        [250, 253, 0, 3, 6, 9],
        [119, 122, 125, 128, 131, 134],
    ],
    np.uint8,
)
WIDE = np.hstack([NARROW, np.array([[18, 21], [143, 146], [12, 15], [137, 140]], np.uint8)])

ORDERS = ("grbg", "gbrg", "rggb", "bggr")

BLACK = (0, 0, 0)
AVERAGED = [
    [(3, 0, 125), (3, 44, 128), (6, 6, 131), (9, 50, 134), (12, 12, 137), (15, 76, 137)],
    [
        *[(128, 126, 125), (128, 128, 128), (67, 67, 131)],
        *[(6, 134, 134), (9, 73, 137), (12, 140, 137)],
    ],
]
BILINEAR = [
    [BLACK] * 8,
    [
        *[BLACK, (128, 128, 128), (67, 67, 131), (6, 134, 134)],
        *[(9, 73, 137), (12, 140, 140), (15, 79, 143), BLACK],
    ],
]
NEAREST = [
    *[(3, 128, 125), (3, 6, 131), (9, 134, 131), (9, 12, 137)],
    *[(15, 140, 137), (15, 18, 143), (21, 146, 143), BLACK],
]
SIMPLE = [
    *[(3, 64, 125), (3, 67, 131), (9, 70, 131), (9, 73, 137)],
    *[(15, 76, 137), (15, 79, 143), (21, 82, 143), BLACK],
]
DOWNSAMPLED = [
    [(3, 64, 125), (9, 70, 131), (15, 76, 137), (21, 82, 143)],
    [(253, 186, 119), (3, 64, 125), (9, 70, 131), (15, 76, 137)],
]
HALVED = [[(3, 64, 125), (9, 70, 131), BLACK], [BLACK] * 3]


@pytest.mark.parametrize(
    ("make", "grey", "expected"),
    [
        (demosaic.averaged, NARROW, AVERAGED),
        (demosaic.halved, NARROW, HALVED),
        (demosaic.bilinear, WIDE, BILINEAR),
        (demosaic.nearest, WIDE, [NEAREST]),
        (demosaic.simple, WIDE, [SIMPLE]),
        (demosaic.downsample, WIDE, DOWNSAMPLED),
    ],
)
def test_numbers_of_cpp(make: Any, grey: Any, expected: Any) -> None:
    made = make(grey, *demosaic.pattern("grbg"))
    assert made.dtype == np.uint8
    np.testing.assert_array_equal(made[: len(expected)], expected)


def noise() -> Any:
    """The picture of which `CHECKSUMS` tell: 27 rows of 40 pixels."""
    index = np.arange(27 * 40, dtype=np.int64).reshape(27, 40)
    made = ((1103515245 * index * index + 12345 * index) >> 7).astype(np.uint8)
    assert zlib.crc32(made.tobytes()) == 1856038733
    return made


# CRC-32 of what the libdc1394 of C++ YARP 3.5 makes of `noise()`, in the four orders.
CHECKSUMS = {
    "nearest": (860903009, 56955956, 2932138744, 2888204081),
    "simple": (2981137843, 2173030374, 2143715751, 2099518574),
    "bilinear": (1530453514, 2215682125, 523029776, 2882383586),
    "hqlinear": (3624512763, 278376976, 2292620205, 498171176),
    "downsample": (3494421563, 2924608904, 447101789, 1875194237),
}


@pytest.mark.parametrize("method", CHECKSUMS)
def test_every_bit_is_that_of_cpp(method: str) -> None:
    for order, expected in zip(ORDERS, CHECKSUMS[method], strict=True):
        made = demosaic.METHODS[method](noise(), *demosaic.pattern(order))
        assert zlib.crc32(made.tobytes()) == expected, order


def test_every_method_is_compared() -> None:
    assert CHECKSUMS.keys() == demosaic.METHODS.keys()


@pytest.mark.parametrize("order", ["grbg", "GRBG", "Gr", "grxx"])
def test_first_two_letters_count(order: str) -> None:
    assert demosaic.pattern(order) == (0, 0)


@pytest.mark.parametrize("order", ["", "g", "gg", "br"])
def test_wrong_order(order: str) -> None:
    with pytest.raises(ValueError, match="grbg, gbrg, rggb or bggr"):
        demosaic.pattern(order)


@pytest.mark.parametrize("make", [demosaic.averaged, demosaic.halved, *demosaic.METHODS.values()])
@pytest.mark.parametrize("shape", [(0, 0), (0, 8), (1, 1), (1, 8), (2, 2), (3, 8), (5, 7)])
def test_small_pictures(make: Any, shape: tuple[int, int]) -> None:
    made = make(np.full(shape, 200, np.uint8), 0, 0)
    halves = make in (demosaic.halved, demosaic.downsample)
    assert made.shape == (*((side // 2 for side in shape) if halves else shape), 3)


def test_odd_widths_lose_no_block_but_the_last() -> None:
    """The width 7: three blocks, of which none touches the last column."""
    made = demosaic.halved(np.full((7, 7), 9, np.uint8), 0, 0)
    assert (made == 9).all()
    made = demosaic.halved(np.full((6, 7), 9, np.uint8), 0, 0)
    assert (made[:2] == 9).all()
    assert (made[2] == 0).all()
