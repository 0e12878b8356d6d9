"""OpencvCamera: any camera or film that OpenCV opens; opencv_grabber in C++.

    <device name="eye" type="opencv_grabber"><param name="camera">0</param></device>

    yarpy dev opencv_grabber --camera 0 --name /eye
    yarpy dev opencv_grabber --movie film.avi --loop 1 --name /eye

Rules: it has the members of `frame_grabber.interface`. A film has as many pictures a second as are
asked for; after its last one there are none, unless it loops. Only opening imports OpenCV.
"""

from __future__ import annotations

import time
from contextlib import ExitStack
from typing import Any

from yarpy.data.bottle import Property
from yarpy.errors import UnknownPlugin
from yarpy.kits.devices.closeable import Closeable
from yarpy.names.base import NameClient


class OpencvCamera(Closeable):
    """source: the number of a camera, or the path of a film. size: wanted width and height; the
    camera takes what is nearest. Raises OSError (there is none), UnknownPlugin (no OpenCV)."""

    def __init__(
        self, source: int | str, size: tuple[int, int] | None = None, *, loop: bool = False
    ) -> None:
        try:
            import cv2
        except ImportError as error:
            raise UnknownPlugin("cameras of OpenCV need it: pip install 'yarpy[vision]'") from error
        self._cv2: Any = cv2
        self._loop = loop and isinstance(source, str)
        self._time = 0.0
        self._capture: Any = cv2.VideoCapture(source)
        with ExitStack() as resources:
            resources.callback(self._capture.release)
            if not self._capture.isOpened():
                what = f"camera {source}" if isinstance(source, int) else source
                raise OSError(f"OpenCV opens no {what}: is it there, and does nobody else use it?")
            if size is not None:
                for key, value in zip(
                    (cv2.CAP_PROP_FRAME_WIDTH, cv2.CAP_PROP_FRAME_HEIGHT), size, strict=True
                ):
                    self._capture.set(key, value)
            self.description = ("usb" if isinstance(source, int) else "unknown", f"{source}")
            self._resources = resources.pop_all()

    @property
    def resolution(self) -> tuple[int, int]:
        """Width and height in pixels."""
        get, cv2 = self._capture.get, self._cv2
        return int(get(cv2.CAP_PROP_FRAME_WIDTH)), int(get(cv2.CAP_PROP_FRAME_HEIGHT))

    def image(self) -> Any:
        """Return the next picture, RGB; None if there is none. Waits for a camera."""
        there, found = self._capture.read()
        if not there and self._loop:
            self._capture.set(self._cv2.CAP_PROP_POS_FRAMES, 0)
            there, found = self._capture.read()
        self._time = time.time()
        return self._cv2.cvtColor(found, self._cv2.COLOR_BGR2RGB) if there else None

    def timestamp(self) -> float:
        """Return the time when the last picture was taken, seconds."""
        return self._time


def camera(options: Property, *, names: NameClient | None = None) -> object:
    """A camera or a film, opened by OpenCV. Raises OSError, ValueError, UnknownPlugin."""
    movie, number = str(options.find("movie", "") or ""), options.find("camera", 0)
    if type(number) is not int:
        raise ValueError(f"camera {number} is no number; the path of a film is movie")
    sides = [
        next((options[key] for key in keys if options.find(key) is not None), None)
        for keys in (("width", "w"), ("height", "h"))
    ]
    size = None
    if sides != [None, None]:
        width, height = sides
        if type(width) is not int or type(height) is not int or min(width, height) < 1:
            raise ValueError(f"a size is a width and a height in pixels, not {sides}")
        size = width, height
    loop = str(options.find("loop", False)).lower() not in ("false", "0")
    return OpencvCamera(movie or number, size, loop=loop)
