"""sensorMeasurements_to_vector: position and orientation from a stream of sensors.

Takes the stream of a multi-sensor server on `/measures:o` (ten lists, by kind of sensor) and
returns a Vector of six: x, y, z of the only position sensor, then the three angles of the only
orientation sensor. As in C++ YARP, messages with none or several of either are refused.
"""

from __future__ import annotations

from typing import Any

from yarpy.data.bottle import Bottle
from yarpy.data.sig.vector import Vector
from yarpy.errors import DecodeError
from yarpy.monitors.base import Place
from yarpy.wire.message import Message

_ORIENTATION, _POSITION = 3, 9  # places in the message


class SensorPose:
    """Six numbers for a pose."""

    def __init__(self, place: Place) -> None:
        pass

    def update(self, message: Message) -> Vector:
        kinds = message.as_(Bottle)
        if len(kinds) <= _POSITION:
            raise DecodeError(f"expected ten lists of sensors, got {len(kinds)}")
        return Vector([*_three(kinds[_POSITION]), *_three(kinds[_ORIENTATION])])


def _three(sensors: Any) -> list[float]:
    """The three numbers of the only sensor of a kind."""
    match sensors:
        case [[[x, y, z], *_]] if all(type(v) in (int, float) for v in (x, y, z)):
            return [x, y, z]
    raise DecodeError("expected exactly one position and one orientation sensor, of 3 numbers each")
