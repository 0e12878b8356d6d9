"""Labels: the names and units of the numbers on a device's port, as the device gives them.

    /robot/part/state:o, stateExt:o    the joints that /robot/part/rpc:i names
    /robot/imu/measures:o              the sensors that /robot/imu/rpc:o names

Rules: a device is asked over a connection that needs no port, for at most `TIMEOUT` seconds. There
are no labels for a device that does not answer, or sends something other than it announces.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from itertools import zip_longest
from typing import Any, Final, TypeAlias

import yarpy
from yarpy.kits.devices.kind import JOINT_TYPE
from yarpy.kits.devices.multi_sensor.client import read_names
from yarpy.kits.devices.multi_sensor.interface import KINDS
from yarpy.names.base import NameClient
from yarpy.port.connect.probe import Caller

TIMEOUT: Final = 4.0  # seconds for all questions to a device
JOINTS: Final = 256  # most joints asked for their names

#: The name and the unit of an element of a message, "" for those that have none.
Label: TypeAlias = tuple[str, str]
#: The labels of all elements of a message and its lists; none for a different kind of message.
Describe: TypeAlias = Callable[[Any], list[Label]]

_NONE: Final[Label] = ("", "")
# The end of a port's name -> the end of the name of the port to ask.
_RPC: Final = {"/state:o": "/rpc:i", "/stateExt:o": "/rpc:i", "/measures:o": "/rpc:o"}
# The lists of stateExt:o, in order, with the unit for a revolute joint; a prismatic one has the
# robot's own unit.
_STATE: Final = (
    ("position", "°"),
    ("speed", "°/s"),
    ("acceleration", "°/s²"),
    ("motor position", "°"),
    ("motor speed", "°/s"),
    ("motor acceleration", "°/s²"),
    ("torque", "Nm"),
    ("duty cycle", "%"),
    ("current", "A"),
    ("control mode", ""),
    ("interaction mode", ""),
)
_TURNING: Final = ("°", "°/s", "°/s²", "Nm")
_XYZ: Final = ("x", "y", "z")
# For each kind of sensor its name, what its numbers are called, and their units.
_SENSORS: Final[dict[str, tuple[str, Sequence[str], Sequence[str]]]] = {
    "gyroscopes": ("gyroscope", _XYZ, ["°/s"] * 3),
    "accelerometers": ("accelerometer", _XYZ, ["m/s²"] * 3),
    "magnetometers": ("magnetometer", _XYZ, ["T"] * 3),
    "orientations": ("orientation", ("roll", "pitch", "yaw"), ["°"] * 3),
    "thermometers": ("temperature", ("",), ["°C"]),
    "force_torques": (
        "force and torque",
        ("fx", "fy", "fz", "tx", "ty", "tz"),
        ["N"] * 3 + ["Nm"] * 3,
    ),
    "contact_loads": ("load", (), ()),
    "encoder_arrays": ("encoder", (), ()),
    "skin_patches": ("skin", (), ()),
    "position_sensors": ("position", _XYZ, ["m"] * 3),
    "linear_velocities": ("velocity", _XYZ, ["m/s"] * 3),
    "angular_accelerations": ("angular acceleration", _XYZ, ["°/s²"] * 3),
}


def rpc_of(name: str) -> str:
    """The port to ask about what `name` sends; "" if by convention there is none."""
    for end, rpc in _RPC.items():
        if name.endswith(end):
            return name.removesuffix(end) + rpc
    return ""


def learn(name: str, names: NameClient | None = None) -> Describe | None:
    """Ask what the port `name` sends; None if unknown. Waits at most `TIMEOUT` seconds."""
    deadline = time.monotonic() + TIMEOUT
    try:
        contact = yarpy.query(rpc_of(name), names)
        if contact is None:
            return None
        with Caller(contact, timeout=TIMEOUT) as caller:

            def ask(question: str) -> Any:
                left = max(deadline - time.monotonic(), 0.01)
                answer = caller.ask(yarpy.Bottle.from_text(question), left)
                return answer.as_(yarpy.Bottle) if answer is not None else []

            if name.endswith("/measures:o"):
                sensors = read_names(ask("getMetadata"))
                return lambda value: _sensor_labels(value, sensors)
            joints = [_joint(ask, number) for number in range(min(int(ask("get axes")[2]), JOINTS))]
    except (yarpy.YarpError, OSError, TypeError, ValueError, LookupError):
        return None
    if name.endswith("/stateExt:o"):
        return lambda value: _state_labels(value, joints)
    return lambda value: _position_labels(value, joints)


def _joint(ask: Callable[[str], Any], number: int) -> tuple[str, bool]:
    """The name of a joint, and whether it is prismatic; if unknown, it is revolute."""
    name = str(ask(f"get name {number}")[2])
    kind = ask(f"get type {number}")
    return name, len(kind) > 2 and JOINT_TYPE.parse([kind[2]]) == "prismatic"


def _position_labels(value: Any, joints: list[tuple[str, bool]]) -> list[Label]:
    if len(value) != len(joints):
        return []
    return [(name, "" if slides else "°") for name, slides in joints]


def _state_labels(value: Any, joints: list[tuple[str, bool]]) -> list[Label]:
    if len(value) != 2 * len(_STATE) or any(len(row) != len(joints) for row in value[::2]):
        return []
    found: list[Label] = []
    for what, unit in _STATE:
        for name, slides in joints:
            found.append((f"{name} {what}", "" if slides and unit in _TURNING else unit))
        found.append(_NONE)  # whether it is measured
    return found


def _sensor_labels(value: Any, sensors: list[list[tuple[str, str]]]) -> list[Label]:
    if [len(row) for row in value] != [len(row) for row in sensors]:
        return []
    return [
        label
        for kind, row, named in zip(KINDS, value, sensors, strict=False)
        for (values, _), (name, _) in zip(row, named, strict=True)
        for label in (*_measured(kind, name, len(values)), _NONE)  # and the time
    ]


def _measured(kind: str, name: str, count: int) -> Iterator[Label]:
    """The labels of the values of one sensor."""
    what, parts, units = _SENSORS[kind]
    if len(parts) != count:
        parts = [str(number) for number in range(count)]
        units = ["°"] * count if kind == "encoder_arrays" else ()
    for part, unit in zip_longest(parts, units, fillvalue=""):
        yield f"{name} {what} {part}".rstrip(), unit
