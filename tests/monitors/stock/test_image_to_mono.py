"""image_to_mono: grey of anything that has colours."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.monitor import sent

from yarpy import Image
from yarpy.errors import DecodeError
from yarpy.monitors.stock.image_to_mono import ImageToMono


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (np.array([[[10, 20, 40]]], "u1"), 23),
        (Image(np.array([[[10, 20, 40, 255]]], "u1"), "bgra"), 23),
        (Image(np.array([[[10, 20, 40]]], "f4")), 23),
        (np.array([[7]], "u1"), 7),
        (Image(np.array([[7]], "u1"), "grbg"), 7),
    ],
)
def test_grey(value: Any, expected: int) -> None:
    made = Image.from_wire(sent(ImageToMono, value))
    assert (str(made.code), made.array.tolist()) == ("mono", [[expected]])


@pytest.mark.parametrize("value", [Image(np.zeros((2, 2), "u1"), "yuva"), ["hi"], 5])
def test_what_has_no_colours(value: Any) -> None:
    with pytest.raises(DecodeError):
        sent(ImageToMono, value)
