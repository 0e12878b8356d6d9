"""depthimage_to_rgb: the heat map of C++."""

from __future__ import annotations

import numpy as np
import pytest
from support.monitor import sent

from yarpy import Image
from yarpy.errors import DecodeError
from yarpy.monitors.stock.depthimage_to_rgb import DepthImageToRgb

# metres, and the colour at this part of 9.8 m: blue, green, yellow, red, black
SHADES = [
    (0.2, (0, 20, 234)),
    (9.8 / 4, (0, 255, 0)),
    (9.8 / 8, (0, 127, 127)),
    (9.8 / 2, (255, 255, 0)),
    (9.8 * 3 / 4, (255, 0, 0)),
    (9.8, (0, 0, 0)),
    (10.0, (0, 0, 0)),
    (10.1, (0, 0, 0)),
    (0.1, (0, 0, 0)),
    (float("nan"), (0, 0, 0)),
    (float("inf"), (0, 0, 0)),
]


@pytest.mark.parametrize(("metres", "colour"), SHADES)
def test_colours(metres: float, colour: tuple[int, int, int]) -> None:
    made = Image.from_wire(sent(DepthImageToRgb, Image(np.full((2, 3), metres, "f4"))))
    assert str(made.code) == "rgb"
    found = made.array.astype(int)
    assert np.abs(found - colour).max() <= 1
    assert (found == found[0, 0]).all()


def test_other_pixels() -> None:
    with pytest.raises(DecodeError):
        sent(DepthImageToRgb, np.zeros((2, 2), "u1"))
