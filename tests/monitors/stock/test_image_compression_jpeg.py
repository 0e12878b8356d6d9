"""image_compression_jpeg: pictures there and back, damage, limits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.monitor import damaged, place, received, sent, through

from yarpy import Bottle, Image, LocalProtocolError
from yarpy.errors import DecodeError
from yarpy.monitors.stock.image_compression_jpeg import ImageCompressionJpeg as Jpeg

CODES = {"mono": 1, "rgb": 3, "bgr": 3, "rgba": 4, "bgra": 4}


def soft(height: int, width: int, channels: int) -> Any:
    y, x = np.mgrid[0:height, 0:width]
    planes = [128 + 100 * np.sin(x / 20 + index) * np.cos(y / 15) for index in range(channels)]
    if channels == 4:
        planes[3] = np.full((height, width), 255)
    return np.stack(planes, axis=-1).astype("u1")[..., 0 if channels == 1 else slice(None)]


@pytest.mark.parametrize("code", CODES)
@pytest.mark.parametrize("shape", [(48, 64), (7, 13), (1, 1)])
def test_there_and_back(code: str, shape: tuple[int, int]) -> None:
    image = Image(soft(*shape, CODES[code]), code)
    message = through(Jpeg, image, "quality.95")
    made = message.as_(Image)
    assert (str(made.code), made.width, made.height) == (code, image.width, image.height)
    assert np.abs(made.array.astype(int) - image.array).max() < 16
    assert message.envelope == "7 0.5"


def test_wire_form() -> None:
    name, code, data = Bottle.from_bytes(sent(Jpeg, soft(48, 64, 3)))
    assert (name, code, data[:2]) == ("jpeg", "rgb", b"\xff\xd8")


def test_quality() -> None:
    sizes = [
        len(sent(Jpeg, soft(48, 64, 3), tokens)) for tokens in ("quality.20", "", "quality.99")
    ]
    assert sizes == sorted(sizes)
    assert Jpeg(place("quality.20", sending=True)).parameters() == {"quality": 20}
    with pytest.raises(LocalProtocolError, match="from 1 to 100"):
        Jpeg(place("quality.101"))


@pytest.mark.parametrize("value", [np.zeros((4, 4), "f4"), np.zeros((4, 4), "u2"), ["hi"], "text"])
def test_pixels_that_are_no_colours_are_refused_by_the_sender(value: Any) -> None:
    with pytest.raises(DecodeError):
        sent(Jpeg, value)


@given(st.data())
def test_damage_is_a_decode_error(data: st.DataObject) -> None:
    wire = damaged(data, sent(Jpeg, soft(8, 8, 3)))
    try:
        received(Jpeg, wire, limit=1 << 20)
    except DecodeError:
        pass


@pytest.mark.parametrize(
    "values", [[], ["jpeg", "rgb"], ["jpeg", "dec", b"x"], ["png", "rgb", b""]]
)
def test_what_was_not_compressed(values: list[object]) -> None:
    with pytest.raises(DecodeError):
        received(Jpeg, Bottle(values).to_bytes())


def test_limit_of_the_port() -> None:
    data = sent(Jpeg, np.zeros((500, 500, 3), "u1"))
    assert len(data) < 10_000
    with pytest.raises(DecodeError, match="the limit is 10000"):
        received(Jpeg, data, limit=10_000)
