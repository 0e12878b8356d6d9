"""image_rotation: turns and flips of every pixel type."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.monitor import place, sent

from yarpy import Image, LocalProtocolError
from yarpy.errors import DecodeError
from yarpy.monitors.stock.image_rotation import ImageRotation

GREY = np.array([[1, 2, 3], [4, 5, 6]], "u1")


@pytest.mark.parametrize(
    ("tokens", "expected"),
    [
        ("", [[4, 1], [5, 2], [6, 3]]),
        ("options_rotate.rotate_cw", [[4, 1], [5, 2], [6, 3]]),
        ("options_rotate.rotate_ccw", [[3, 6], [2, 5], [1, 4]]),
        ("options_rotate.rotate_180", [[6, 5, 4], [3, 2, 1]]),
        ("options_rotate.rotate_none", [[1, 2, 3], [4, 5, 6]]),
        ("options_flip.flip_x", [[4, 5, 6], [1, 2, 3]]),
        ("options_flip.flip_y", [[3, 2, 1], [6, 5, 4]]),
        ("options_flip.flip_xy", [[6, 5, 4], [3, 2, 1]]),
        ("options_rotate.rotate_cw+options_flip.flip_x", [[6, 3], [5, 2], [4, 1]]),
    ],
)
def test_turns_and_flips(tokens: str, expected: Any) -> None:
    made = Image.from_wire(sent(ImageRotation, GREY, tokens))
    assert made.array.tolist() == expected


@pytest.mark.parametrize(
    "array", [np.zeros((2, 3, 3), "u1"), np.zeros((2, 3), "f4"), np.zeros((2, 3, 4), "u1")]
)
def test_pixel_types(array: Any) -> None:
    image = Image(array)
    made = Image.from_wire(sent(ImageRotation, image))
    assert (made.code, made.width, made.height) == (image.code, 2, 3)


@pytest.mark.parametrize("value", [Image(GREY, "rggb"), Image(GREY, "yuva"), ["hi"]])
def test_what_cannot_be_turned(value: Any) -> None:
    with pytest.raises(DecodeError):
        sent(ImageRotation, value)


@pytest.mark.parametrize("tokens", ["options_rotate.left", "options_flip.x"])
def test_wrong_options(tokens: str) -> None:
    with pytest.raises(LocalProtocolError, match=r"options_\w+\" must be one of"):
        ImageRotation(place(tokens))
