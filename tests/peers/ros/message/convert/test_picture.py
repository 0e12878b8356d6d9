"""Images to sensor_msgs and back: recorded bytes, every pixel type, padding, no copies."""

from typing import Any

import numpy as np
import pytest
from support import ros

from yarpy.data.sig.image import Image
from yarpy.data.sig.pixel import NAMES, pixel_of
from yarpy.errors import DecodeError
from yarpy.peers.ros.message.convert import picture
from yarpy.peers.ros.message.library import Library

# What C++ YARP published of a picture of 3 times 2 pixels: sequence, time, "/frame", ...
RECORDED = bytes.fromhex(
    "00000000b4df006bb37f9031060000002f6672616d65"
    "0200000003000000" + "0400000072676238" + "00" + "10000000" + "20000000"
)


def pixels(name: str, height: int = 2, width: int = 3) -> Image:
    kind = pixel_of(name)
    values = np.arange(height * width * kind.channels).reshape(height, width, kind.channels)
    array = values.astype(kind.dtype)
    return Image(array if kind.channels > 1 else array[..., 0], name)


def message(library: Library, image: Image) -> Any:
    cls = library.message("sensor_msgs/Image")
    return picture.image_message(image, cls, library.message("std_msgs/Header")())


def test_bytes_are_those_of_cpp_yarp(library: Library) -> None:
    image = pixels("rgb")
    made = message(library, image)
    header = library.message("std_msgs/Header")
    made.header = header(0, (0x6B00DFB4, 0x31907FB3), "/frame")
    made.header.stamp = header().stamp._replace(secs=0x6B00DFB4, nsecs=0x31907FB3)
    data = b"".join(made.to_ros())
    assert data[: len(RECORDED)] == RECORDED
    assert data[len(RECORDED) :] == image.to_wire()[1]
    assert picture.image_of(type(made).from_ros(data)) == image


@pytest.mark.parametrize("name", NAMES)
def test_every_pixel_type_comes_back(library: Library, name: str) -> None:
    image = pixels(name)
    made = message(library, image)
    again = picture.image_of(type(made).from_ros(b"".join(made.to_ros())))
    assert str(again.code) == name
    assert again == image


def test_pixels_are_not_copied_either_way(library: Library) -> None:
    image = pixels("rgb", 40, 40)
    made = message(library, image)
    head, body = made.to_ros()
    memory = np.frombuffer(image.to_wire()[1], "u1")
    assert np.shares_memory(np.frombuffer(body, "u1"), memory)
    data = b"".join((head, body))
    again = picture.image_of(type(made).from_ros(data))
    assert np.shares_memory(again.array, np.frombuffer(data, "u1"))


@pytest.mark.parametrize("step", [9, 10, 12, 16, 32, 11, 100])
def test_rows_of_any_padding(library: Library, step: int) -> None:
    image = pixels("rgb", 4, 3)
    cls = library.message("sensor_msgs/Image")
    rows = np.full((4, step), 255, "u1")
    rows[:, :9] = image.array.reshape(4, 9)
    found = picture.image_of(cls(height=4, width=3, encoding="rgb8", step=step, data=rows.ravel()))
    assert found == image
    assert Image.from_wire(b"".join(found.to_wire())) == image


def test_very_wide_steps_are_copied_out(library: Library) -> None:
    cls = library.message("sensor_msgs/Image")
    data = np.arange(80_000, dtype="u1")
    found = picture.image_of(cls(height=2, width=3, encoding="mono8", step=40_000, data=data))
    assert found.array.tolist() == [[0, 1, 2], [64, 65, 66]]


def test_lowest_row_first_is_turned_over(library: Library) -> None:
    image = Image(pixels("rgb").array, "rgb", top_down=False)
    assert picture.image_of(message(library, image)) == image


def test_big_endian_pixels_are_turned(library: Library) -> None:
    cls = library.message("sensor_msgs/Image")
    made = cls(height=1, width=2, encoding="16UC1", is_bigendian=1, step=4, data=b"\1\2\3\4")
    assert picture.image_of(made).array.tolist() == [[0x0102, 0x0304]]
    made = cls(height=1, width=4, encoding="mono8", is_bigendian=1, step=4, data=b"\1\2\3\4")
    assert picture.image_of(made).array.tolist() == [[1, 2, 3, 4]]


def test_encodings_of_opencv(library: Library) -> None:
    cls = library.message("sensor_msgs/Image")
    for encoding, code in (("8UC1", "mono"), ("8UC3", "bgr"), ("8UC4", "bgra"), ("16UC1", "mo16")):
        made = cls(height=1, width=1, encoding=encoding, step=8, data=bytes(8))
        assert str(picture.image_of(made).code) == code


def test_empty_pictures(library: Library) -> None:
    cls = library.message("sensor_msgs/Image")
    found = picture.image_of(cls(width=3, encoding="rgb8", step=9))
    assert (found.width, found.height) == (3, 0)
    empty = message(library, Image(np.zeros((0, 3, 3), "u1")))
    assert (empty.height, len(empty.data)) == (0, 0)


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"encoding": "yuv422"}, "'yuv422'; mono8, mono16, rgb8"),
        ({"encoding": ""}, "an image of the encoding ''"),
        ({"encoding": "64FC1"}, "'64FC1'"),
        ({"encoding": "rgb8", "step": 8}, "does not fit together"),
        ({"encoding": "rgb8", "height": 3}, "does not fit together"),
        ({"encoding": "rgb8", "width": 1 << 31, "height": 0}, "does not fit together"),
        ({"encoding": "rgb8", "height": (1 << 32) - 1}, "does not fit together"),
    ],
)
def test_pictures_that_are_none(library: Library, fields: dict[str, Any], said: str) -> None:
    cls = library.message("sensor_msgs/Image")
    made = {"height": 2, "width": 3, "step": 9, "data": bytes(18), **fields}
    with pytest.raises(DecodeError, match=said):
        picture.image_of(cls(**made))


def test_compressed_pictures(library: Library) -> None:
    cls = library.message("sensor_msgs/CompressedImage")
    flat = Image(np.full((16, 16, 3), 100, "u1"))
    made: Any = picture.compressed_message(flat, cls, library.message("std_msgs/Header")())
    assert made.format == "jpeg"
    again = picture.decompressed(cls.from_ros(b"".join(made.to_ros())))
    assert abs(again.array.astype("i4") - 100).max() < 4
    with pytest.raises(DecodeError, match="only JPEG"):
        picture.decompressed(cls(format="png", data=b"\x89PNG"))
    with pytest.raises(DecodeError, match="not a readable JPEG"):
        picture.decompressed(cls(format="jpeg", data=b"\xff\xd8rest"))


@pytest.mark.peer("ros")
def test_rospy_sees_the_picture(library: Library) -> None:
    image = pixels("bgr")
    given = b"".join(message(library, image).to_ros()).hex()
    program = """
from sensor_msgs.msg import Image
found = Image()
found.deserialize(bytes.fromhex(given))
answer = [found.width, found.height, found.encoding, found.step, found.data.hex()]
"""
    data = bytes(image.to_wire()[1]).hex()
    assert ros.ask(program, given) == [3, 2, "bgr8", 16, data]
