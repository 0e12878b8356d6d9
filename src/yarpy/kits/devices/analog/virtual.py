"""VirtualAnalogServer: torques that another program estimates, for motors that measure none.

    class Motors:
        def update_measures(self, values):            # Nm
            ...

    networks = {"arm": Network(0, 5, 0, 5)}
    VirtualAnalogServer("/icub/joint_vsens/left_arm:i", {"arm": Motors()}, networks)

Rules: its port `name` reads lists of torques in Nm, with the part of the body in front (`PARTS`). A
`Network` says which channels a device has: its first and last here, and in the device. A device is
told all its channels at once, and zeros as soon as nothing has come for 80 ms; what a list lacks is
zero.

Source: VirtualAnalogWrapper of YARP 3.x and 4.0.
"""

from __future__ import annotations

import threading
from collections.abc import Mapping
from contextlib import ExitStack
from typing import Final, NamedTuple

from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError
from yarpy.kits.devices.access import Access
from yarpy.kits.devices.closeable import Closeable, prefix
from yarpy.kits.devices.kind import number
from yarpy.kits.devices.refusal import DeviceErrorLog, Refused
from yarpy.names.base import NameClient
from yarpy.port.port import BufferedPort
from yarpy.wire.message import Message

#: Seconds after which what was told does not count any more.
FRESH: Final = 0.08

#: The number in front -> which elements of the list are the torques of the channels; the channels
#: are so many as stand here, and None is zero.
PARTS: Final[Mapping[int, tuple[int | None, ...]]] = {
    1: (1, 2, 3, 4, 5, None),  # an arm: shoulder, elbow, and the wrist's first axis
    2: (1, 2, 3, 4, 5, 6),  # a leg
    3: (6, 7, None, None, None, None),  # a wrist: the arm's last two axes
    4: (1, 2, 3),  # the torso
}


class Network(NamedTuple):
    """The channels of a device: `first` to `last` here, from `base` to `top` there."""

    first: int
    last: int
    base: int
    top: int


class VirtualAnalogServer(Closeable):
    """Reads estimates at the port `name`, for `devices` by the names of `networks`.

    Raises AddressError (the name is in use), NoNameServer; ValueError for a device that has no
    update_measures(), and networks without one.
    """

    def __init__(
        self,
        name: str,
        devices: Mapping[str, object],
        networks: Mapping[str, Network],
        *,
        names: NameClient | None = None,
    ) -> None:
        self.name = name = prefix(name)
        self._complain = DeviceErrorLog(name)
        lock = threading.Lock()
        self._targets: list[tuple[Access, Network]] = []
        for key, network in networks.items():
            device = devices.get(key)
            target = Access(device, 0, self._complain, lock)
            if device is None or not target.has("update_measures"):
                there = "has no update_measures()" if device is not None else "is not attached"
                raise ValueError(f"{name}: the device of the network {key} {there}")
            self._targets.append((target, network))
        self._told = [[0.0] * (network.top - network.base + 1) for network in networks.values()]
        self._came = threading.Event()
        self._ended = threading.Event()
        with ExitStack() as resources:
            port = BufferedPort(name, callback=self._take, names=names)
            resources.enter_context(port)
            self._watch = threading.Thread(
                target=self._forget, name=f"yarpy device {name}", daemon=True
            )
            self._watch.start()
            resources.callback(self._end)
            self._resources = resources.pop_all()

    def __repr__(self) -> str:
        return f"<VirtualAnalogServer {self.name}>"

    def _take(self, message: Message) -> None:
        try:
            torques = _torques(message)
            places = self._places(len(torques))
        except (Refused, DecodeError) as error:
            self._complain("a list of torques", error)
            return
        for torque, (at, channel) in zip(torques, places, strict=True):
            if channel < len(self._told[at]):
                self._told[at][channel] = torque
        self._tell()
        self._came.set()

    def _places(self, count: int) -> list[tuple[int, int]]:
        """Return the network and its channel for each channel here. Raises Refused."""
        found = []
        for channel in range(count):
            whose = [
                (at, channel - network.first)
                for at, (_, network) in enumerate(self._targets)
                if network.first <= channel <= network.last
            ]
            if not whose:
                raise Refused(f"no network has the channel {channel}")
            found.append(whose[-1])
        return found

    def _tell(self) -> None:
        for (target, _), told in zip(self._targets, self._told, strict=True):
            try:
                target.ask("update_measures", [*told])
            except Refused as refusal:
                self._complain("update_measures", refusal)

    def _forget(self) -> None:
        while not self._ended.is_set():
            self._came.wait()
            self._came.clear()
            while self._came.wait(FRESH) and not self._ended.is_set():
                self._came.clear()
            if not self._ended.is_set():
                for told in self._told:
                    told[:] = [0.0] * len(told)
                self._tell()

    def _end(self) -> None:
        self._ended.set()
        self._came.set()
        self._watch.join(5.0)


def _torques(message: Message) -> list[float]:
    """Return a torque for each channel. Raises Refused, DecodeError."""
    told = message.as_(Bottle)
    part = told[0] if told else None
    places = PARTS.get(part) if isinstance(part, int) else None
    if places is None:
        raise Refused(f"the first number says of what it is: {', '.join(map(str, PARTS))}")
    return [0.0 if place is None or place >= len(told) else number(told[place]) for place in places]
