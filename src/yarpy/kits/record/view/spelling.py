"""The form in which messages of ports are sent to clients: pictures as JPEG, all others as JSON.

Rules: a picture is a `foxglove.CompressedImage` in protobuf, which every client shows; everything
else `{"t": seconds, "kind": "yarp/vector", "v": [numbers], "text": "..."}`, in JSON, clouds of
points and sounds with what is shown and heard of them (`media.py`). What cannot be read becomes a
text that says so: a client is never sent nothing. Long texts are cut.
"""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Final

from yarpy.data.bottle import Bottle
from yarpy.data.sig import jpeg
from yarpy.data.sig.image import Image
from yarpy.data.sig.pointcloud import PointCloud
from yarpy.data.sig.vector import Vector
from yarpy.errors import YarpError
from yarpy.kits.record.form.line import read_line
from yarpy.kits.record.form.protobuf import descriptor_set, encode, timestamp
from yarpy.kits.record.kind import kind_of
from yarpy.kits.record.recorded import Recorded
from yarpy.kits.record.view.foxglove import Channel
from yarpy.kits.record.view.labels import labels_of
from yarpy.kits.record.view.media import media_of

PICTURE: Final = "yarp/image"
NUMBERS: Final = 64  # of a message that are shown as curves
TEXT: Final = 4000  # characters of a message that are shown
_COMPRESSED: Final = "foxglove.CompressedImage"
_DEPTH: Final = 20  # lists in lists in which numbers are looked for
_SCHEMA: Final = json.dumps({"type": "object", "additionalProperties": True})
_QUALITY: Final = 75  # of JPEG


def channel_of(number: int, port: str, kind: str) -> Channel:
    """Return the channel of a port whose messages are of that kind."""
    if kind == PICTURE:
        schema = base64.b64encode(descriptor_set(_COMPRESSED)).decode()
        return Channel(number, port, "protobuf", _COMPRESSED, schema, "protobuf")
    return Channel(number, port, "json", kind or "yarp/bottle", _SCHEMA, "jsonschema")


def spelled(recorded: Recorded, kind: str) -> bytes:
    """Return a message as those of a port of that kind are spelled."""
    if kind == PICTURE:
        return encode(
            _COMPRESSED,
            {
                "timestamp": timestamp(max(0, recorded.sent_ns)),
                "data": picture(recorded),
                "format": "jpeg",
                "frame_id": recorded.port,
            },
        )
    there = kind_of(recorded.payload)
    found: dict[str, Any] = {"t": recorded.sent, "kind": there, **media_of(recorded, there)}
    values = numbers_of(recorded)
    if values:
        found["v"] = [value if math.isfinite(value) else None for value in values]
        names = labels_of(recorded, len(values))
        if names:
            found["names"] = names
    elif read_line(recorded.payload, recorded.port) is not None:
        found["log"] = True
    found["text"] = text_of(recorded)
    if recorded.envelope:
        found["envelope"] = recorded.envelope[:TEXT]
    return json.dumps(found).encode()


def picture(recorded: Recorded) -> bytes:
    """Return a picture as a JPEG file; nothing if it is none."""
    try:
        return jpeg.encode(Image.from_wire(recorded.payload), _QUALITY)
    except (YarpError, ValueError):
        return b""


def numbers_of(recorded: Recorded) -> list[float]:
    """Return the first numbers of a message, also those in lists; none of pictures and sounds, and
    of what says more in words."""
    if kind_of(recorded.payload) in (PICTURE, "yarp/sound", "yarp/pointcloud"):
        return []
    try:
        value = recorded.value
    except YarpError:
        return []
    if isinstance(value, Vector):  # however long it is
        return [float(number) for number in value.array[:NUMBERS]]
    found: list[float] = []
    words = 0
    for item in _items(value, _DEPTH):
        if isinstance(item, str):
            words += 1
        else:
            found.append(item)
        if len(found) == NUMBERS or words > NUMBERS:
            break
    return found if len(found) > words else []


def _items(value: Any, depth: int) -> Iterator[float | str]:
    """Yield the numbers and words of a value."""
    if isinstance(value, bool | int | float):
        try:
            yield float(value)
        except OverflowError:
            yield math.inf
    elif isinstance(value, str):
        yield value
    elif not depth or isinstance(value, bytes):
        return
    elif isinstance(value, Mapping):
        for one in value.values():
            yield from _items(one, depth - 1)
    elif isinstance(value, Iterable):
        for one in value:
            yield from _items(one, depth - 1)


def text_of(recorded: Recorded) -> str:
    """Return a message as YARP spells it for people, or why it cannot be read."""
    kind = kind_of(recorded.payload)
    try:
        if kind == "yarp/pointcloud":  # which does not say itself that it is one
            text = repr(recorded.as_(PointCloud))
        elif kind in (PICTURE, "yarp/sound"):
            text = repr(recorded.value)
        else:
            text = recorded.as_(Bottle).to_text()
    except YarpError as error:
        text = f"{len(recorded.payload)} bytes that cannot be read: {error}"
    return text if len(text) <= TEXT else f"{text[:TEXT]} ... ({len(text)} characters)"
