"""PNG files: every pixel type there and back, damage, limits."""

from __future__ import annotations

import zlib
from typing import Any

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.monitor import damaged

from yarpy.data.sig import png
from yarpy.data.sig.image import Image
from yarpy.data.sig.pixel import pixel_of
from yarpy.errors import DecodeError

LIMIT = 1 << 20


def sample(code: str, height: int = 5, width: int = 7) -> Image:
    kind = pixel_of(code)
    shape = (height, width, kind.channels) if kind.channels > 1 else (height, width)
    return Image((np.arange(np.prod(shape)).reshape(shape) * 1237).astype(kind.dtype), code)


@pytest.mark.parametrize("code", png.CODES)
@pytest.mark.parametrize("shape", [(1, 1), (5, 7), (48, 64)])
def test_there_and_back(code: str, shape: tuple[int, int]) -> None:
    image = sample(code, *shape)
    assert png.decode(cv2, png.encode(cv2, image), code, LIMIT) == image


def test_colours_are_those_of_the_picture() -> None:
    """Whoever opens the file sees red where red was."""
    red = np.zeros((2, 2, 3), "u1")
    red[..., 0] = 255
    seen = cv2.imdecode(np.frombuffer(png.encode(cv2, Image(red)), "u1"), cv2.IMREAD_COLOR)
    assert seen[0, 0].tolist() == [0, 0, 255]  # blue, green, red


def test_no_pixels() -> None:
    with pytest.raises(ValueError, match="without pixels"):
        png.encode(cv2, Image(np.zeros((0, 4), "u1")))


@given(st.data())
def test_damage_is_a_decode_error(data: st.DataObject) -> None:
    file = damaged(data, png.encode(cv2, sample("rgb")))
    whole = sample("rgb")
    try:
        assert png.decode(cv2, file, "rgb", LIMIT) == whole
    except DecodeError:
        pass


@pytest.mark.parametrize("size", [0, 7, 8, 30, 33, 60, -1, -5, -12])
def test_cut_off(size: int) -> None:
    with pytest.raises(DecodeError):
        png.decode(cv2, png.encode(cv2, sample("rgb"))[:size], "rgb", LIMIT)


def test_damaged_pixels_with_a_right_checksum(capfd: pytest.CaptureFixture[str]) -> None:
    file = png.encode(cv2, sample("mono", 40, 40))
    at = file.index(b"IDAT") - 4
    size = int.from_bytes(file[at : at + 4], "big")
    body = b"IDAT" + bytes(size)
    forged = file[: at + 4] + body + zlib.crc32(body).to_bytes(4, "big") + file[at + 12 + size :]
    try:  # libpng may show what it has
        assert png.decode(cv2, forged, "mono", LIMIT).width == 40
    except DecodeError:
        pass


def huge(width: int, height: int) -> bytes:
    body = b"IHDR" + width.to_bytes(4, "big") + height.to_bytes(4, "big") + b"\x08\0\0\0\0"
    chunk = b"\0\0\0\x0d" + body + zlib.crc32(body).to_bytes(4, "big")
    return b"\x89PNG\r\n\x1a\n" + chunk + b"\0\0\0\0IEND\xae\x42\x60\x82"


@pytest.mark.parametrize("side", [1000, 65536, 2**31 - 1])
def test_size_is_looked_at_before_memory_is_taken(side: int) -> None:
    with pytest.raises(DecodeError, match="the limit is"):
        png.decode(cv2, huge(side, side), "mono", LIMIT)


@pytest.mark.parametrize(("made", "wanted"), [("rgb", "mono"), ("mono", "rgb"), ("mo16", "mono")])
def test_another_pixel_type_than_announced(made: str, wanted: Any) -> None:
    with pytest.raises(DecodeError, match=f"not a PNG of pixels {wanted}"):
        png.decode(cv2, png.encode(cv2, sample(made)), wanted, LIMIT)
