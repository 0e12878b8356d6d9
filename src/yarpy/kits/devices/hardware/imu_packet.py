"""Packets of inertial units: WitMotion's frames of eleven bytes, and MTData2 of Xsens' MTi.

    witmotion(received)     ([("gyroscopes", (0.0, 1.5, 0.0)), ...], what may become a packet)

Rules: pure functions of bytes; what they find has the names and units of `multi_sensor.interface`.
What comes before a packet, and packets whose sum is wrong, is skipped. Neither maker gives magnetic
fields in tesla, so they are left out, and so is WitMotion's temperature, whose scale differs from
model to model. Numbers of Xsens are float32 or float64.

Source: WitMotion's standard protocol of the WT901; the MT low level protocol of Xsens.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from struct import unpack, unpack_from
from typing import Final, TypeAlias

#: The kind of a sensor, and its values.
Reading: TypeAlias = tuple[str, tuple[float, ...]]
#: Takes what came; returns what it says, and the rest, which may become a packet.
Split: TypeAlias = Callable[[bytes], tuple[list[Reading], bytes]]

GRAVITY: Final = 9.80665

_SIZE: Final = 11  # of all frames of WitMotion
_FRAMES: Final = range(0x50, 0x5F)
_WITMOTION: Final = {
    0x51: ("accelerometers", 16 * GRAVITY / 32768),
    0x52: ("gyroscopes", 2000 / 32768),
    0x53: ("orientations", 180 / 32768),
}

_MTDATA2: Final = 0x36
_EXTENDED: Final = 0xFF  # a length of two bytes follows
_LONGEST: Final = 2048
_NUMBERS: Final = {0: "f", 3: "d"}  # by the last two bits of what an item is
_TEMPERATURE, _QUATERNION, _EULER, _ACCELERATION, _TURN = 0x0810, 0x2010, 0x2030, 0x4020, 0x8020


def witmotion(received: bytes) -> tuple[list[Reading], bytes]:
    """Return what whole frames say, and the rest: 55, what it is, four int16, a sum."""
    found: list[Reading] = []
    while (at := received.find(0x55)) >= 0:
        received = received[at:]
        if len(received) < _SIZE:
            return found, received
        sums = sum(received[: _SIZE - 1]) & 0xFF == received[_SIZE - 1]
        if not sums or received[1] not in _FRAMES:
            received = received[1:]
            continue
        if (known := _WITMOTION.get(received[1])) is not None:
            kind, unit = known
            found.append((kind, tuple(one * unit for one in unpack_from("<3h", received, 2))))
        received = received[_SIZE:]
    return found, b""


def xsens(received: bytes) -> tuple[list[Reading], bytes]:
    """Return what whole messages MTData2 say, and the rest: FA FF, what it is, length, data, a
    sum."""
    found: list[Reading] = []
    while (at := received.find(b"\xfa\xff")) >= 0:
        received = received[at:]
        if len(received) < 6:
            return found, received
        body, length = 4, received[3]
        if length == _EXTENDED:
            body, length = 6, int.from_bytes(received[4:6], "big")
        end = body + length + 1
        if length <= _LONGEST and len(received) < end:
            return found, received
        if length > _LONGEST or sum(received[1:end]) & 0xFF:
            received = received[1:]
            continue
        if received[2] == _MTDATA2:
            found += _items(received[body : end - 1])
        received = received[end:]
    return found, received[-1:] if received.endswith(b"\xfa") else b""


def _items(data: bytes) -> Iterator[Reading]:
    while len(data) >= 3:
        what, size = int.from_bytes(data[:2], "big"), data[2]
        value, data = data[3 : 3 + size], data[3 + size :]
        form = _NUMBERS.get(what & 3)
        if form is None or len(value) != size or size % (width := 4 if form == "f" else 8):
            continue
        numbers = unpack(f">{size // width}{form}", value)
        # The other two bits say which way x, y and z of the earth point.
        reading = _reading(what & 0xFFF0, numbers)
        if reading is not None:
            yield reading


def _reading(what: int, numbers: tuple[float, ...]) -> Reading | None:
    if what == _TEMPERATURE and len(numbers) == 1:
        return "thermometers", numbers
    if what == _QUATERNION and len(numbers) == 4:
        return "orientations", euler(*numbers)
    if len(numbers) != 3:
        return None
    if what == _EULER:
        return "orientations", numbers
    if what == _ACCELERATION:
        return "accelerometers", numbers
    if what == _TURN:
        return "gyroscopes", tuple(map(math.degrees, numbers))
    return None


def euler(w: float, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Return the roll, pitch and yaw of a unit quaternion, degrees.

    >>> euler(1.0, 0.0, 0.0, 0.0)
    (0.0, 0.0, 0.0)
    """
    roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = math.asin(min(max(2 * (w * y - z * x), -1.0), 1.0))
    yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return math.degrees(roll), math.degrees(pitch), math.degrees(yaw)
