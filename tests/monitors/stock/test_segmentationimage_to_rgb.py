"""segmentationimage_to_rgb: a colour for each label."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.monitor import sent

from yarpy import Image
from yarpy.errors import DecodeError
from yarpy.monitors.stock.segmentationimage_to_rgb import LabelColours


@pytest.mark.parametrize("kind", ["u1", "u2"])
def test_colours(kind: str) -> None:
    labels = np.array([[0, 1, 2, 3, 63, 64, 67]], kind)
    made = Image.from_wire(sent(LabelColours, labels)).array[0].tolist()
    assert made[:4] == [[0, 0, 0], [0, 255, 0], [0, 0, 255], [255, 0, 0]]
    assert made[4] == [0xE8, 0x5E, 0xBE]
    assert made[5:] == [[0, 0, 0], [255, 0, 0]]  # modulo 64


def test_all_colours_differ() -> None:
    made = Image.from_wire(sent(LabelColours, np.arange(64, dtype="u1")[None]))
    assert len({tuple(colour) for colour in made.array[0].tolist()}) == 64


@pytest.mark.parametrize("value", [np.zeros((2, 2, 3), "u1"), np.zeros((2, 2), "f4"), ["hi"]])
def test_other_pixels(value: Any) -> None:
    with pytest.raises(DecodeError):
        sent(LabelColours, value)
