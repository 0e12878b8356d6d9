"""The part that ROS 1 and ROS 2 share: the messages that values become, and the services.

    NativeObject   std_msgs/String with JSON
    Image          sensor_msgs/Image, or CompressedImage for JPEG files; it says bgr8, and so it is
    AudioChunk     the message of Wrapyfi's own interfaces, whose definition is brought along
    ROSMessage     any message; ROS2Message over ROS 2

Rules: messages are those of yarpy; objects of rospy and rclpy are taken, too, and given to programs
that have loaded rospy's classes. Other pixels than those that are declared are converted.
"""

from __future__ import annotations

import io
import sys
import time
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

import yarpy
from wrapyfi.middlewares._form import Native, Picture, Sound
from yarpy.peers.ros.message.convert.picture import decompressed, image_of
from yarpy.peers.ros.message.message import Message

_AUDIO = """\
std_msgs/Header header
uint32 chunk_size
uint8 channels
uint32 sample_rate
string encoding
uint8 is_bigendian
uint32 bitrate
string coding_format
uint32 step
uint8[] data
"""
_CODES = {(True, False): "bgr", (False, False): "mono", (True, True): "rgb.", (False, True): "dec"}
_ENCODINGS = {"bgr": "bgr8", "mono": "mono8", "rgb.": "32FC3", "dec": "32FC1"}

#: Wrapyfi's packages of interfaces
INTERFACES = {
    "msg wrapyfi_ros_interfaces/ROSAudioMessage": _AUDIO,
    "srv wrapyfi_ros_interfaces/ROSAudioService": (
        "string request\n---\nwrapyfi_ros_interfaces/ROSAudioMessage response\n"
    ),
    "msg wrapyfi_ros2_interfaces/ROS2AudioMessage": _AUDIO,
    "srv wrapyfi_ros2_interfaces/ROS2AudioService": (
        "string request\n---\nwrapyfi_ros2_interfaces/ROS2AudioMessage response\n"
    ),
    "srv wrapyfi_ros2_interfaces/ROS2NativeObjectService": (
        "string request\n---\nstring response\n"
    ),
    "srv wrapyfi_ros2_interfaces/ROS2ImageService": (
        "string request\n---\nsensor_msgs/Image response\n"
    ),
    "srv wrapyfi_ros2_interfaces/ROS2CompressedImageService": (
        "string request\n---\nsensor_msgs/CompressedImage response\n"
    ),
}


class Interfaces:
    """A source of these definitions, for a library of types; asked behind those that are there."""

    def find(self, name: str, kind: str) -> str | None:
        return INTERFACES.get(f"{kind} {name}")

    def __str__(self) -> str:
        return "yarpy-wrapyfi"


def stamped(message: Any) -> Any:
    """The message, with the present time in its header."""
    now = time.time()
    secs, nsecs = int(now), int(now % 1.0 * 1e9)
    stamp = message.header.stamp
    if isinstance(stamp, tuple):
        message.header.stamp = type(stamp)(secs, nsecs)
    else:
        stamp.sec, stamp.nanosec = secs, nsecs
    return message


class TextForm(Native):
    """JSON, in a String."""

    nothing: Any = None
    type = "std_msgs/String"

    def spelled(self, obj: Any) -> Any:
        return self.text(obj)

    def value(self, came: Any) -> Any:
        return self.of_text(came)


class PictureForm:
    """A picture. `load` finds a type by its name."""

    nothing: Any = None

    def __init__(self, options: dict[str, Any], load: Callable[[str], Any]) -> None:
        self._picture = Picture(options)
        self._load = load
        self.type = f"sensor_msgs/{'CompressedImage' if self._picture.jpg else 'Image'}"

    def spelled(self, obj: Any) -> Any:
        if obj is None:
            return None
        picture, kind = self._picture, self._load(self.type)
        array = picture.checked(obj)
        if picture.jpg:
            data = np.frombuffer(picture.file(array), "u1")
            return stamped(kind(format="jpeg", data=data))
        message = kind(
            height=array.shape[0],
            width=array.shape[1],
            encoding=_ENCODINGS[_CODES[picture.rgb, picture.fp]],
            is_bigendian=int(sys.byteorder == "big"),
            step=array.strides[0],
            data=array.reshape(-1).view("u1"),
        )
        return stamped(message)

    def value(self, came: Any) -> Any:
        image = decompressed(came) if came._type.endswith("CompressedImage") else image_of(came)
        found = image.converted(_CODES[self._picture.rgb, self._picture.fp])
        return self._picture.checked(found.array).copy()


class SoundForm:
    """Samples as float32, which are called S16LE."""

    def __init__(self, options: dict[str, Any], load: Callable[[str], Any], type_: str) -> None:
        self._sound = Sound(options)
        self._load = load
        self.type = type_
        self.nothing: Any = (None, self._sound.rate)

    def spelled(self, obj: Any) -> Any:
        found = None if obj is None else self._sound.checked(obj)
        if found is None:
            return None
        samples, rate = found
        samples = np.ascontiguousarray(samples)
        big = sys.byteorder == "big"
        return stamped(
            self._load(self.type)(
                chunk_size=len(samples),
                channels=samples.shape[1],
                sample_rate=rate,
                encoding="S16BE" if big else "S16LE",
                is_bigendian=int(big),
                step=samples.strides[0],
                data=samples.reshape(-1).view("u1"),
            )
        )

    def value(self, came: Any) -> Any:
        data = np.ascontiguousarray(came.data, "u1")
        chunk, channels = came.chunk_size, came.channels
        if len(data) != chunk * channels * 4:
            raise yarpy.DecodeError(
                f"a sound of {chunk} times {channels} samples in {len(data)} bytes"
            )
        samples = data.view(">f4" if came.is_bigendian else "<f4").reshape(chunk, channels)
        return samples.astype("f4"), came.sample_rate


class AnyForm:
    """A message; its type is known with the first one."""

    nothing: Any = None

    def __init__(self, options: dict[str, Any], load: Callable[[str], Any]) -> None:
        self._load = load
        self.type: Any = None

    def spelled(self, obj: Any) -> Any:
        if obj is None:
            return None
        message = ours(obj, self._load)
        self.type = type(message)
        return message

    def value(self, came: Any) -> Any:
        return theirs(came)


def ours(message: Any, load: Callable[[str], Any]) -> Any:
    """A message of rospy or rclpy as one of yarpy. Raises TypeError for what is none."""
    if isinstance(message, Message):
        return message
    if hasattr(message, "serialize") and hasattr(message, "_type"):
        buffer = io.BytesIO()
        message.serialize(buffer)
        return load(message._type).from_ros(bytearray(buffer.getvalue()))
    if hasattr(message, "get_fields_and_field_types"):
        kind = type(message)
        return load(f"{kind.__module__.partition('.')[0]}/{kind.__name__}").from_bottle(
            _fields(message)
        )
    raise TypeError(f"{type(message).__name__} is no message of ROS")


def _fields(message: Any) -> Any:
    """The fields of a message of rclpy, by their names."""
    if hasattr(message, "get_fields_and_field_types"):
        return {name: _fields(getattr(message, name)) for name in _names(message)}
    if isinstance(message, (list, tuple)):
        return [_fields(one) for one in message]
    return message


def _names(message: Any) -> list[str]:
    return [*message.get_fields_and_field_types()]


def theirs(message: Any) -> Any:
    """A message of yarpy as one of rospy, where the program has loaded that class; else itself."""
    package, _, name = message._type.partition("/")
    known = getattr(sys.modules.get(f"{package}.msg"), name, None)
    if known is None or getattr(known, "_md5sum", "") != message._md5sum:
        return message
    return known().deserialize(b"".join(message.to_ros()))


class FieldedService:
    """How a service is asked whose halves have the fields `request` and `response`."""

    def __init__(self, kind: Any) -> None:
        self.kind = kind

    def question(self, text: str) -> Any:
        return self.kind.Request(request=text)

    def text(self, question: Any) -> str:
        return str(question.request)

    def answer(self, spelled: Any) -> Any:
        return self.kind.Response(response=spelled)

    def content(self, response: Any) -> Any:
        return response.response


def ros_forms(load: Callable[[str], Any], audio: str, any_: str) -> dict[str, Any]:
    """The forms of topics, by type."""
    return {
        "NativeObject": TextForm,
        "Image": partial(PictureForm, load=load),
        "AudioChunk": partial(SoundForm, load=load, type_=audio),
        any_: partial(AnyForm, load=load),
    }
