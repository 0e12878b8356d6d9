"""V4l2Camera: a camera of Linux, without a library; usbCamera in C++.

    yarpy dev usbCamera --d /dev/video0 --width 640 --height 480 --name /eye

Rules: it has the members of `frame_grabber.interface`. Pictures come as MJPEG, or as YUYV if the
camera has none (`--pixelType YUYV` asks for it); the camera takes the size that is nearest. What is
asked for is the newest picture. The layouts are those of Linux with 64 bits.

Source: Documentation/userspace-api/media/v4l of Linux, and its videodev2.h.
"""

from __future__ import annotations

import mmap
import os
import sys
import time
from collections.abc import Callable
from contextlib import ExitStack
from errno import EBUSY
from struct import Struct
from typing import Any, Final, NamedTuple

from yarpy.data.bottle import Property
from yarpy.data.sig import jpeg
from yarpy.data.sig.image import Image
from yarpy.errors import Timeout, UnknownPlugin
from yarpy.kits.devices.closeable import Closeable
from yarpy.kits.devices.hardware.device_file import open_device
from yarpy.names.base import NameClient
from yarpy.transports.descriptor import has_input

QUERYCAP, GET_FORMAT, SET_FORMAT = 0x80685600, 0xC0D05604, 0xC0D05605
REQUEST, QUERY, QUEUE, DEQUEUE = 0xC0145608, 0xC0585609, 0xC058560F, 0xC0585611
START, STOP = 0x40045612, 0x40045613

CAPABILITY: Final = Struct("<16s32s32s3I12x")  # driver, name, bus, version, all, of this file
FORMAT: Final = Struct("<I4x6I176x")  # type, width, height, pixels, field, bytes of a line, size
BUFFERS: Final = Struct("<3I8x")  # how many, type, memory
#: number, type, bytes, flags, field, seconds, microseconds, sequence, memory, offset, length
BUFFER: Final = Struct("<5I4x2q16x3I4xI12x")
_KIND: Final = Struct("<i")
CAPTURE, MAPPED = 1, 1  # a type, and a memory
CAN_CAPTURE, CAN_STREAM, OF_THIS_FILE = 0x1, 0x0400_0000, 0x8000_0000
BROKEN, CLOCK, MONOTONIC = 0x40, 0xE000, 0x2000  # flags of a buffer
_COUNT: Final = 4  # buffers
_WAITED: Final = 3.0  # seconds for a picture


class V4l2Camera(Closeable):
    """The camera at `path`. size: wanted width and height, None for what it has. pixels: MJPG,
    YUYV, or "" for the first of them that it has. Raises OSError, UnknownPlugin on Windows."""

    def __init__(
        self, path: str = "/dev/video0", size: tuple[int, int] | None = None, pixels: str = ""
    ) -> None:
        if pixels and pixels not in _DECODERS:
            raise ValueError(f"pixels are {' or '.join(_DECODERS)}, not {pixels}")
        self.path, self._time = path, 0.0
        with ExitStack() as resources:
            self._file = _opened(path)
            resources.callback(os.close, self._file)
            self.description = ("usb", self._name())
            self._layout, self._decode = self._choose(size, pixels)
            self.resolution = self._layout.width, self._layout.height
            asked = bytearray(BUFFERS.pack(_COUNT, CAPTURE, MAPPED))
            self._control(REQUEST, asked)
            self._maps: list[mmap.mmap] = []
            for number in range(BUFFERS.unpack(asked)[0]):
                found = BUFFER.unpack(self._buffer(QUERY, number))
                mapped = mmap.mmap(self._file, found[10], offset=found[9])
                self._maps.append(resources.enter_context(mapped))
                self._buffer(QUEUE, number)
            self._control(START, bytearray(_KIND.pack(CAPTURE)))
            resources.callback(self._stop)
            self._resources = resources.pop_all()

    def image(self) -> Any:
        """Return the newest picture, RGB. Waits for one. Raises Timeout, OSError (unplugged),
        DecodeError (it is broken)."""
        number, data = self._next()
        while has_input(self._file, 0.0):
            self._buffer(QUEUE, number)
            number, data = self._next()
        self._buffer(QUEUE, number)
        return self._decode(data, self._layout)

    def timestamp(self) -> float:
        """Return the time when the last picture was taken, seconds."""
        return self._time

    def _next(self) -> tuple[int, bytes]:
        """The number of the next buffer that is whole, and what is in it."""
        while True:
            if not has_input(self._file, _WAITED):
                raise Timeout(f"{self.path}: no picture came for {_WAITED} s: is it plugged in?")
            found = BUFFER.unpack(self._buffer(DEQUEUE, 0))
            number, _, size, flags, _, seconds, micro = found[:7]
            if not flags & BROKEN:
                break
            self._buffer(QUEUE, number)
        self._time = time.time()
        if flags & CLOCK == MONOTONIC:
            self._time -= time.monotonic() - (seconds + micro * 1e-6)
        return number, self._maps[number][:size]

    def _name(self) -> str:
        """Return its name. Raises OSError if it is no camera."""
        found = bytearray(CAPABILITY.size)
        self._control(QUERYCAP, found)
        _, name, _, _, all_of_it, this = CAPABILITY.unpack(found)
        can = this if all_of_it & OF_THIS_FILE else all_of_it
        if not (can & CAN_CAPTURE and can & CAN_STREAM):
            raise OSError(f"{self.path} gives no pictures: cameras have several files, try others")
        return str(name.split(b"\0")[0], "utf-8", "replace")

    def _choose(self, size: tuple[int, int] | None, pixels: str) -> tuple[Layout, Decoder]:
        found = bytearray(FORMAT.pack(CAPTURE, *[0] * 6))
        self._control(GET_FORMAT, found)
        _, width, height, has, *_ = FORMAT.unpack(found)
        for wanted in (pixels,) if pixels else _DECODERS:
            code = int.from_bytes(wanted.encode(), "little")
            found = bytearray(FORMAT.pack(CAPTURE, *(size or (width, height)), code, *[0] * 3))
            self._control(SET_FORMAT, found)
            _, wide, high, has, _, line, _ = FORMAT.unpack(found)
            if has == code:
                return Layout(wide, high, line), _DECODERS[wanted]
        raise OSError(
            f"{self.path} has no pictures in {pixels or ' or '.join(_DECODERS)}, but in "
            f"{has.to_bytes(4, 'little').decode('latin-1')}: OpenCV may know them (opencv_grabber)"
        )

    def _buffer(self, request: int, number: int) -> bytearray:
        data = bytearray(BUFFER.pack(number, CAPTURE, *[0] * 6, MAPPED, 0, 0))
        self._control(request, data)
        return data

    def _stop(self) -> None:
        try:
            self._control(STOP, bytearray(_KIND.pack(CAPTURE)))
        except OSError:
            pass  # it is unplugged

    def _control(self, request: int, data: bytearray) -> None:
        try:
            ioctl(self._file, request, data)
        except OSError as error:
            why = (
                "another program has it" if error.errno == EBUSY else os.strerror(error.errno or 0)
            )
            raise OSError(error.errno, f"{self.path}: {why}") from error


class Layout(NamedTuple):
    """The width and height of pictures, and the bytes from one line to the next."""

    width: int
    height: int
    line: int


Decoder = Callable[[bytes, Layout], Any]


def from_mjpeg(data: bytes, layout: Layout) -> Any:
    """Return the pixels of a JPEG, RGB. Raises DecodeError."""
    return Image.from_wire(jpeg.decode(data)).converted("rgb").array


def from_yuyv(data: bytes, layout: Layout) -> Any:
    """Return pixels of Y U Y V as RGB, by BT.601 with Y from 16 to 235. Raises ValueError for a
    picture that is too short."""
    import numpy as np

    width, height, line = layout
    line = line or 2 * width
    found = np.frombuffer(data, "u1", line * height).reshape(height, line)[:, : 2 * width]
    four = found.reshape(height, width // 2, 4).astype("f4")
    light = (four[:, :, (0, 2)] - 16) * np.float32(255 / 219)
    blue, red = (four[:, :, n, None] - 128 for n in (1, 3))
    rgb = np.empty((height, width // 2, 2, 3), "f4")
    rgb[..., 0] = light + np.float32(1.596) * red
    rgb[..., 1] = light - np.float32(0.392) * blue - np.float32(0.813) * red
    rgb[..., 2] = light + np.float32(2.017) * blue
    return np.clip(np.rint(rgb), 0, 255).astype("u1").reshape(height, width, 3)


#: What a camera calls its pixels, best first.
_DECODERS: Final[dict[str, Decoder]] = {"MJPG": from_mjpeg, "YUYV": from_yuyv}


def ioctl(file: int, request: int, data: bytearray) -> None:
    """Ask the system something; the answer is in `data`. Raises OSError."""
    if sys.platform == "win32":
        raise UnknownPlugin("usbCamera is for Linux: opencv_grabber opens cameras of Windows")
    import fcntl

    fcntl.ioctl(file, request, data)


def usb_camera(options: Property, *, names: NameClient | None = None) -> object:
    """A camera of Linux. Raises OSError, ValueError."""
    width, height = (options.find(key) for key in ("width", "height"))
    size = None
    if width is not None or height is not None:
        if type(width) is not int or type(height) is not int or min(width, height) < 1:
            raise ValueError(f"a size is a width and a height in pixels, not {width} x {height}")
        size = width, height
    path = str(options.find("d") or options.find("port") or "/dev/video0")
    return V4l2Camera(path, size, str(options.find("pixelType", "") or ""))


def _opened(path: str) -> int:
    if sys.platform == "win32":
        raise UnknownPlugin("usbCamera is for Linux: opencv_grabber opens cameras of Windows")
    return open_device(
        path,
        os.O_RDWR | os.O_NONBLOCK,
        "camera",
        others="video*",
        option="--d",
        absent="plug one in",
        group="video",
    )
