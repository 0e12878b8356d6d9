"""Pictures that programs paint."""

import numpy as np
import pytest

from yarpy.kits.sim.render.picture import Picture

WHITE, RED = (1.0, 1.0, 1.0), (1.0, 0.0, 0.0)


def test_rectangles_and_texels():
    picture = Picture(2.0, 1.0, WHITE, density=10)
    picture.rectangle(0.5, 0.2, 1.0, 0.4, RED)
    texels = picture.texels()
    assert texels.shape == (10, 20)
    assert texels.dtype == np.uint32
    red = texels == 0x0000FF
    assert red[2:4, 5:10].all()
    assert red.sum() == 10
    assert (texels[~red] == 0xFFFFFF).all()


def test_checker():
    picture = Picture(1.0, 1.0, WHITE, density=4)
    picture.checker(0.5, RED)
    assert (picture.texels() == 0xFF).tolist() == [
        [False, False, True, True],
        [False, False, True, True],
        [True, True, False, False],
        [True, True, False, False],
    ]


def test_frame():
    picture = Picture(1.0, 1.0, WHITE, density=10)
    picture.frame(0.1, RED)
    red = picture.texels() == 0xFF
    assert red.sum() == 36
    assert not red[1:-1, 1:-1].any()


def test_light():
    picture = Picture(1.0, 1.0, WHITE, density=10)
    picture.gradient(0.5, 1.0)
    assert picture.array[0, 0, 0] == 0.5
    assert picture.array[-1, 0, 0] == 1.0
    picture = Picture(1.0, 1.0, WHITE, density=100)
    picture.shade(0.0, 0.0, 0.2, 1.0, 0.5, 0.4)
    row = picture.array[50, :, 0]
    assert row[10] == pytest.approx(0.5)
    assert row[90] == 1.0
    assert (np.diff(row) >= 0).all()


def test_grain_is_the_same_each_time():
    one, other = (Picture(1.0, 1.0, (0.5, 0.5, 0.5)) for _ in range(2))
    one.grain(0.02, 8)
    other.grain(0.02, 8)
    assert (one.array == other.array).all()
    assert 0.005 < one.array.std() < 0.05


def test_window_shows_sky_above_hills():
    picture = Picture(1.0, 1.0, (0.5, 0.5, 0.5), density=100)
    picture.window(0.2, 0.2, 0.8, 0.8)
    red, green, blue = picture.array[75, 30]
    assert blue > green > red
    red, green, blue = picture.array[22, 30]
    assert green > blue
