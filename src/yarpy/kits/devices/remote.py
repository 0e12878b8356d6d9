"""Devices of other programs as devices of a robot's file: clients, under the names of C++ YARP.

    <device name="head" type="remote_controlboard">
      <param name="remote">/icub/head</param>
      <param name="local">/mine/head</param>
    </device>

Rules: `remote` says whose it is, `local` what its own ports are called (a unique name if it is not
given), `carrier` how messages come. They open when the other program is there, and fail when it is
not.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from yarpy.data.bottle import Property
from yarpy.names.base import NameClient

#: What each is in `yarpy.kits.devices`; those of `interfaces` say it themselves.
_CLASSES: Final = {
    "analogsensorclient": "AnalogSensor",
    "battery_nwc_yarp": "Battery",
    "cartesiancontrollerclient": "CartesianController",
    "clientcontrolboard": "ControlBoard",
    "controlBoard_nwc_yarp": "ControlBoard",
    "frameGrabber_nwc_yarp": "FrameGrabber",
    "gazecontrollerclient": "GazeController",
    "multipleanalogsensorsclient": "MultiSensor",
    "rangefinder2D_nwc_yarp": "Laser",
    "RemoteFrameGrabber": "FrameGrabber",
    "remote_controlboard": "ControlBoard",
    "remote_grabber": "FrameGrabber",
}
_OLDER: Final = {"JoypadControlClient": "Joypad", "RGBDSensorClient": "DepthCamera"}
_REMOTES: Final = ("remote", "server", "navigation_server", "remoteRpcPort", "RemoteRpcPort")


def remote(options: Property, *, names: NameClient | None = None) -> object:
    """Return a client for what `options` name. Raises ValueError without a remote, LookupError for
    a type that is none of these, YarpError."""
    from yarpy.kits import devices

    kind = str(options.find("device", ""))
    whose = next((str(options[key]) for key in _REMOTES if options.get(key)), "")
    if not whose:
        raise ValueError("it needs a parameter remote, whose device it is")
    local = str(options.find("local", "") or "")
    given: dict[str, Any] = {"names": names}
    if options.get("carrier"):
        given["carrier"] = str(options["carrier"])
    if kind in _CLASSES:
        make: Callable[..., object] = getattr(devices, _CLASSES[kind])
        return make(whose, local, **given)
    return _interface(kind).connect(whose.removesuffix("/rpc:i"), local, **given)


def transforms(options: Property, *, names: NameClient | None = None) -> object:
    """Return `frameTransformClient`. Raises YarpError."""
    from yarpy.kits.devices import TransformClient

    whose = str(options.find("remote", "/frameTransformServer"))
    return TransformClient(whose, str(options.find("local", "") or ""), names=names)


def transform_server(options: Property, *, names: NameClient | None = None) -> object:
    """Return `frameTransformServer`, which serves itself. Raises YarpError."""
    from yarpy.kits.devices import TransformServer

    return TransformServer(str(options.find("name", "/frameTransformServer")), names=names)


def _interface(kind: str) -> Any:
    from yarpy.kits.devices.interfaces import interfaces

    known = interfaces()
    if kind in _OLDER:
        return known[_OLDER[kind]]
    return {each.NWC: each for each in known.values() if each.NWC}[kind]
