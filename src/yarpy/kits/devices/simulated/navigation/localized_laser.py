"""LocalizedLaser: a laser scanner in a map that another program moves; fakeLaser in C++.

    with LocalizedLaser("use_mapfile", grid=grid, port="/fakeLaser/location:i") as laser:
        laser.ranges()                     # from where the last message says it is

Rules: it learns where it is from its port `port`, which reads x, y in metres and an angle in
degrees; or, where there is none, from a localization server, which is asked at each scan. While
that does not answer, it stays where it was, and the scan fails.
"""

from __future__ import annotations

from contextlib import ExitStack
from typing import Any

from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError
from yarpy.kits.devices.closeable import Closeable
from yarpy.kits.devices.interfaces.localization import Localization2D
from yarpy.kits.devices.kind import number
from yarpy.kits.devices.refusal import DeviceErrorLog, Refused
from yarpy.kits.devices.simulated.navigation.laser import SimulatedLaser
from yarpy.names.base import NameClient
from yarpy.port.port import BufferedPort
from yarpy.wire.message import Message


class LocalizedLaser(SimulatedLaser, Closeable):
    """port: the name of its port. server: whose localization it asks, `client` the prefix of the
    ports for that. More as `SimulatedLaser`. Raises ValueError for neither, YarpError."""

    def __init__(
        self,
        scene: str = "use_mapfile",
        *,
        port: str = "",
        server: str = "",
        client: str = "",
        names: NameClient | None = None,
        **settings: Any,
    ) -> None:
        super().__init__(scene, **settings)
        if not port and not server:
            raise ValueError("who says where the laser is: a port, or a localization server?")
        self._complain = DeviceErrorLog(port or server)
        self._localization: Localization2D | None = None
        with ExitStack() as resources:
            if port:
                resources.enter_context(BufferedPort(port, callback=self._take, names=names))
            else:
                self._localization = Localization2D.connect(server, client, names=names)
                resources.callback(self._localization.close)
            self._resources = resources.pop_all()

    def ranges(self) -> list[float]:
        """Metres, one for each step, from where it is now. Raises YarpError."""
        if self._localization is not None:
            found = self._localization.position()
            self.place = found.x, found.y, found.theta
        return super().ranges()

    def _take(self, message: Message) -> None:
        try:
            told = [number(one) for one in message.as_(Bottle)[:3]]
            if len(told) != 3:
                raise Refused("a place is x, y in metres and an angle in degrees")
        except (DecodeError, Refused) as error:
            self._complain("a place", error)
            return
        self.place = told[0], told[1], told[2]
