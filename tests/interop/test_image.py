"""Pictures between C++ and yarpy, pixel for pixel: every type the binding has, padded rows, flips.

The C++ side fills and shows the whole memory of an image, padding included.
"""

from typing import Any

import numpy as np
import pytest
from support.cpp import CppYarp
from support.cpp_program import CppProgram
from support.wait import HANG

import yarpy
from yarpy import Image
from yarpy.data.sig.pixel import pixel_of

CLASSES = {
    "ImageRgb": "rgb",
    "ImageRgba": "rgba",
    "ImageMono": "mono",
    "ImageMono16": "mo16",
    "ImageInt": "int",
    "ImageFloat": "dec",
    "ImageRgbFloat": "rgb.",
}
SHAPES = ((1, 1), (5, 3), (8, 4), (33, 7), (320, 240))

SIDE = """
import ctypes
port = yarp.Port()
assert port.open('/cpp')
def make(kind, width, height, quantum, top_down=True):
    image = getattr(yarp, kind)()
    image.setQuantum(quantum)
    if not top_down: image.setTopIsLowIndex(False)
    image.resize(width, height)
    size = image.getRawImageSize()
    memory = bytes((7 * i + i // 256) % 251 for i in range(size))
    ctypes.memmove(int(image.getRawImage()), memory, size)
    return image
def memory(image):
    size = image.getRawImageSize()
    return ctypes.string_at(int(image.getRawImage()), size).hex() if size else ""
def read(kind):
    image = getattr(yarp, kind)()
    assert port.read(image)
    return [image.width(), image.height(), image.getPixelCode(), image.getRowSize(),
            hasattr(image, "topIsLowIndex") and image.topIsLowIndex(), memory(image)]
"""


def sample(code: str, width: int, height: int) -> Any:
    """An array of odd numbers for an image of that pixel code."""
    kind = pixel_of(code)
    shape = (height, width, kind.channels) if kind.channels > 1 else (height, width)
    numbers = np.arange(np.prod(shape)).reshape(shape)
    if kind.dtype[1] == "f":
        return (numbers * 1.25 - 7).astype(kind.dtype)
    return (numbers * 7).astype(kind.dtype)


def rows(memory: str, row_bytes: int, image_bytes: int) -> Any:
    """What C++ shows, as rows of bytes without padding."""
    return np.frombuffer(bytes.fromhex(memory), "u1").reshape(-1, row_bytes)[:, :image_bytes]


def pixels(array: Any) -> Any:
    """An array of pixels as rows of bytes."""
    return np.frombuffer(array.tobytes(), "u1").reshape(array.shape[0], -1)


@pytest.mark.parametrize(("kind", "code"), CLASSES.items())
def test_cpp_sends(side: CppProgram, port: yarpy.Port, kind: str, code: str) -> None:
    for width, height in SHAPES:
        for quantum in (8, 1, 4):
            side.begin(
                f"image = make('{kind}', {width}, {height}, {quantum})\n"
                "assert port.write(image)\n"
                "[image.getRowSize(), memory(image)]"
            )
            image = port.read(timeout=HANG).value
            row_bytes, memory = side.end()
            assert isinstance(image, Image)
            found = (image.code, image.width, image.height, image.quantum)
            assert found == (code, width, height, quantum)
            seen = pixels(image.array)
            assert (seen == rows(memory, row_bytes, seen.shape[1])).all(), (width, quantum)


@pytest.mark.parametrize(("kind", "code"), CLASSES.items())
def test_yarpy_sends(side: CppProgram, port: yarpy.Port, kind: str, code: str) -> None:
    for width, height in SHAPES:
        for quantum in (8, 1, 4):
            array = sample(code, width, height)
            image = Image(array, code, quantum)
            for receiver in (kind, "FlexImage"):
                side.begin(f"read('{receiver}')")
                port.write(image)
                answer = side.end()
                assert answer[:3] == [width, height, image.code.code]
                seen = rows(answer[5], answer[3], pixels(array).shape[1])
                assert (seen == pixels(array)).all(), (receiver, width, quantum)


def test_pixels_are_where_they_belong(side: CppProgram, port: yarpy.Port) -> None:
    """Red is red, x is x: through the pixel access of C++, not through memory."""
    array = np.zeros((4, 5, 3), "u1")
    array[1, 3] = (10, 20, 30)
    side.begin("image = yarp.ImageRgb(); port.read(image)\np = image.pixel(3, 1)\n[p.r, p.g, p.b]")
    port.write(array)
    assert side.end() == [10, 20, 30]
    side.begin(
        "image = yarp.ImageRgb(); image.resize(5, 4); image.zero()\n"
        "p = image.pixel(4, 2); p.r, p.g, p.b = 40, 50, 60\n"
        "port.write(image)"
    )
    seen = port.read(timeout=HANG).as_(np.ndarray)
    assert side.end()
    assert seen.shape == (4, 5, 3)
    assert seen[2, 4].tolist() == [40, 50, 60]
    assert seen.sum() == 150


def test_bottom_up(cpp: CppYarp, side: CppProgram, port: yarpy.Port) -> None:
    """The first row in memory is the bottom one: an array still begins at the top."""
    if cpp.version >= (3, 10):
        pytest.skip("since YARP 3.10 no image is bottom up")
    side.begin("image = make('ImageMono', 6, 4, 8, False)\nport.write(image)\nmemory(image)")
    image = port.read(timeout=HANG).value
    stored = rows(side.end(), 8, 6)
    assert not image.top_down
    assert (image.array == stored[::-1]).all()
    array = sample("mono", 6, 4)
    side.begin("read('ImageMono')")
    port.write(Image(array, top_down=False))
    answer = side.end()
    assert answer[4] is False
    assert (rows(answer[5], answer[3], 6) == array[::-1]).all()


def test_an_empty_image(side: CppProgram, port: yarpy.Port) -> None:
    side.begin("port.write(yarp.ImageRgb())")
    image = port.read(timeout=HANG).value
    assert side.end()
    assert (image.width, image.height, image.array.shape) == (0, 0, (0, 0, 3))
    side.begin("read('FlexImage')[:2]")
    port.write(image)
    assert side.end() == [0, 0]


def test_conversions_are_those_of_cpp(side: CppProgram, port: yarpy.Port) -> None:
    """An image of one type read as another: C++ converts it as it comes, `converted` on demand."""
    names = {code: kind for kind, code in CLASSES.items()}
    pairs = [
        *(("rgb", "mono"), ("mono", "rgb"), ("rgb", "rgba"), ("rgba", "rgb"), ("rgba", "mono")),
        *(("mono", "rgba"), ("rgb", "dec"), ("mono", "dec"), ("dec", "mono"), ("mono", "int")),
    ]
    for source, target in pairs:
        array = sample(source, 9, 5)
        if source == "dec":
            array = np.abs(array)
        image = Image(array, source)
        side.begin(f"read('{names[target]}')")
        port.write(image)
        answer = side.end()
        expected = pixels(image.converted(target).array)
        assert (rows(answer[5], answer[3], expected.shape[1]) == expected).all(), (source, target)


def test_over_every_binary_carrier(side: CppProgram) -> None:
    array = sample("rgb", 64, 48)
    for carrier in ("tcp", "fast_tcp", "udp", "mcast"):
        with yarpy.Port("/ours") as port:
            port.connect("/cpp", carrier)
            port.listen_to("/cpp", carrier)
            assert port.wait_for_inputs(timeout=HANG)
            side.begin("image = yarp.ImageRgb(); port.read(image); port.write(image)")
            port.write(array)
            assert (port.read(timeout=HANG).as_(np.ndarray) == array).all(), carrier
            assert side.end()
