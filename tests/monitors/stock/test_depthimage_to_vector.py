"""depthimage_to_vector: every pixel, and no padding."""

from __future__ import annotations

import numpy as np
import pytest
from support.monitor import sent

from yarpy import Image
from yarpy.errors import DecodeError
from yarpy.monitors.stock.depthimage_to_vector import DepthImageToVector


@pytest.mark.parametrize("width", [1, 3, 4])
def test_numbers_row_by_row(width: int) -> None:
    depth = np.arange(2 * width, dtype="f4").reshape(2, width) + 0.5
    data = sent(DepthImageToVector, Image(depth))
    assert data[:8] == b"\x0a\x01\0\0" + (2 * width).to_bytes(4, "little")
    assert np.frombuffer(data[8:], "<f8").tolist() == depth.ravel().tolist()


def test_other_pixels() -> None:
    with pytest.raises(DecodeError):
        sent(DepthImageToVector, np.zeros((2, 2), "u1"))
