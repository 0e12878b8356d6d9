"""Names of YARP's bindings that programs look for in `yarpy`, and what takes their place here.

Rules: only an error asks, so importing yarpy does not read this. What is named here exists: a test
looks each of it up.
"""

from __future__ import annotations

from typing import Final

_NOTHING: Final = "nothing has to be initialised; yarpy.connect and yarpy.exists are functions"
_VALUES: Final = "values are those of Python: numbers, strings, lists and dicts"

#: the beginning of a name, or all of it, and what to use
_INSTEAD: Final = {
    "Network": _NOTHING,
    "init": _NOTHING,
    "BufferedPort": "yarpy.BufferedPort is for messages of every type",
    "Image": "yarpy.Image is of every kind of pixel: yarpy.Image(array)",
    "RFModule": "yarpy.Module",
    "Value": _VALUES,
    "PortReader": "a function is called with each message: yarpy.BufferedPort(name, callback=f)",
    "RpcPort": "yarpy.RpcServer and yarpy.RpcClient",
    "Publisher": "yarpy.Port(name) writes to all that are connected to it",
    "Subscriber": "yarpy.BufferedPort(name, callback=f), or its read()",
    "Time": "yarpy.clock, or the module time of Python",
    "Log": "the module logging of Python",
    "PolyDriver": "yarpy.devices has a class for each kind of device",
    "delay": "yarpy.clock.sleep, or time.sleep",
}


def instead(name: str) -> str:
    """Return what takes the place of a name of the bindings; "" if it is none that is known."""
    for front in sorted(_INSTEAD, key=len, reverse=True):
        if name == front or (front in ("BufferedPort", "Image") and name.startswith(front)):
            return f"{_INSTEAD[front]} (`import yarp` of yarpy-compat has YARP's own names)"
    return ""
