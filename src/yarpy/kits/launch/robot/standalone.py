"""One device without a robot's file, with the server that brings it to the network: yarpdev.

    with StandaloneDevice(options, devices.load, server_of) as one:
        one.name                                    "/grabber"

Rules: `device` is its type. With `subdevice` that one is a server, and serves the subdevice (from
YARP 3.10 on `device deviceBundler`, `wrapper_device` and `attached_device`). Else it gets the
server that it wants, unless it is a client, or nobody knows one. All get all options.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from typing import Any, Final, Self

from yarpy.data.bottle import Property
from yarpy.errors import LocalProtocolError
from yarpy.kits.launch.robot.contract import Plugin
from yarpy.names.base import NameClient

_BUNDLE: Final = "deviceBundler"
#: Names of ports, where the options have none.
_NAMES: Final = {"frameGrabber_nws_yarp": "/grabber"}


class StandaloneDevice:
    """A device that is open until it is closed.

    options: its parameters. plugins: returns what opens devices of a type. server_of: returns the
    type of the server for a device and its type, or "". names: the name client for all ports.
    Raises what opening it raises, LocalProtocolError if a server has nothing to serve.
    """

    #: the types, of the server "" if it has none
    device: str
    server: str
    #: what its ports are called
    name: str

    def __init__(
        self,
        options: Property,
        plugins: Callable[[str], Plugin],
        server_of: Callable[[object, str], str],
        *,
        names: NameClient | None = None,
    ) -> None:
        self.server, self.device = types(options)
        self._plugins = plugins
        self._names = names
        with ExitStack() as opened:
            device = self._open(opened, options, self.device)
            if not self.server:
                self.server = _wanted(options, device, self.device, server_of)
            self.name = str(
                options.get("name") or _NAMES.get(self.server) or f"/{self.server or self.device}"
            )
            if self.server:
                named = Property(options)
                named["name"] = self.name
                server = self._open(opened, named, self.server)
                if not callable(getattr(server, "attach", None)):
                    raise LocalProtocolError(f"{self.server} serves no other device")
                server.attach({"...": getattr(device, "served", device)})
            self._opened = opened.pop_all()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the server, then the device. Idempotent."""
        self._opened.close()

    def _open(self, opened: ExitStack, options: Property, kind: str) -> Any:
        given = Property(options)
        given["device"] = kind
        found = self._plugins(kind)(given, names=self._names)
        for method in ("close", "detach"):  # the last one that is entered comes first
            if callable(end := getattr(found, method, None)):
                opened.callback(end)
        return found


def types(options: Property) -> tuple[str, str]:
    """Return the types of the server, "" for none, and of the device.

    >>> types(Property(device="controlBoard_nws_yarp", subdevice="fakeMotionControl"))
    ('controlBoard_nws_yarp', 'fakeMotionControl')
    """
    first, inner = (str(options.get(key) or "") for key in ("device", "subdevice"))
    if first == _BUNDLE:
        first, inner = (
            str(options.get(key) or "") for key in ("wrapper_device", "attached_device")
        )
        if not first or not inner:
            raise LocalProtocolError(f"{_BUNDLE} takes --wrapper_device and --attached_device")
    return (first, inner) if inner else ("", first)


def _wanted(
    options: Property, device: object, kind: str, server_of: Callable[[object, str], str]
) -> str:
    """Return the type of the server for a device that comes without one."""
    if callable(getattr(device, "attach", None)):
        raise LocalProtocolError(
            f"{kind} does nothing without another device: "
            f"yarpy dev --device {kind} --subdevice TYPE"
        )
    client = options.get("remote") is not None and not options.get("name")
    return "" if client else server_of(device, kind)
