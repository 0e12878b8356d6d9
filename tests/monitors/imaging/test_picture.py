"""The image in a message."""

from __future__ import annotations

import numpy as np
import pytest

from yarpy import Bottle, Image
from yarpy.errors import DecodeError
from yarpy.monitors.imaging.picture import picture
from yarpy.wire.message import DATA, Message, Packet


def test_pixel_types_that_fit() -> None:
    image = Image(np.zeros((2, 3), "f4"))
    assert picture(Message.of(Packet(image)), "mono", "dec") is image
    assert picture(Message.of(Packet(np.zeros((2, 3), "u1"))), "mono").width == 3


@pytest.mark.parametrize("value", [Image(np.zeros((2, 3), "u1")), Bottle(["no image"]), 7, None])
def test_what_does_not_fit(value: object) -> None:
    with pytest.raises(DecodeError):
        picture(Message.of(Packet(value)), "dec")
    with pytest.raises(DecodeError):
        picture(Message(DATA, b"".join(Packet(value).blocks)), "dec")


def test_both_types_are_named() -> None:
    with pytest.raises(DecodeError, match='pixels mono or mo16, got "dec"'):
        picture(Message.of(Packet(Image(np.zeros((1, 1), "f4")))), "mono", "mo16")
