"""Messages as one line of text for people: lists as Bottle text, all else by what it is.

Rules: what a message says for programs in Python alone, the types of its elements, is left out;
scripts that need them take JSON. Arrays, pictures, sounds and clouds of points are told in short.
"""

from __future__ import annotations

from typing import Any, Final

import yarpy
from yarpy.data.python.array import is_array
from yarpy.data.python.description import KEY

SHORT: Final = 16  # elements of an array that are shown


def text_of(message: yarpy.Message, bottle: yarpy.Bottle) -> str:
    """Return the line for a message that is a Bottle, `bottle`."""
    if is_described(bottle):
        value = message.value
        if is_array(value) and value.size > SHORT:
            return summary(value)
        plain = _plain(value)
        return yarpy.Bottle(plain if isinstance(value, (list, tuple, dict)) else [plain]).to_text()
    value = message.value
    if isinstance(value, yarpy.Image):
        return f"{summary(value)[:-1]}, {len(message.payload)} bytes>"
    return bottle.to_text()


def is_described(bottle: yarpy.Bottle) -> bool:
    """Return whether a program in Python has said of which of its types the elements are."""
    last = bottle[-1] if bottle else None
    return isinstance(last, list) and last[:1] == [KEY]


def summary(value: Any) -> str:
    """Return what a picture, a sound, a cloud of points or an array is."""
    if isinstance(value, yarpy.Image):
        return f"<image {value.code} {value.width}x{value.height}>"
    if isinstance(value, yarpy.Sound):
        of = "1 channel" if value.channels == 1 else f"{value.channels} channels"
        return f"<sound {value.frequency} Hz, {of}, {value.length} samples>"
    if isinstance(value, yarpy.PointCloud):
        return f"<pointcloud {value.kind} {value.width}x{value.height}, {len(value)} points>"
    return f"<array {value.dtype} {'x'.join(map(str, value.shape))}>"


def _plain(value: Any) -> Any:
    """Return the same with nothing in it that Bottle text cannot show."""
    if isinstance(value, dict):
        return [[key, _plain(item)] for key, item in value.items()]
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if value is None:
        return []
    if isinstance(value, complex):
        return [value.real, value.imag]
    if isinstance(value, (yarpy.Image, yarpy.Sound, yarpy.PointCloud)):
        return summary(value)
    if is_array(value):
        return _plain(value.tolist()) if value.size <= SHORT else summary(value)
    return value
