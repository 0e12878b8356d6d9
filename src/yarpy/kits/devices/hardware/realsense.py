"""Realsense: a RealSense camera, by its maker's library; realsense2 in C++.

    yarpy dev realsense2 --width 640 --height 480 --rate 30 --name /depthCamera
    yarpy dev realsense2 --file recording.db3 --name /depthCamera

Rules: it has the members of `interfaces.depth` that a camera has, without features. Distances are
those of the pixels of the picture, so both have its lens; colour and depth that are asked for one
after the other are of one moment. A file that the library recorded is shown again and again. Only
opening imports pyrealsense2.
"""

from __future__ import annotations

import threading
import time
from contextlib import ExitStack
from typing import Any, Final, NamedTuple

import yarpy
from yarpy.data.bottle import Property
from yarpy.data.value import Vocab
from yarpy.errors import UnknownPlugin
from yarpy.kits.devices.closeable import Closeable
from yarpy.kits.devices.interfaces.depth import STATES
from yarpy.kits.devices.interfaces.media import Configuration, When
from yarpy.log import logger
from yarpy.names.base import NameClient

log = logger("yarpy.devices")

_LOOK: Final = 200  # milliseconds between looks whether it is closed
_SILENT: Final = 3.0  # seconds without pictures, after which something is wrong
_USB: Final = 2
_COEFFICIENTS: Final = ("k1", "k2", "t1", "t2", "k3")


class _Pair(NamedTuple):
    """A picture and its distances, and which pair it is."""

    number: int = 0
    colour: yarpy.Image | None = None
    depth: yarpy.Image | None = None


class Realsense(Closeable):
    """The first camera, or the one with the number `serial`; or the recording `file`.

    size, rate: of pictures and distances. Raises OSError (no camera, or not with that size),
    UnknownPlugin (no pyrealsense2).
    """

    def __init__(
        self,
        size: tuple[int, int] = (640, 480),
        rate: int = 30,
        *,
        serial: str = "",
        file: str = "",
    ) -> None:
        try:
            import pyrealsense2
        except ImportError as error:
            raise UnknownPlugin(
                "RealSense cameras need pyrealsense2: pip install 'yarpy[realsense]'"
            ) from error
        self._library: Any = pyrealsense2
        self._rate, self._error = rate, ""
        self._lock = threading.Lock()  # guards the two below
        self._newest = self._shown = _Pair()
        self._told = {"colour": 0, "depth": 0}
        self._over = threading.Event()
        self._pipeline: Any = pyrealsense2.pipeline()
        with ExitStack() as resources:
            profile = self._start(size, serial, file)
            resources.callback(self._pipeline.stop)
            device = profile.get_device()
            self._name = str(device.get_info(pyrealsense2.camera_info.name))
            self._metre = float(device.first_depth_sensor().get_depth_scale())
            colour = profile.get_stream(pyrealsense2.stream.color).as_video_stream_profile()
            self._lens: Any = colour.get_intrinsics()
            self._align: Any = pyrealsense2.align(pyrealsense2.stream.color)
            thread = threading.Thread(target=self._run, name="yarpy device realsense", daemon=True)
            thread.start()
            resources.callback(thread.join, 5.0)
            resources.callback(self._over.set)
            self._resources = resources.pop_all()

    def colour(self) -> yarpy.Image | None:
        """Return the next picture; None if there is none yet."""
        return self._next("colour")

    def depth(self) -> yarpy.Image | None:
        """Return its distances, metres; None if there are none yet."""
        return self._next("depth")

    def extrinsics(self) -> yarpy.Matrix:
        """Return the identity: distances are those of the pixels."""
        import numpy as np

        return yarpy.Matrix(np.eye(4))

    def last_error(self) -> tuple[str, When]:
        """Return what went wrong last."""
        return self._error, When()

    def status(self) -> int:
        """Return whether it is in use, or why not."""
        return STATES.index("error" if self._error else "in use")

    def width(self) -> int:
        """Return the width."""
        return int(self._lens.width)

    def height(self) -> int:
        """Return the height."""
        return int(self._lens.height)

    def resolution(self) -> tuple[int, int]:
        """Return width and height."""
        return self.width(), self.height()

    def configurations(self) -> list[Configuration]:
        """Return the present one."""
        return [Configuration(*self.resolution(), float(self._rate), Vocab("rgb").code)]

    def field_of_view(self) -> tuple[float, float]:
        """Return the angles, degrees."""
        across, down = self._library.rs2_fov(self._lens)
        return float(across), float(down)

    def intrinsics(self) -> Property:
        """Return the parameters of the lens."""
        lens = self._lens
        found: dict[str, Any] = {
            "physFocalLength": 0.0,
            "focalLengthX": float(lens.fx),
            "focalLengthY": float(lens.fy),
            "principalPointX": float(lens.ppx),
            "principalPointY": float(lens.ppy),
            "distortionModel": "none",
        }
        if any(lens.coeffs):
            # The model of OpenCV and ROS; others keep their names.
            model = str(lens.model).rpartition(".")[2]
            found["distortionModel"] = "plumb_bob" if model == "brown_conrady" else model
            found |= dict(zip(_COEFFICIENTS, map(float, lens.coeffs), strict=True))
        return Property(found)

    def mirrored(self) -> bool:
        """Return False."""
        return False

    colour_width = depth_width = width
    colour_height = depth_height = height
    colour_resolution = depth_resolution = resolution
    colour_field_of_view = depth_field_of_view = field_of_view
    colour_intrinsics = depth_intrinsics = intrinsics
    colour_mirrored = depth_mirrored = mirrored

    def description(self) -> tuple[int, str]:
        """Return how it is connected, and what it is."""
        return _USB, self._name

    def has_feature(self, feature: int) -> bool:
        """Return False: realsense-viewer adjusts it."""
        return False

    def _start(self, size: tuple[int, int], serial: str, file: str) -> Any:
        library = self._library
        config = library.config()
        if file:
            config.enable_device_from_file(file)
        else:
            if serial:
                config.enable_device(serial)
            config.enable_stream(library.stream.depth, *size, library.format.z16, self._rate)
            config.enable_stream(library.stream.color, *size, library.format.rgb8, self._rate)
        try:
            return self._pipeline.start(config)
        except RuntimeError as error:
            what = file or f"a RealSense camera {serial}".rstrip()
            raise OSError(
                f"{what} does not open with {size[0]} x {size[1]}, {self._rate} a second: {error}"
            ) from error

    def _run(self) -> None:
        came = time.monotonic()
        while not self._over.is_set():
            try:
                there, frames = self._pipeline.try_wait_for_frames(_LOOK)
                if there:
                    self._keep(self._align.process(frames))
                    came, self._error = time.monotonic(), ""
                elif time.monotonic() - came > _SILENT and not self._error:
                    self._error = f"no picture came for {_SILENT} s: is it plugged in?"
                    log.warning("%s: %s", self._name, self._error)
            except RuntimeError as error:
                self._error = str(error)
                log.warning("%s: %s", self._name, error)
                return

    def _keep(self, frames: Any) -> None:
        import numpy as np

        colour, depth = frames.get_color_frame(), frames.get_depth_frame()
        if not colour or not depth:
            return
        # Where a recording begins anew, the library has pairs of its end and its beginning.
        if abs(colour.get_timestamp() - depth.get_timestamp()) * self._rate > 1000.0:
            return
        pixels = np.array(colour.get_data())
        metres = np.asanyarray(depth.get_data()) * np.float32(self._metre)
        with self._lock:
            self._newest = _Pair(self._newest.number + 1, yarpy.Image(pixels), yarpy.Image(metres))

    def _next(self, which: str) -> yarpy.Image | None:
        with self._lock:
            if self._told[which] == self._shown.number:
                self._shown = self._newest
            if self._told[which] == self._shown.number:
                return None
            self._told[which] = self._shown.number
            return self._shown.colour if which == "colour" else self._shown.depth


def realsense(options: Property, *, names: NameClient | None = None) -> object:
    """A RealSense camera. Raises OSError, ValueError, UnknownPlugin."""
    width, height, rate = (
        options.find(*one) for one in (("width", 640), ("height", 480), ("rate", 30))
    )
    for one in (width, height, rate):
        if type(one) is not int or one < 1:
            raise ValueError(f"width {width}, height {height} and rate {rate} are numbers")
    serial, file = (str(options.find(key, "") or "") for key in ("serial", "file"))
    return Realsense((width, height), rate, serial=serial, file=file)
