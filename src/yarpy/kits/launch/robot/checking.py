"""Problems of a robot that only this computer can tell: devices that are not installed.

Rules: nothing is opened or imported.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from yarpy.kits.launch.document.advice import advice
from yarpy.kits.launch.document.problem import Problem
from yarpy.kits.launch.robot.description import Description
from yarpy.registry import devices

_SLIP: Final = 0.8  # C++ has many types whose names are alike, and not meant for each other


def unknown_types(description: Description) -> Iterator[Problem]:
    """Yield the types of devices that nothing here opens."""
    known = devices.names()
    for one in description.devices:
        if one.type not in known:
            text = f'no device of type "{one.type}" is installed{advice(one.type, known, _SLIP)}'
            yield Problem(one.where, text, fatal=True)
