"""YARP's Image as sensor_msgs/Image and sensor_msgs/CompressedImage, and back.

Rules: pixels are not copied where both have them alike: rows from the top, whatever their padding
(`step` there, `quantum` here), little-endian. A pixel type that ROS has no name for travels under
the name of YARP, as in C++. An encoding that YARP has no pixels for is a DecodeError that lists
those it has.
"""

from __future__ import annotations

from typing import Any, Final

from yarpy.data.sig import jpeg
from yarpy.data.sig.image import Image
from yarpy.data.sig.pixel import Pixel, pixel_of
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError
from yarpy.peers.ros.message.fault import array_of
from yarpy.peers.ros.message.message import Message

MAX_SIDE: Final = 0x7FFFFFFF

#: pixel type of YARP -> encoding of ROS
ENCODINGS: Final = {
    "mono": "mono8",
    "mo16": "mono16",
    "rgb": "rgb8",
    "bgr": "bgr8",
    "rgba": "rgba8",
    "bgra": "bgra8",
    "sign": "8SC1",
    "rgb-": "8SC3",
    "int": "32SC1",
    "rgbi": "32SC3",
    "dec": "32FC1",
    "rgb.": "32FC3",
    "grbg": "bayer_grbg8",
    "bggr": "bayer_bggr8",
    "gbrg": "bayer_gbrg8",
    "rggb": "bayer_rggb8",
    "gr16": "bayer_grbg16",
    "bg16": "bayer_bggr16",
    "gb16": "bayer_gbrg16",
    "rg16": "bayer_rggb16",
}
#: ... and back; numbers without colours are taken as OpenCV would
PIXELS: Final = {
    **{encoding: code for code, encoding in ENCODINGS.items()},
    "8UC1": "mono",
    "16UC1": "mo16",
    "8UC3": "bgr",
    "8UC4": "bgra",
}


def image_message(image: Image, cls: type[Message], header: Any) -> Message:
    """A sensor_msgs/Image over the pixels of an Image. A picture with the lowest row first is
    turned over, which takes a copy."""
    import numpy as np

    name = str(image.code)
    if not image.top_down:
        image = Image(image.array, image.code.code, image.quantum)
    blocks = image.to_wire()
    data = np.frombuffer(blocks[1] if len(blocks) == 2 else b"", "u1")
    return cls(
        header=header,
        height=image.height,
        width=image.width,
        encoding=ENCODINGS.get(name, name),
        is_bigendian=0,
        step=len(data) // image.height if image.height else 0,
        data=data,
    )


def image_of(message: Any) -> Image:
    """The Image over the bytes of a sensor_msgs/Image; DecodeError if it is none that can be."""
    import numpy as np

    width, height, step = message.width, message.height, message.step
    kind = _kind(message.encoding)
    row = width * kind.stride
    data = np.ascontiguousarray(array_of(message.data, np.dtype("u1"), "sensor_msgs/Image.data"))
    if max(width, height) > MAX_SIDE or step < row or len(data) < step * height:
        raise DecodeError(
            f"an image of {width} times {height} pixels ({message.encoding}) with rows of {step} "
            f"bytes and {len(data)} bytes in all: that does not fit together"
        )
    if not width or not height:
        return Image.over(memoryview(b""), width, height, kind.code, 1)
    if message.is_bigendian and kind.dtype[-1] != "1":
        shape = (height, width, kind.channels)
        strides = (step, kind.stride, int(kind.dtype[-1]))
        pixels: Any = np.ndarray(shape, ">" + kind.dtype[1:], data, 0, strides)
        return Image(_flat(pixels.astype(kind.dtype)), kind.code, 1)
    quantum = _quantum(row, step)
    if quantum is None:
        rows = data[: step * height].reshape(height, step)[:, :row].copy()
        return Image.over(rows.data.cast("B"), width, height, kind.code, 1)
    return Image.over(data.data, width, height, kind.code, quantum)


def compressed_message(image: Image, cls: type[Message], header: Any) -> Message:
    """A sensor_msgs/CompressedImage: the picture as JPEG. ValueError if that is not possible."""
    return cls(header=header, format="jpeg", data=jpeg.encode(image))


def decompressed(message: Any) -> Image:
    """The Image in a sensor_msgs/CompressedImage that is a JPEG; DecodeError for others."""
    data = bytes(message.data)
    if not data.startswith(b"\xff\xd8"):
        raise DecodeError(
            f"a compressed image of the format {message.format[:40]!r}: only JPEG is read"
        )
    return Image.from_wire(jpeg.decode(data))


def _kind(encoding: str) -> Pixel:
    name = PIXELS.get(encoding)
    if name is None and (encoding.isascii() and 0 < len(encoding) <= 4):
        name = str(Vocab(encoding))  # YARP's own name, which C++ sends for want of another
    try:
        return pixel_of(name or "")
    except ValueError:
        raise DecodeError(
            f"an image of the encoding {encoding[:40]!r}; {', '.join(PIXELS)} can be read"
        ) from None


def _quantum(row: int, step: int) -> int | None:
    """The padding that makes rows of `row` bytes take `step` of them; None if there is none."""
    for quantum in (1, 2, 4, 8, 16, 32, 64, 128, 256, 512, step):
        if -(-row // quantum) * quantum == step and quantum <= 0x7FFF:
            return quantum
    return None


def _flat(pixels: Any) -> Any:
    return pixels[..., 0] if pixels.shape[2] == 1 else pixels
