"""The method `ahd` beside what C++ YARP makes."""

from __future__ import annotations

import zlib

import numpy as np
import pytest

from yarpy.monitors.imaging.demosaic import averaged, pattern
from yarpy.monitors.imaging.homogeneity import ahd

WIDE = np.array(
    [
        [0, 3, 6, 9, 12, 15, 18, 21],
        [125, 128, 131, 134, 137, 140, 143, 146],
        [250, 253, 0, 3, 6, 9, 12, 15],
        [119, 122, 125, 128, 131, 134, 137, 140],
    ],
    np.uint8,
)
FIRST = [
    *[(3, 0, 125), (3, 44, 128), (6, 6, 131), (9, 50, 134)],
    *[(12, 12, 137), (15, 56, 140), (18, 18, 143), (21, 82, 143)],
]


def test_numbers_of_cpp() -> None:
    np.testing.assert_array_equal(ahd(WIDE, *pattern("grbg"))[0], FIRST)


# CRC-32 of what the libdc1394 of C++ YARP 3.5 makes of this picture of 27 rows of 40 pixels.
@pytest.mark.parametrize(
    ("order", "expected"),
    [("grbg", 3833207418), ("gbrg", 1350320321), ("rggb", 1075426396), ("bggr", 273312890)],
)
def test_every_bit_is_that_of_cpp(order: str, expected: int) -> None:
    index = np.arange(27 * 40, dtype=np.int64).reshape(27, 40)
    noise = ((1103515245 * index * index + 12345 * index) >> 7).astype(np.uint8)
    assert zlib.crc32(ahd(noise, *pattern(order)).tobytes()) == expected


@pytest.mark.parametrize("shape", [(0, 8), (1, 8), (6, 8), (7, 8), (7, 7)])
def test_small_pictures(shape: tuple[int, int]) -> None:
    grey = np.arange(shape[0] * shape[1], dtype=np.uint8).reshape(shape)
    made = ahd(grey, 0, 0)
    assert made.shape == (*shape, 3)
    framed = averaged(grey, 0, 0)
    framed[3:-3, 3:-3] = made[3:-3, 3:-3]
    np.testing.assert_array_equal(made, framed)


def test_colours_do_not_mix_across_an_edge() -> None:
    """A red and a blue half, in an order whose pixels at the edge bilinear gets wrong."""
    grey = np.zeros((16, 16), np.uint8)
    grey[0::2, :8][:, 1::2] = 200  # red pixels of grbg
    grey[1::2, 8:][:, 0::2] = 200  # blue pixels
    made = ahd(grey, 0, 0).astype(int)
    assert (made[4:12, 3:6] == (200, 0, 0)).all()
    assert (made[4:12, 10:13] == (0, 0, 200)).all()
