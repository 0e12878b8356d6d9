"""The data of sensors as Foxglove's messages: pictures, points in space, sounds, distances, joints.

Rules: pure. Pixels, points and the samples of one channel are there once, in YARP's bytes. None is
what Foxglove has no form for: it is kept as it is.
"""

from __future__ import annotations

import math
from struct import Struct
from typing import Any, Final

from yarpy.data.sig.image import Image
from yarpy.data.sig.pointcloud import KINDS, PointCloud
from yarpy.data.sig.sound import Sound
from yarpy.errors import YarpError
from yarpy.kits.record.form.form import Bytes, Converted, Form
from yarpy.kits.record.form.protobuf import descriptor_set, encode, key, timestamp, varint


def form_of(schema: str, body: int = 0) -> Form:
    """Return the form of a type of Foxglove; `body` is the field with bytes of YARP."""
    name = f"protobuf {body}" if body else "protobuf"
    return Form(name, "protobuf", schema, "protobuf", descriptor_set(schema))


PICTURE: Final = form_of("foxglove.RawImage", 6)
CLOUD: Final = form_of("foxglove.PointCloud", 6)
MONO_SOUND: Final = form_of("foxglove.RawAudio", 2)
SOUND: Final = form_of("foxglove.RawAudio")
SCAN: Final = form_of("foxglove.LaserScan")
JOINTS: Final = form_of("foxglove.JointStates")

#: YARP's pixels by Foxglove's names
PIXELS: Final = {
    "mono": "mono8", "mo16": "mono16", "rgb": "rgb8", "bgr": "bgr8", "rgba": "rgba8",
    "bgra": "bgra8", "dec": "32FC1", "grbg": "bayer_grbg8", "bggr": "bayer_bggr8",
    "gbrg": "bayer_gbrg8", "rggb": "bayer_rggb8",
}  # fmt: skip
_IMAGE_HEAD: Final = 60  # bytes in front of the pixels
_CLOUD_HEAD: Final = 21
_SOUND_HEAD: Final = Struct("<10i")
_COLOURS: Final = {"r": "red", "g": "green", "b": "blue", "a": "alpha"}
_POSE: Final = {"position": {}, "orientation": {"w": 1.0}}
_UINT8, _FLOAT32 = 1, 7  # of PackedElementField
JOINT_PARTS: Final = (22, 24)  # elements of what a control board sends
SCAN_PARTS: Final = 6


def picture(payload: Bytes, sent: int, frame: str) -> Converted | None:
    """Return a picture, taken at `sent` (nanoseconds since 1970) by `frame`."""
    try:
        image = Image.found(payload)
    except YarpError:
        return None
    if image is None or not image.top_down or not (image.width and image.height):
        return None
    pixels = PIXELS.get(str(image.code))
    size = len(payload) - _IMAGE_HEAD
    step = size // image.height
    if pixels is None or step * image.height != size or image.array.strides[0] != step:
        return None
    values = {
        "timestamp": timestamp(sent), "width": image.width, "height": image.height,
        "encoding": pixels, "step": step, "frame_id": frame,
    }  # fmt: skip
    return _split(PICTURE, encode(PICTURE.schema, values), payload, _IMAGE_HEAD)


def cloud(payload: Bytes, sent: int, frame: str) -> Converted | None:
    """Return points in space."""
    try:
        points = PointCloud.from_wire(payload)
    except YarpError:
        return None
    kind = KINDS[points.kind]
    if len(payload) != _CLOUD_HEAD + kind.size * len(points) or not len(points):
        return None
    fields = [{"name": one, "offset": at, "type": _FLOAT32} for one, at in kind.floats.items()]
    fields += [
        {"name": _COLOURS.get(one, one), "offset": at, "type": _UINT8}
        for one, at in kind.bytes.items()
    ]
    values = {
        "timestamp": timestamp(sent), "frame_id": frame, "pose": _POSE,
        "point_stride": kind.size, "fields": fields,
    }  # fmt: skip
    return _split(CLOUD, encode(CLOUD.schema, values), payload, _CLOUD_HEAD)


def sound(payload: Bytes, sent: int) -> Converted | None:
    """Return a sound."""
    try:
        samples = Sound.from_wire(payload)
    except YarpError:
        return None
    if samples.frequency <= 0 or not samples.length or not 0 < samples.channels < 1 << 16:
        return None
    values: dict[str, Any] = {
        "timestamp": timestamp(sent), "format": "pcm-s16",
        "sample_rate": samples.frequency, "number_of_channels": samples.channels,
    }  # fmt: skip
    if samples.channels == 1 and len(payload) == _SOUND_HEAD.size + 2 * samples.length:
        return _split(MONO_SOUND, encode(SOUND.schema, values), payload, _SOUND_HEAD.size)
    data = samples.array.T.astype("<i2").tobytes()  # sample by sample, not channel by channel
    return Converted(SOUND, encode(SOUND.schema, {**values, "data": data}), b"", payload)


def _split(form: Form, front: bytes, payload: Bytes, start: int) -> Converted:
    """Return a message whose last field for others is what follows `start` of the payload."""
    view, number = memoryview(payload), int(form.name.rpartition(" ")[2])
    head = key(number) + varint(len(view) - start)
    return Converted(form, front + head, view[start:], view[:start])


def is_scan(outline: tuple[Any, ...]) -> bool:
    """Return whether numbers are those of a laser: four of them, the distances, the state."""
    return (
        len(outline) == SCAN_PARTS
        and outline[:4] == ("d",) * 4
        and isinstance(outline[4], tuple)
        and set(outline[4]) == {"d"}
        and outline[5] == "i"
    )


def scan(values: tuple[float, ...], payload: Bytes, sent: int, frame: str) -> Converted:
    """Return what a laser has seen; angles come in degrees."""
    told = {
        "timestamp": timestamp(sent), "frame_id": frame, "pose": _POSE,
        "start_angle": math.radians(values[0]), "end_angle": math.radians(values[1]),
        "ranges": values[4:-1],
    }  # fmt: skip
    return Converted(SCAN, encode(SCAN.schema, told), b"", payload)


def joints_of(outline: tuple[Any, ...]) -> int:
    """Return of how many joints numbers tell, as a control board sends them; 0 if it is something
    else."""
    if len(outline) not in JOINT_PARTS or set(outline[1::2]) != {"v"}:
        return 0
    lists = outline[::2]
    if not all(isinstance(one, tuple) and len(one) == len(lists[0]) for one in lists):
        return 0
    return len(lists[0]) if set(lists[0]) == {"d"} else 0


def joints(values: tuple[float, ...], count: int, payload: Bytes, sent: int) -> Converted:
    """Return the state of `count` joints, in radians; what is not measured is 0."""
    places, speeds, gains = (values[n * count : (n + 1) * count] for n in range(3))
    efforts = values[6 * count : 7 * count]
    told = [
        {
            "name": f"joint_{n}",
            "position": math.radians(places[n]),
            "velocity": math.radians(speeds[n]),
            "acceleration": math.radians(gains[n]),
            "effort": efforts[n],
        }
        for n in range(count)
    ]
    values_ = {"timestamp": timestamp(sent), "joints": told}
    return Converted(JOINTS, encode(JOINTS.schema, values_), b"", payload)
