"""image_compression_png: images there and back without loss; what is refused."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pytest
from support.monitor import place, received, sent, through

from yarpy import Bottle, Image, LocalProtocolError
from yarpy.errors import DecodeError
from yarpy.monitors.stock.image_compression_png import ImageCompressionPng as Png


@pytest.mark.parametrize("code", ["mono", "rgb", "bgra", "mo16", "rggb"])
def test_there_and_back(code: str) -> None:
    shape, type_ = {
        "rgb": ((6, 9, 3), "u1"),
        "bgra": ((6, 9, 4), "u1"),
        "mo16": ((6, 9), "u2"),
    }.get(code, ((6, 9), "u1"))
    image = Image((np.arange(np.prod(shape)).reshape(shape) * 777).astype(type_), code)
    message = through(Png, image)
    assert message.value == image
    assert message.envelope == "7 0.5"


def test_wire_form() -> None:
    name, code, data = Bottle.from_bytes(sent(Png, np.zeros((4, 4), "u1")))
    assert (name, code, data[:4]) == ("png", "mono", b"\x89PNG")


@pytest.mark.parametrize("value", [np.zeros((4, 4), "f4"), ["hi"], "text"])
def test_other_pixels_are_refused_by_the_sender(value: Any) -> None:
    with pytest.raises(DecodeError):
        sent(Png, value)


@pytest.mark.parametrize("values", [[], ["png", "rgb"], ["png", "dec", b"x"], ["png", "rgb", b"x"]])
def test_what_was_not_compressed(values: list[object]) -> None:
    with pytest.raises(DecodeError):
        received(Png, Bottle(values).to_bytes())


def test_limit_of_the_port() -> None:
    data = sent(Png, np.zeros((500, 500), "u1"))
    with pytest.raises(DecodeError, match="the limit is 10000"):
        received(Png, data, limit=10_000)


def test_without_opencv_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cv2", None)
    with pytest.raises(LocalProtocolError, match=r"yarpy\[vision\]"):
        Png(place(sending=True))
