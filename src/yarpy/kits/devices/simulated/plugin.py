"""Devices without hardware as devices of a robot's file, under the names that they have in C++.

    <device name="eye" type="fakeFrameGrabber"><param name="width">640</param></device>
    <device name="arm" type="fakeMotionControl">
      <group name="GENERAL"><param name="Joints">6</param></group>
    </device>

Rules: cameras take `width` and `height`, joints the group GENERAL with `Joints` and `AxisName`, an
inertial unit `sensorName`, `frameName` and `constantValue`, a sensor with channels `channelsNum`, a
screen `width` and `height`, a laser `test`, `const_distance`, `map_file` (with `map_context` or
without), `localization_port` or `localization_server`, `clip_min`, `clip_max` and the group SENSOR
with `min_angle`, `max_angle` and `resolution`, a storage of maps `mapCollectionContext`,
`mapCollectionFile` and `mapLocationsFile`; the others take nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, Final

from yarpy.data.bottle import Bottle, Property
from yarpy.names.base import NameClient

#: What each is in `yarpy.kits.devices`.
_WITHOUT_OPTIONS: Final = {
    "fakeBattery": "SimulatedBattery",
    "fakeChatBotDevice": "SimulatedChatBot",
    "fakeJointCoupling": "SimulatedCoupling",
    "fakeJoypad": "SimulatedJoypad",
    "fakeLLMDevice": "SimulatedLanguageModel",
    "fakeLocalizer": "SimulatedBase",
    "fakeMicrophone": "SimulatedMicrophone",
    "fakeNavigation": "SimulatedBase",
    "fakeOdometry2D": "SimulatedBase",
    "fakePositionSensor": "SimulatedPositionSensor",
    "fakeSerialPort": "SimulatedSerialPort",
    "fakeSimulatedWorld": "SimulatedWorld",
    "fakeSpeaker": "SimulatedSpeaker",
    "fakeSpeechSynthesizer": "SimulatedSynthesizer",
    "fakeSpeechTranscription": "SimulatedTranscription",
    "robotDescriptionStorage": "DescriptionStorage",
}
_MOST: Final = 1000  # joints or channels: more than any robot has


def simulated(options: Property, *, names: NameClient | None = None) -> object:
    """Return the device of the type in `options`. Raises LookupError for none of these."""
    from yarpy.kits import devices

    make: Callable[[], object] = getattr(devices, _WITHOUT_OPTIONS[str(options.find("device", ""))])
    return make()


def camera(options: Property, *, names: NameClient | None = None) -> object:
    """Return `fakeFrameGrabber`. Raises ValueError for a size that is too large."""
    from yarpy.kits.devices import SimulatedCamera

    return SimulatedCamera(*_size(options))


def depth_camera(options: Property, *, names: NameClient | None = None) -> object:
    """Return `fakeDepthCamera`. Raises ValueError for a size that is too large."""
    from yarpy.kits.devices import SimulatedDepthCamera

    return SimulatedDepthCamera(*_size(options))


def joints(options: Property, *, names: NameClient | None = None) -> object:
    """Return `fakeMotionControl`. Raises ValueError for a number of joints that is none."""
    from yarpy.kits.devices import SimulatedJoints

    general = Property.from_bottle(options.group("GENERAL") or ())
    many = _count(general, "Joints", 4)
    called = [str(one) for one in values(general, "AxisName")]
    if called and len(called) != many:
        raise ValueError(f"GENERAL AxisName has {len(called)} names for {many} joints")
    return SimulatedJoints(called or [f"joint{number}" for number in range(many)])


def imu(options: Property, *, names: NameClient | None = None) -> object:
    """Return `fakeIMU`."""
    from yarpy.kits.devices import SimulatedImu

    return SimulatedImu(
        str(options.find("sensorName", "sensorName")),
        str(options.find("frameName", "frameName")),
        constant=_said(options, "constantValue"),
    )


def analog(options: Property, *, names: NameClient | None = None) -> object:
    """Return `fakeAnalogSensor`. Raises ValueError for a number of channels that is none."""
    from yarpy.kits.devices import SimulatedAnalogSensor

    return SimulatedAnalogSensor(_count(options, "channelsNum", 1))


def frame_writer(options: Property, *, names: NameClient | None = None) -> object:
    """Return `fakeFrameWriter`. Raises ValueError for a size that is too large."""
    from yarpy.kits.devices import SimulatedFrameWriter

    width, height = (options.find(key, 0) or 0 for key in ("width", "height"))
    return SimulatedFrameWriter(_size(options) if width or height else None)


def laser(options: Property, *, names: NameClient | None = None) -> object:
    """Return `fakeLaser`. Raises ValueError for settings that make no scan, OSError for a map that
    cannot be read, YarpError for who should say where it is."""
    from yarpy.kits.devices import LocalizedLaser, SimulatedLaser, load_grid

    scene = str(options.find("test", "use_pattern"))
    grid = load_grid(_map_file(options)) if scene == "use_mapfile" else None
    sensor = Property.from_bottle(options.group("SENSOR") or ())
    constant = Property.from_bottle(options.group("CONSTANT_MODE") or ())
    where = {
        key: str(options.find(f"localization_{key}", "") or "")
        for key in ("port", "server", "client")
    }
    make: Callable[..., object] = SimulatedLaser
    if scene == "use_mapfile" and (where["port"] or where["server"]):
        make = partial(LocalizedLaser, **where, names=names)
    return make(
        scene,
        grid=grid,
        angles=(_number(sensor, "min_angle", 0.0), _number(sensor, "max_angle", 360.0)),
        distances=(_number(options, "clip_min", 0.1), _number(options, "clip_max", 3.5)),
        step=_number(sensor, "resolution", 1.0),
        distance=_number(constant, "const_distance", _number(options, "const_distance", 1.0)),
    )


def map_storage(options: Property, *, names: NameClient | None = None) -> object:
    """Return `map2DStorage`. Raises ValueError for a collection that is nowhere, OSError and
    DecodeError for files that cannot be read."""
    from yarpy.kits.devices import MapStorage
    from yarpy.resource import ResourceFinder

    context = str(options.find("mapCollectionContext", "") or "")
    collection = str(options.find("mapCollectionFile", "maps_collection.ini"))
    places = str(options.find("mapLocationsFile", "locations.ini"))
    if not context:
        return MapStorage()
    found = ResourceFinder(context=context).file(collection)
    if found is None:
        raise ValueError(
            f"there is no file {collection} in the context {context}: make one, which may be "
            "empty, or say --mapCollectionFile"
        )
    return MapStorage(found.parent, found.name, places)


def _map_file(options: Property) -> str:
    """Return the path of the map. Raises ValueError for none."""
    from yarpy.resource import ResourceFinder

    name, context = (str(options.find(key, "") or "") for key in ("map_file", "map_context"))
    if not name:
        raise ValueError("use_mapfile needs a parameter map_file, a .map file of YARP")
    if not context:
        return name
    found = ResourceFinder(context=context).file(name)
    if found is None:
        raise ValueError(f"there is no file {name} in the context {context}")
    return str(found)


def values(options: Property, key: str) -> list[Any]:
    """Return the values of a parameter, given as a list or one after the other.

    >>> values(Property(a=Bottle([1, 2])), "a")
    [1, 2]
    """
    group = options.group(key) or Bottle([key])
    return [*(group[1] if len(group) == 2 and isinstance(group[1], list) else group[1:])]


def _number(options: Property, key: str, default: float) -> float:
    value = options.find(key, default)
    if not isinstance(value, (int, float)) or isinstance(value, bool):
        raise ValueError(f"{key} {value} is no number")
    return float(value)


def _count(options: Property, key: str, default: int) -> int:
    many = options.find(key, default)
    if not isinstance(many, int) or isinstance(many, bool) or not 0 < many <= _MOST:
        raise ValueError(f"{key} {many}: there are 1 to {_MOST}")
    return many


def _said(options: Property, key: str) -> bool:
    """Return whether a parameter is there, and is not false."""
    value = options.find(key)
    return value is not None and str(value).lower() not in ("false", "0")


def _size(options: Property) -> tuple[int, int]:
    size = options.find("width", 320), options.find("height", 240)
    if not all(isinstance(one, int) and 1 <= one <= 8192 for one in size):
        raise ValueError(f"{size[0]} x {size[1]}: each side must be 1 to 8192")
    return size
