"""Torques that another program estimates, in the file of a robot: virtualAnalogServer.

    <device name="left_arm_vft" type="virtualAnalogServer">
      <param name="name">/icub/joint_vsens/left_arm:i</param>
      <param name="networks">(left_upper left_lower)</param>
      <param name="left_upper">(0 3 0 3)</param>
      <param name="left_lower">(4 5 0 1)</param>
      <action phase="startup" level="10" type="attach">
        <paramlist name="networks">
          <elem name="left_upper">upper_motors</elem>
          <elem name="left_lower">lower_motors</elem>
        </paramlist>
      </action>
    </device>

Rules: `name` is that of its port. Each network has four numbers: its first and last channel here,
and in the device.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

from yarpy.data.bottle import Bottle, Property
from yarpy.kits.devices.analog.virtual import Network, VirtualAnalogServer
from yarpy.kits.devices.simulated.plugin import values
from yarpy.names.base import NameClient

_MOST: Final = 255  # channels


class VirtualAnalog:
    """`virtualAnalogServer` in the file of a robot. Raises ValueError for parameters that name no
    networks."""

    def __init__(self, options: Property, *, names: NameClient | None = None) -> None:
        self._name = str(options.find("name", "") or "")
        if not self._name:
            raise ValueError("it needs a parameter name, that of its port")
        listed = [str(one) for one in values(options, "networks")]
        if not listed:
            raise ValueError("it needs a parameter networks, a list of names")
        self._networks = {key: network_of(key, values(options, key)) for key in listed}
        self._names = names
        self._server: VirtualAnalogServer | None = None

    def attach(self, devices: Mapping[str, object]) -> None:
        """Tell these devices. Raises ValueError."""
        if self._server is not None:
            raise ValueError("it has devices already")
        if len(devices) == len(self._networks) == 1:  # one needs no name
            devices = dict(zip(self._networks, devices.values(), strict=True))
        self._server = VirtualAnalogServer(self._name, devices, self._networks, names=self._names)

    def detach(self) -> None:
        """Close the port."""
        server, self._server = self._server, None
        if server is not None:
            server.close()

    close = detach


def network_of(key: str, given: Sequence[Any]) -> Network:
    """Return the channels of a network. Raises ValueError for others than four numbers in order."""
    if len(given) == 1 and isinstance(given[0], str):
        given = Bottle.from_text(given[0])
    right = len(given) == 4 and all(type(one) is int and 0 <= one < _MOST for one in given)
    network = Network(*given) if right else None
    if network is None or network.last < network.first or network.top < network.base:
        raise ValueError(
            f"the network {key} needs four numbers, first and last channel here and in the device: "
            f"(0 3 0 3), not {given!r:.40}"
        )
    return network
