"""The monitor `bayer`: parameters, pictures of known colours, a camera over a port."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pytest
from support.monitor import place, received
from support.wait import HANG

import yarpy
from yarpy import Image, LocalProtocolError
from yarpy.errors import DecodeError
from yarpy.monitors.imaging import demosaic
from yarpy.monitors.imaging.homogeneity import ahd
from yarpy.monitors.stock.bayer import Bayer

try:
    import cv2
except ImportError:
    OPENCV = 0
else:
    OPENCV = int(cv2.__version__.partition(".")[0])

# The least peak signal-to-noise ratio in dB, a little below what came out.
METHODS = {
    "nearest": 23,
    "simple": 24,
    "bilinear": 35,
    "hqlinear": 38,
    "downsample": 28,
    "ahd": 39,
    "vng": 38 if OPENCV > 4 else 20,  # that of OpenCV 4 is worse where dark meets light
    "edgesense": 35,
}


def colourful(height: int, width: int) -> Any:
    """Light and shade in detail, soft colours, a few edges: as in photographs."""
    y, x = np.mgrid[0:height, 0:width]
    light = 0.6 + 0.25 * np.sin(x * (40 + y) / 160) + 0.1 * np.cos(y / 3)
    tint = np.stack([np.sin(x / 25), np.cos(y / 21), np.sin((x + y) / 31)], axis=-1)
    picture = light[..., None] * (150 + 40 * tint)
    picture[height // 3 : height // 2, width // 4 : width // 2] *= (1.2, 0.4, 0.5)
    return np.clip(picture, 0, 255).astype(np.uint8)


def mosaic(picture: Any, order: str = "grbg") -> Any:
    """What a Bayer camera sees of a picture."""
    grey = np.empty(picture.shape[:2], np.uint8)
    for index, letter in enumerate(order):
        row, column = divmod(index, 2)
        here = slice(row, None, 2), slice(column, None, 2)
        grey[here] = picture[(*here, "rgb".index(letter))]
    return grey


def rebuilt(grey: Any, tokens: str = "", code: str = "mono") -> Any:
    """The array of what the reader gets."""
    data = b"".join(Image(grey, code).to_wire())
    message = received(Bayer, data, tokens)
    assert message.envelope == "7 0.5"
    assert (str(message.value.code), message.value.quantum) == ("rgb", 1)
    return message.value.array


def psnr(one: Any, other: Any) -> float:
    """Peak signal-to-noise ratio in dB."""
    error = np.mean((one.astype(float) - other) ** 2)
    return float(10 * np.log10(255**2 / error))


@pytest.mark.parametrize("order", ["grbg", "gbrg", "rggb", "bggr"])
@pytest.mark.parametrize("method", METHODS)
def test_known_colours_come_back(method: str, order: str) -> None:
    picture = colourful(96, 128)
    made = rebuilt(mosaic(picture, order), f"method.{method}+order.{order}")
    if method == "downsample":
        picture = picture.reshape(48, 2, 64, 2, 3).mean(axis=(1, 3))
    inside = slice(3, -3)
    assert psnr(made[inside, inside], picture[inside, inside]) > METHODS[method]


@pytest.mark.parametrize("width", [7, 9, 102, 127])
def test_other_widths(width: int) -> None:
    picture = colourful(60, width)
    for method in METHODS:
        made = rebuilt(mosaic(picture), f"method.{method}")
        if method != "downsample":
            assert (made == demosaic.averaged(mosaic(picture), 0, 0)).all()
            assert psnr(made, picture) > 25


@pytest.mark.parametrize(
    ("tokens", "width", "make"),
    [
        ("", 32, demosaic.bilinear),
        ("size.half", 32, demosaic.downsample),
        ("size.half", 30, demosaic.halved),
        ("size.half+method.ahd", 32, demosaic.downsample),
        ("size.full+method.ahd", 32, ahd),
        ("method.downsample", 30, demosaic.halved),
        ("method.ahd+method.simple", 32, ahd),  # the first counts
        ("size.other+size.half", 32, demosaic.bilinear),
    ],
)
def test_parameters(tokens: str, width: int, make: Any) -> None:
    grey = mosaic(colourful(20, width))
    assert (rebuilt(grey, tokens) == make(grey, 0, 0)).all()


@pytest.mark.parametrize("method", ["vng", "edgesense"])
def test_opencv_takes_small_pictures_too(method: str) -> None:
    for height in range(9):
        made = rebuilt(np.full((height, 8), 100, np.uint8), f"method.{method}")
        assert made.shape == (height, 8, 3)


def test_vng_has_the_black_frame_of_cpp() -> None:
    made = rebuilt(mosaic(colourful(20, 32)), "method.vng")
    assert not made[:2].any() and not made[-2:].any()
    assert not made[:, :2].any() and not made[:, -2:].any()
    assert made[2:-2, 2:-2].any(axis=-1).all()


def test_pixel_code_tells_the_order_unless_one_is_given() -> None:
    grey = mosaic(colourful(20, 32), "rggb")
    right = demosaic.bilinear(grey, *demosaic.pattern("rggb"))
    assert (rebuilt(grey, code="rggb") == right).all()
    assert (rebuilt(grey, "order.rggb", code="mono") == right).all()
    assert (rebuilt(grey, "order.RGgb", code="bggr") == right).all()
    assert not (rebuilt(grey, code="mono") == right).all()


def test_grey_of_a_colour_picture_is_taken_as_cpp_takes_it() -> None:
    grey = mosaic(colourful(20, 32))
    colour = np.repeat(grey[..., None], 3, axis=2)
    assert (rebuilt(colour, code="rgb") == demosaic.bilinear(grey, 0, 0)).all()


@pytest.mark.parametrize(
    ("tokens", "text"),
    [
        ("method.best", "one of nearest, simple, bilinear, hqlinear, downsample, ahd, vng, edge"),
        ("order.xy", "grbg, gbrg, rggb or bggr"),
    ],
)
def test_wrong_parameters_refuse_the_connection(tokens: str, text: str) -> None:
    with pytest.raises(LocalProtocolError, match=text):
        Bayer(place(tokens))


def test_only_at_the_receiving_end() -> None:
    with pytest.raises(LocalProtocolError, match=r"tcp\+recv\.bayer"):
        Bayer(place(sending=True))


def test_without_opencv_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cv2", None)
    with pytest.raises(LocalProtocolError, match=r'"vng" of bayer.*pip install "yarpy\[vision\]"'):
        Bayer(place("method.vng"))
    Bayer(place("method.ahd"))


@pytest.mark.parametrize(
    "value", [b"", yarpy.Bottle(["no", "image"]).to_bytes(), Image(np.zeros((4, 8), "u2"), "gr16")]
)
def test_what_is_no_grey_picture_is_refused(value: Any) -> None:
    data = value if isinstance(value, bytes) else b"".join(value.to_wire())
    with pytest.raises(DecodeError):
        received(Bayer, data)


@pytest.mark.parametrize("carrier", ["tcp", "udp", "unix_stream"])
def test_camera_over_a_port(carrier: str) -> None:
    names = yarpy.LocalNames()
    picture = colourful(48, 64)
    with (
        yarpy.Port("/camera", names=names) as camera,
        yarpy.BufferedPort("/reader", names=names) as reader,
    ):
        camera.connect("/reader", f"{carrier}+recv.bayer+order.rggb+method.hqlinear")
        camera.write(mosaic(picture, "rggb"), yarpy.Stamp(3, 0.5))
        message = reader.read(timeout=HANG)
        assert message is not None
        assert message.stamp == yarpy.Stamp(3, 0.5)
        image = message.as_(Image)
        assert (str(image.code), image.array.shape) == ("rgb", (48, 64, 3))
        assert psnr(image.array[2:-2, 2:-2], picture[2:-2, 2:-2]) > 35
