"""sound_marker: the edges of C++ YARP 3."""

from __future__ import annotations

import numpy as np
import pytest
from support.monitor import sent

from yarpy import Sound
from yarpy.errors import DecodeError
from yarpy.monitors.stock.sound_marker import SoundMarker


def test_both_edges_of_each_channel() -> None:
    made = Sound.from_wire(sent(SoundMarker, Sound(np.array([[1, 2, 3], [4, 5, 6]]), 8000)))
    assert made.frequency == 8000
    assert made.array.tolist() == [
        [-32000, 2, 3, *[32000] * 5],
        [-32000, 5, 6, *[32000] * 5],
    ]


def test_no_samples() -> None:
    made = Sound.from_wire(sent(SoundMarker, Sound(np.zeros((1, 0), "i2"))))
    assert made.array.tolist() == [[-32000, *[32000] * 4]]


def test_no_sound() -> None:
    with pytest.raises(DecodeError):
        sent(SoundMarker, ["hi"])
