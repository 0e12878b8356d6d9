"""Converter: writes the messages of ports in the form that most programs understand.

    yarp/image        foxglove.RawImage         yarp/vector, yarp/matrix    Float64MultiArray
    yarp/pointcloud   foxglove.PointCloud       lists of numbers            Float64MultiArray
    yarp/sound        foxglove.RawAudio         lines of a log              foxglove.Log
    a laser           foxglove.LaserScan        stateExt:o of a board       foxglove.JointStates

Rules: pure, for one thread. It is in the way of everything that is recorded: what is of no form
costs next to nothing, and all others a few microseconds. What cannot be read is of no form.
"""

from __future__ import annotations

from yarpy.kits.record.form import numbers, sensor
from yarpy.kits.record.form.form import Bytes, Converted
from yarpy.kits.record.form.line import line
from yarpy.kits.record.form.structure import Structures
from yarpy.kits.record.kind import BOTTLE

_LAST = (1 << 63) - 1  # nanoseconds that a time of Foxglove has room for


class Converter:
    """Converts the messages of one recording."""

    def __init__(self) -> None:
        self._structures: dict[str, Structures] = {}

    def converted(self, port: str, kind: str, payload: Bytes, sent: int) -> Converted | None:
        """Return how a message is written; None for as it is. sent: nanoseconds since 1970."""
        if sent > _LAST:
            return None
        if kind == "yarp/image":
            return sensor.picture(payload, sent, port)
        if kind == "yarp/vector":
            found = numbers.vector(payload)
            return found if found is not None else self._numbers(port, payload, sent)
        if kind == BOTTLE:
            return line(payload, sent, port) or self._numbers(port, payload, sent)
        if kind == "yarp/matrix":
            return numbers.matrix(payload)
        if kind == "yarp/pointcloud":
            return sensor.cloud(payload, sent, port)
        return sensor.sound(payload, sent) if kind == "yarp/sound" else None

    def _numbers(self, port: str, payload: Bytes, sent: int) -> Converted | None:
        structures = self._structures.get(port)
        if structures is None:
            structures = self._structures[port] = Structures()
        found = structures.find(payload)
        if found is None:
            return None
        structure, values = found
        outline = structure.outline
        if len(outline) == sensor.SCAN_PARTS and sensor.is_scan(outline):
            return sensor.scan(values, payload, sent, port)
        if len(outline) in sensor.JOINT_PARTS and (count := sensor.joints_of(outline)):
            return sensor.joints(values, count, payload, sent)
        return numbers.numbers(values, payload)
