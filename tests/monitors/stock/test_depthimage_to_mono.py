"""depthimage_to_mono: the numbers of C++."""

from __future__ import annotations

import numpy as np
import pytest
from support.monitor import sent

from yarpy import Image
from yarpy.errors import DecodeError
from yarpy.monitors.stock.depthimage_to_mono import DepthImageToMono

DEPTH = np.array([[0.0, 0.1, 0.2, 1.0, 4.9], [9.8, 10.0, 10.1, np.nan, np.inf]], "f4")
# trunc(255 - v * 255 / 9.8), never below 0; invalid depth is 0
GREY = [[0, 0, 249, 228, 127], [0, 0, 0, 0, 0]]


def test_numbers() -> None:
    made = Image.from_wire(sent(DepthImageToMono, DEPTH_IMAGE))
    assert str(made.code) == "mono"
    assert made.array.tolist() == GREY


DEPTH_IMAGE = Image(DEPTH)


@pytest.mark.parametrize("value", [np.zeros((2, 2), "u1"), ["hi"]])
def test_other_pixels(value: object) -> None:
    with pytest.raises(DecodeError):
        sent(DepthImageToMono, value)
