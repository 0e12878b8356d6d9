"""Picture files of C++ recordings."""

import zlib

import numpy as np
import pytest

import yarpy
from yarpy.data.sig import jpeg
from yarpy.errors import DecodeError
from yarpy.kits.record.dumper.part import SHAPE
from yarpy.kits.record.dumper.picture import read_picture

PPM = b"P6\n2 1\n255\n\1\2\3\4\5\6"


def test_the_bytes_say_what_it_is() -> None:
    for name in ("x.ppm", "x.png", "x.jpg"):
        assert read_picture(PPM, name, "rgb").array.tolist() == [[[1, 2, 3], [4, 5, 6]]]
    assert read_picture(b"P5\n# made by hand\n2 1\n255\n\1\2", "x", "").array.tolist() == [[1, 2]]
    wire = jpeg.encode(yarpy.Image(np.full((8, 8, 3), 100, "u1")))
    assert read_picture(wire, "x.ppm", "rgb").array.shape == (8, 8, 3)


def test_pixels_get_the_code_of_the_log() -> None:
    assert read_picture(PPM, "x", "bgr").array[0, 0].tolist() == [3, 2, 1]
    assert str(read_picture(PPM, "x", "rgba").code) == "rgba"
    assert str(read_picture(PPM, "x", "what").code) == "rgb"
    assert str(read_picture(b"P5\n2 2\n255\n\1\2\3\4", "x", "grbg").code) == "grbg"


def test_png() -> None:
    cv2 = pytest.importorskip("cv2", reason='pictures as PNG: pip install "yarpy[vision]"')
    for array in (
        np.arange(12, dtype="u1").reshape(2, 2, 3),
        np.arange(4, dtype="u1").reshape(2, 2),
    ):
        seen = array[:, :, ::-1] if array.ndim == 3 else array
        data = bytes(cv2.imencode(".png", np.ascontiguousarray(seen))[1])
        assert np.array_equal(read_picture(data, "x.png", "").array, array)


def test_floats_packed_or_not() -> None:
    array = np.arange(6, dtype="<f4").reshape(2, 3)
    head = SHAPE.pack(2, 3)
    for data, name in (
        (head + array.tobytes(), "x.float"),
        (head + zlib.compress(array.tobytes()), "x.floatzip"),
    ):
        assert np.array_equal(read_picture(data, name, "dec").array, array)


@pytest.mark.parametrize(
    ("data", "name"),
    [
        (b"", "x.ppm"),
        (PPM[:-1], "x.ppm"),
        (b"P6\n2 1\n65535\n" + bytes(12), "x.ppm"),
        (b"P6\n999999 999999\n255\n", "x.ppm"),
        (b"\x89PNG\r\n\x1a\n", "x.png"),
        (b"\xff\xd8\xff", "x.jpg"),
        (b"\1\2", "x.float"),
        (SHAPE.pack(2, 3), "x.float"),
        (SHAPE.pack(1 << 60, 1 << 60), "x.float"),
        (SHAPE.pack(1 << 60, 1 << 60), "x.floatzip"),
        (SHAPE.pack(2, 3) + b"no zlib", "x.floatzip"),
        (SHAPE.pack(2, 3) + zlib.compress(b"1234"), "x.floatzip"),
        (b"hello", "x.txt"),
    ],
)
def test_what_is_none(data: bytes, name: str) -> None:
    with pytest.raises(DecodeError):
        read_picture(data, name, "rgb")
