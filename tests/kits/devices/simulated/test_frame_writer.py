"""A screen without hardware."""

import numpy as np
import pytest

import yarpy
from yarpy.kits.devices.simulated.frame_writer import SimulatedFrameWriter


def picture(width: int, height: int) -> yarpy.Image:
    return yarpy.Image(np.zeros((height, width, 3), "u1"))


def test_the_first_picture_says_how_large_it_is() -> None:
    screen = SimulatedFrameWriter()
    screen.show(picture(4, 2))
    with pytest.raises(ValueError, match="2 x 4 on a screen of"):
        screen.show(picture(2, 4))
    assert screen.size == (4, 2) and screen.count == 1


def test_a_screen_of_one_size_shows_no_other() -> None:
    screen = SimulatedFrameWriter((8, 8))
    with pytest.raises(ValueError, match="4 x 2 on a screen of"):
        screen.show(picture(4, 2))
    with pytest.raises(ValueError, match="0 x 0"):
        SimulatedFrameWriter().show(picture(0, 0))
    assert screen.last is None
