"""YARP's own types as messages of ROS, and back: what a port writes, for a topic; what comes from a
topic, for a reader.

    Image               sensor_msgs/Image, sensor_msgs/CompressedImage (JPEG)
    Vector, Matrix      std_msgs/Float64MultiArray and its kin; a Vector sensor_msgs/JointState too,
                        and a list of numbers where one of these is wanted
    PointCloud          sensor_msgs/PointCloud2
    Sound               audio_common_msgs/AudioData: 16 bits, channels in turns
    Stamp               std_msgs/Header
    str, int, float, bool, Bottle, dict, whatever else       by the structure of the type

Rules: pixels, points and numbers are not copied where both have them alike. No clock: time comes
with the message's Stamp. A value that the type cannot hold is a DecodeError that names the field.
"""

from __future__ import annotations

from typing import Any, Final

from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.data.sig.image import Image
from yarpy.data.sig.matrix import Matrix
from yarpy.data.sig.pointcloud import PointCloud
from yarpy.data.sig.sound import Sound
from yarpy.data.sig.vector import Vector
from yarpy.data.stamp import Stamp
from yarpy.errors import DecodeError
from yarpy.peers.ros.message.convert.cloud import cloud_message, cloud_of
from yarpy.peers.ros.message.convert.picture import (
    compressed_message,
    decompressed,
    image_message,
    image_of,
)
from yarpy.peers.ros.message.fault import array_of
from yarpy.peers.ros.message.message import Message, Time

#: the type of a topic that nobody gave another, by what is written there first
TYPES: Final = {
    Image: "sensor_msgs/Image",
    Vector: "std_msgs/Float64MultiArray",
    Matrix: "std_msgs/Float64MultiArray",
    PointCloud: "sensor_msgs/PointCloud2",
    Sound: "audio_common_msgs/AudioData",
    Stamp: "std_msgs/Header",
    str: "std_msgs/String",
    bool: "std_msgs/Bool",
    int: "std_msgs/Int32",
    float: "std_msgs/Float64",
}

_NATIVE: Final = {
    "sensor_msgs/Image": Image,
    "sensor_msgs/CompressedImage": Image,
    "sensor_msgs/PointCloud2": PointCloud,
}

#: of sound that says nothing about itself: what ROS's audio_capture sends unless told otherwise
RATE: Final = 16000


def type_for(value: Any) -> str | None:
    """The name of the ROS type that a value naturally becomes; None for Bottles and others, which
    need one that is given."""
    if isinstance(value, Message):
        return value._type
    return next((name for kind, name in TYPES.items() if isinstance(value, kind)), None)


def natural_type(value: Any) -> str | None:
    """As `type_for`, also for a list of one such value, and for a list of numbers."""
    while isinstance(value, list | tuple) and len(value) == 1:
        value = value[0]
    return TYPES[Vector] if are_numbers(value) else type_for(value)


def to_message(
    value: Any, cls: type[Message], stamp: Stamp | None = None, frame_id: str = ""
) -> Message:
    """A value that a port writes as a message of `cls`.

    `stamp` (the envelope) and `frame_id` go into the header of what YARP itself has none for.
    DecodeError, TypeError or ValueError if it cannot be.
    """
    if isinstance(value, cls):
        return value
    if isinstance(value, (str, dict)):
        return cls.from_bottle(value)
    name = cls._type
    if isinstance(value, Image) and name == "sensor_msgs/Image":
        return image_message(value, cls, _header(cls, stamp, frame_id))
    if isinstance(value, Image) and name == "sensor_msgs/CompressedImage":
        return compressed_message(value, cls, _header(cls, stamp, frame_id))
    if isinstance(value, PointCloud) and name == "sensor_msgs/PointCloud2":
        return cloud_message(value, cls, _header(cls, stamp, frame_id))
    if (name == "sensor_msgs/JointState" or _is_multi_array(cls)) and are_numbers(value):
        value = Vector([*value])
    if isinstance(value, (Vector, Matrix)) and _is_multi_array(cls):
        return _multi_array(value, cls)
    if isinstance(value, Vector) and name == "sensor_msgs/JointState":
        return cls(header=_header(cls, stamp, frame_id), position=value.array)
    if isinstance(value, Sound) and name == "audio_common_msgs/AudioData":
        return cls(data=value.array.T.tobytes() if value.channels > 1 else _bytes(value))
    if isinstance(value, Stamp) and name == "std_msgs/Header":
        return _filled(cls, value, frame_id)
    if isinstance(value, Message):
        raise TypeError(f"a {value._type} is no {name}")
    if isinstance(value, (list, tuple, int, float, Vector)) or value is None:
        return cls.from_bottle([] if value is None else value)
    return cls.from_bottle(codec.decode(b"".join(codec.encode(value))))


def to_value(message: Any, kind: Any = object) -> Any:
    """Return what a reader gets for a message: for `object` an Image if it is a sensor_msgs/Image,
    otherwise a Bottle; for a type of YARP a value of that type. DecodeError if there is no
    conversion."""
    name = message._type
    if kind is object:
        return image_of(message) if name == "sensor_msgs/Image" else message.to_bottle()
    if isinstance(message, kind):
        return message
    if kind is Image and name == "sensor_msgs/Image":
        return image_of(message)
    if kind is Image and name == "sensor_msgs/CompressedImage":
        return decompressed(message)
    if kind is PointCloud and name == "sensor_msgs/PointCloud2":
        return cloud_of(message)
    if kind is Vector and (_is_multi_array(type(message)) or name == "sensor_msgs/JointState"):
        return _vector(message.position if name == "sensor_msgs/JointState" else message.data)
    if kind is Matrix and _is_multi_array(type(message)):
        return _matrix(message)
    if kind is Sound and name == "audio_common_msgs/AudioData":
        return _sound(message)
    if kind is Stamp:
        found = stamp_of(message)
        if found is not None:
            return found
    return codec.decode_as(message.to_bottle().to_bytes(), kind)


def to_native(message: Any) -> Any:
    """Return a value of YARP's own type for a message, where there is one that keeps all that it
    says of itself: an Image, a PointCloud, a Vector. Else its only field if that is a number or
    text, or a Bottle. Raises DecodeError."""
    name = message._type
    if name in _NATIVE:
        return to_value(message, _NATIVE[name])
    if _is_multi_array(type(message)) and not message.layout.dim:
        return _vector(message.data)
    found = to_value(message)
    alone = (
        isinstance(found, Bottle) and len(found) == 1 and isinstance(found[0], str | int | float)
    )
    return found[0] if alone else found


def are_numbers(value: object) -> bool:
    """Return whether a value is a list of numbers alone, as ports send the angles of joints."""
    if not isinstance(value, (list, tuple)) or not value:
        return False
    return all(isinstance(item, (int, float)) for item in value)


def stamp_of(message: Any) -> Stamp | None:
    """Number and time in the header of a message, or of the header itself; None if it has none."""
    header = message if message._type == "std_msgs/Header" else getattr(message, "header", None)
    if not isinstance(header, Message) or header._type != "std_msgs/Header":
        return None
    found: Any = header
    if isinstance(found.stamp, Message):  # ROS 2, which does not count
        seconds: Any = found.stamp
        return Stamp(0, seconds.sec + seconds.nanosec / 1e9)
    return Stamp(found.seq & 0x7FFFFFFF, Time(*found.stamp).to_sec())


def _header(cls: type[Message], stamp: Stamp | None, frame_id: str) -> Any:
    header: Any = next(used for used in cls._used.values() if used._type == "std_msgs/Header")
    if stamp is None or not stamp.valid:
        return header(frame_id=frame_id)
    return _filled(header, stamp, frame_id)


def _filled(header: type[Message], stamp: Stamp, frame_id: str) -> Message:
    """A header with number and time, or with the time alone in ROS 2."""
    time = _time(stamp.time)
    if "seq" in header._names:
        return header(max(stamp.count, 0), time, frame_id)
    times = next(iter(header._used.values()))
    return header(times(min(time.secs, (1 << 31) - 1), time.nsecs), frame_id)


def _time(seconds: float) -> Time:
    """A time of ROS; 0 for what it has no numbers for."""
    return Time.from_sec(seconds) if 0 <= seconds < (1 << 32) - 1 else Time()


def _is_multi_array(cls: type[Message]) -> bool:
    return cls._type.startswith("std_msgs/") and cls._names == ("layout", "data")


def _multi_array(value: Vector | Matrix, cls: type[Message]) -> Message:
    used = {each._type: each for each in cls._used.values()}
    layout, dimension = (used[f"std_msgs/MultiArray{name}"] for name in ("Layout", "Dimension"))
    shape = value.array.shape
    names = ("rows", "columns") if len(shape) == 2 else ("",)
    sizes = [shape[0] * shape[1], shape[1]] if len(shape) == 2 else [shape[0]]
    dims = [
        dimension(name, size, stride)
        for name, size, stride in zip(names, shape, sizes, strict=True)
    ]
    return cls(layout(dims), value.array.ravel())


def _vector(numbers: Any) -> Vector:
    import numpy as np

    array = np.asarray(numbers)
    if array.dtype.kind in "ub":
        if array.dtype.itemsize == 8 and array.size and int(array.max()) >> 63:
            raise DecodeError("a number beyond 63 bits does not fit in a Vector")
        array = array.astype("i8" if array.dtype.itemsize > 2 else "i4")
    return Vector(array, dtype=array.dtype)


def _matrix(message: Any) -> Matrix:
    import numpy as np

    sizes = [dimension.size for dimension in message.layout.dim]
    numbers = np.asarray(message.data)[message.layout.data_offset :]
    if len(sizes) != 2 or sizes[0] * sizes[1] != len(numbers):
        raise DecodeError(f"{len(numbers)} numbers with the sizes {sizes[:8]} are no Matrix")
    return Matrix(numbers.reshape(sizes))


def _bytes(sound: Sound) -> memoryview:
    return sound.array.data.cast("B") if sound.length else memoryview(b"")


def _sound(message: Any) -> Sound:
    import numpy as np

    data = np.ascontiguousarray(array_of(message.data, np.dtype("u1"), f"{message._type}.data"))
    if len(data) % 2:
        raise DecodeError(f"{len(data)} bytes are no samples of 16 bits")
    return Sound(data.view("<i2"), RATE)
