"""Devices whose interface is one class of `yarpy.devices`: clients, servers and simulated ones, by
the names of C++.

Rules: navigation's client is that of three servers, as in C++: `navigation_server`,
`map_locations_server` and `localization_server`.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from typing import Any

import yarpy
from yarpy.kits import devices
from yarpy.kits.devices.interfaces import interfaces

INTERFACES = interfaces()
#: By the names of clients and of servers.
CLIENTS = {each.NWC: each for each in INTERFACES.values() if each.NWC}
CLIENTS |= {"JoypadControlClient": devices.Joypad, "RGBDSensorClient": devices.DepthCamera}
SERVED = {each.NWS: each for each in INTERFACES.values()}
SERVED |= {"JoypadControlServer": devices.Joypad, "rgbdSensor_nws_yarp": devices.DepthCamera}
#: Clients with classes of their own.
OWN: dict[str, Any] = {
    "analogsensorclient": devices.AnalogSensor,
    "battery_nwc_yarp": devices.Battery,
    "rangefinder2D_nwc_yarp": devices.Laser,
    "cartesiancontrollerclient": devices.CartesianController,
    "gazecontrollerclient": devices.GazeController,
}
#: Devices without a network.
LOCAL: dict[str, Callable[[], Any]] = {
    "fakeBattery": devices.SimulatedBattery,
    "fakeChatBotDevice": devices.SimulatedChatBot,
    "fakeDepthCamera": devices.SimulatedDepthCamera,
    "fakeJointCoupling": devices.SimulatedCoupling,
    "fakeJoypad": devices.SimulatedJoypad,
    "fakeLLMDevice": devices.SimulatedLanguageModel,
    "fakeLocalizer": devices.SimulatedBase,
    "fakeMicrophone": devices.SimulatedMicrophone,
    "fakeNavigation": devices.SimulatedBase,
    "fakeOdometry2D": devices.SimulatedBase,
    "fakePositionSensor": devices.SimulatedPositionSensor,
    "fakeSerialPort": devices.SimulatedSerialPort,
    "fakeSimulatedWorld": devices.SimulatedWorld,
    "fakeSpeaker": devices.SimulatedSpeaker,
    "fakeSpeechSynthesizer": devices.SimulatedSynthesizer,
    "fakeSpeechTranscription": devices.SimulatedTranscription,
    "map2DStorage": devices.MapStorage,
    "robotDescriptionStorage": devices.DescriptionStorage,
}

#: What says whose client it is.
_REMOTES = ("remote", "server", "navigation_server", "remoteRpcPort", "RemoteRpcPort")
_NAVIGATION = (
    ("navigation_server", "Navigation2D"),
    ("map_locations_server", "Map2D"),
    ("localization_server", "Localization2D"),
)


class Together:
    """Several clients as one device."""

    def __init__(self, clients: list[Any], resources: ExitStack) -> None:
        self._clients = clients
        self._resources = resources

    def __getattr__(self, name: str) -> Any:
        for client in self._clients:
            if name in client.members:
                return getattr(client, name)
        raise AttributeError(name)

    def close(self) -> None:
        self._resources.close()


def connect(device: str, text: Callable[[str, str], str], names: Any) -> Any:
    """Return a client. `text` finds an option, or its default. Raises YarpError."""
    carrier, local = text("carrier", "tcp"), text("local", "")
    if device == "navigation2D_nwc_yarp":
        with ExitStack() as resources:
            clients = []
            for option, name in _NAVIGATION:
                if not text(option, ""):
                    raise yarpy.AddressError(f'the option "{option}" says whose client it is')
                part = f"{local}/{name.lower()}" if local else ""
                client = INTERFACES[name].connect(
                    text(option, ""), part, carrier=carrier, names=names
                )
                resources.callback(client.close)
                clients.append(client)
            return Together(clients, resources.pop_all())
    if device == "frameTransformClient":
        return devices.TransformClient(text("remote", "/frameTransformServer"), local, names=names)
    remote = next((text(each, "") for each in _REMOTES if text(each, "")), "")
    # A camera with distances is named by its ports.
    remote = remote.removesuffix("/rpc:i") if device.startswith("RGBD") else remote
    if not remote:
        raise yarpy.AddressError('the option "remote" says whose client it is: (remote /maps)')
    if device in OWN:
        return OWN[device](remote, local, carrier=carrier, names=names)
    return CLIENTS[device].connect(remote, local, carrier=carrier, names=names)


def serve(server: str, device: Any, name: str, period: float, names: Any) -> Any:
    """Return a server for a device. Raises YarpError, ValueError."""
    # A server of maps is named by its port.
    name = name.removesuffix("/rpc") if server == "map2D_nws_yarp" else name
    return SERVED[server].serve(name, device, period, names=names)
