"""Views of a camera: IFrameGrabberImage, IFrameGrabberRgb, IFrameGrabberControls.

Rules: features are numbers, `YARP_FEATURE_GAIN` ..., in the order of `yarpy.devices.FEATURES`.
"""

from __future__ import annotations

from typing import Any

import yarpy
from yarp._numbers import store
from yarp._view import View
from yarpy.kits.devices import FEATURES

_MODES = {"manual": 1, "auto": 2}


class CameraDescriptor:
    """How a camera is connected, and which one it is."""

    def __init__(self, busType: int = 0, deviceDescription: str = "") -> None:
        self.busType = busType
        self.deviceDescription = deviceDescription


class IFrameGrabberImageBase(View):
    """The size of pictures."""

    def height(self) -> int:
        return int(self._board.resolution[1])

    def width(self) -> int:
        return int(self._board.resolution[0])

    def _picture(self) -> yarpy.Image:
        found = self._board.image()
        return found if isinstance(found, yarpy.Image) else yarpy.Image(found)


class IFrameGrabber(IFrameGrabberImageBase):
    """Pictures as the camera has them, of YARP 3."""

    def getRawBuffer(self, buffer: Any) -> bool:
        """The next picture's bytes, row by row, into a bytearray or an array."""

        def read() -> None:
            memoryview(buffer).cast("B")[:] = self._picture().array.tobytes()

        return self._tell(read)

    def getRawBufferSize(self) -> int:
        """How many bytes that are; 0 if no picture comes."""
        size = [0]
        self._tell(lambda: store(size, [self._picture().array.nbytes]))
        return size[0]


class IFrameGrabberImage(IFrameGrabberImageBase):
    """Pictures."""

    def getImage(self, image: Any) -> bool:
        """Wait for the next picture."""
        return self._tell(lambda: image._fill(self._picture()))

    def getImageCrop(self, cropType: int, vertices: Any, image: Any) -> bool:
        """A rectangle of the next picture; `vertices` are two pairs of x and y."""
        corners = [int(number) for pair in vertices for number in pair]
        return self._tell(lambda: image._fill(self._board.crop(*corners)))


class IFrameGrabberRgb(IFrameGrabberImage):
    """Pictures in colour."""

    def getRgbBuffer(self, buffer: Any) -> bool:
        """The next picture's bytes, row by row, into a bytearray or an array."""

        def read() -> None:
            memoryview(buffer).cast("B")[:] = self._picture().converted("rgb").array.tobytes()

        return self._tell(read)


class IFrameGrabberControls(View):
    """Brightness, gain and so on."""

    def getCameraDescription(self) -> CameraDescriptor:
        buses = {"firewire": 1, "usb": 2}
        found = ["unknown", ""]
        self._tell(lambda: store(found, self._board.description))
        return CameraDescriptor(buses.get(str(found[0]).lower(), 0), str(found[1]))

    def busType2String(self, type: int) -> str:
        return {1: "BUS_FIREWIRE", 2: "BUS_USB"}.get(type, "BUS_UNKNOWN")

    def hasFeature(self, feature: int) -> bool:
        return self._has("features", feature)

    def hasOnOff(self, feature: int) -> bool:
        return self._has("feature_switches", feature)

    def hasAuto(self, feature: int) -> bool:
        return self._has("feature_modes", feature)

    def hasManual(self, feature: int) -> bool:
        return self._has("features", feature)

    def hasOnePush(self, feature: int) -> bool:
        return self._has("feature_modes", feature)

    def _has(self, table: str, feature: int) -> bool:
        try:
            return FEATURES[feature] in getattr(self._board, table)
        except (yarpy.YarpError, IndexError):
            return False

    def getFeature(self, feature: int, *values: Any) -> float:
        """The value of a feature, 0 if there is none; with further arguments, they are filled."""
        found: list[float] = []

        def read() -> None:
            value = self._board.features[FEATURES[feature]]
            found.extend(value if isinstance(value, list | tuple) else [value])

        done = self._tell(read)
        if not values:
            return found[0] if found else 0.0
        for target, value in zip(values, found, strict=False):
            store(target, [value])
        return done

    def setFeature(self, feature: int, *values: float) -> bool:
        def write() -> None:
            self._board.features[FEATURES[feature]] = values[0] if len(values) == 1 else values

        return self._tell(write)

    def getActive(self, feature: int) -> bool:
        found = [False]
        self._tell(lambda: store(found, [bool(self._board.feature_switches[FEATURES[feature]])]))
        return found[0]

    def setActive(self, feature: int, onoff: bool) -> bool:
        def write() -> None:
            self._board.feature_switches[FEATURES[feature]] = bool(onoff)

        return self._tell(write)

    def getMode(self, feature: int) -> int:
        found = [""]
        self._tell(lambda: store(found, [self._board.feature_modes[FEATURES[feature]]]))
        return _MODES.get(found[0], 0)

    def setMode(self, feature: int, mode: int) -> bool:
        def write() -> None:
            self._board.feature_modes[FEATURES[feature]] = "auto" if mode == 2 else "manual"

        return self._tell(write)

    def setOnePush(self, feature: int) -> bool:
        return self._tell(lambda: self._board.one_push(FEATURES[feature]))

    def toFeatureMode(self, _auto: bool) -> int:
        return 2 if _auto else 1


def _named(number: int) -> tuple[Any, Any]:
    """Methods for one feature."""

    def read(self: IFrameGrabberControls) -> float:
        return self.getFeature(number)

    def write(self: IFrameGrabberControls, v: float) -> bool:
        return self.setFeature(number, v)

    return read, write


for _name, _number in {
    "Brightness": 0,
    "Exposure": 1,
    "Sharpness": 2,
    "Hue": 4,
    "Saturation": 5,
    "Gamma": 6,
    "Shutter": 7,
    "Gain": 8,
    "Iris": 9,
}.items():
    _read, _write = _named(_number)
    setattr(IFrameGrabberControls, f"get{_name}", _read)
    setattr(IFrameGrabberControls, f"set{_name}", _write)
