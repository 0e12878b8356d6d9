"""Textures of surfaces in a frame."""

import numpy as np
import pytest

from yarpy.kits.sim.render.lens import Box
from yarpy.kits.sim.render.texture_mapper import TextureMapper

WIDTH, HEIGHT = 64, 48
TEXTURES = [np.arange(12, dtype="u4").reshape(3, 4) + 100 * n for n in (1, 2)]


@pytest.fixture
def mapper() -> TextureMapper:
    return TextureMapper(TEXTURES, WIDTH, HEIGHT)


def flat(scale: float) -> np.ndarray:
    """One texel for `scale` pixels, from the corner of the picture."""
    return np.array([[1 / scale, 0, 0], [0, 1 / scale, 0], [0, 0, 1]], "f4")


def spans(left: int, right: int, top: int, bottom: int) -> tuple[np.ndarray, np.ndarray]:
    first, last = np.zeros((2, HEIGHT), "i2")
    first[top:bottom], last[top:bottom] = left, right
    return first, last


def test_filling(mapper: TextureMapper):
    frame = np.zeros((HEIGHT, WIDTH), "u4")
    left, right = spans(2, 30, 1, 20)
    mapper.fill(frame, 1, flat(8), left, right, Box(2, 1, 30, 20))
    expected = np.repeat(np.repeat(TEXTURES[1], 8, 0), 8, 1)
    assert (frame[1:20, 2:30] == expected[1:20, 2:30]).all()
    assert frame.astype(bool).sum() == 19 * 28


def test_only_the_spans_are_filled(mapper: TextureMapper):
    frame = np.zeros((HEIGHT, WIDTH), "u4")
    left, right = spans(0, 32, 0, 24)
    right[:24] = np.arange(24)
    mapper.fill(frame, 0, flat(8), left, right, Box(0, 0, 24, 24))
    assert (frame[:24].astype(bool).sum(1) == np.arange(24)).all()


def test_large_picture():
    width, height = 640, 480
    texture = np.arange(width * height // 16, dtype="u4").reshape(height // 4, width // 4)
    frame = np.zeros((height, width), "u4")
    left, right = np.zeros(height, "i2"), np.full(height, width, "i2")
    box = Box(0, 0, width, height)
    TextureMapper([texture], width, height).fill(frame, 0, flat(4), left, right, box)
    assert (frame == np.repeat(np.repeat(texture, 4, 0), 4, 1)).all()


def test_perspective(mapper: TextureMapper):
    """Texels become smaller towards the right, as the matrix says."""
    matrix = np.array([[0.1, 0, 0], [0, 0.1, 0], [0.02, 0, 1]], "f4")
    frame = np.zeros((HEIGHT, WIDTH), "u4")
    left, right = spans(0, WIDTH, 0, 1)
    mapper.fill(frame, 0, matrix, left, right, Box(0, 0, WIDTH, 1))
    x = np.arange(WIDTH)
    assert (frame[0] == TEXTURES[0][0, (0.1 * x / (0.02 * x + 1)).astype(int)]).all()
    places = mapper.places(matrix, Box(10, 5, 12, 7))
    assert places[:, 1, 1] == pytest.approx((1.1 / 1.22, 0.6 / 1.22, 1.22))


def test_sprinkling_is_the_same_as_filling(mapper: TextureMapper):
    one, other = np.zeros((2, HEIGHT, WIDTH), "u4")
    lefts, rights = (
        np.stack(part) for part in zip(spans(2, 30, 1, 20), spans(20, 25, 0, 24), strict=True)
    )
    matrices = np.stack([flat(8), np.array([[0.1, 0, 0], [0, 0.1, 0], [0.02, 0, 1]], "f4")])
    mapper.sprinkle(one, np.array([1, 0]), matrices, lefts, rights)
    mapper.fill(other, 1, matrices[0], lefts[0], rights[0], Box(2, 1, 30, 20))
    mapper.fill(other, 0, matrices[1], lefts[1], rights[1], Box(20, 0, 25, 24))
    assert (one == other).all()
    assert one.astype(bool).sum() > 500


def test_nothing_to_sprinkle(mapper: TextureMapper):
    frame = np.zeros((HEIGHT, WIDTH), "u4")
    none = np.zeros((1, HEIGHT), "i2")
    mapper.sprinkle(frame, np.array([0]), flat(8)[None], none, none)
    assert not frame.any()
