"""Servers of devices as devices of a robot's file, under the names that they have in C++ YARP.

    <device name="head_nws" type="controlBoard_nws_yarp">
      <param name="name">/robot/head</param>
      <action phase="startup" level="10" type="attach"><param name="device">head</param></action>
      <action phase="shutdown" level="15" type="detach"/>
    </device>

Rules: `name` is that of the ports, `period` the seconds between messages (milliseconds for
`multipleanalogsensorsserver`, as in C++). The ports are open while a device is attached;
whatever has the interface of its kind can be, one at a time.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from yarpy.data.bottle import Property
from yarpy.kits.devices.closeable import Closeable
from yarpy.names.base import NameClient


class Wrapper:
    """Serves the device that is attached. Raises ValueError without a name."""

    #: of a `period` in seconds
    unit: ClassVar[float] = 1.0

    def __init__(self, options: Property, *, names: NameClient | None = None) -> None:
        self._name = str(options.find("name", "") or "")
        if not self._name:
            raise ValueError("it needs a parameter name, that of its ports")
        period = options.find("period")
        if period is not None and (
            not isinstance(period, (int, float)) or isinstance(period, bool) or not 0 < period < 1e6
        ):
            raise ValueError(f"the period {period} is no time")
        self._values: dict[str, Any] = {} if period is None else {"period": period * self.unit}
        self._names = names
        self._server: Closeable | None = None

    def attach(self, devices: Mapping[str, object]) -> None:
        """Serve a device. Raises ValueError for several, and if it is not of this kind."""
        if len(devices) != 1:
            raise ValueError(f"it serves one device, not {len(devices)}")
        if self._server is not None:
            raise ValueError("it serves a device already")
        [device] = devices.values()
        self._server = self.serve(self._name, device, names=self._names, **self._values)

    def detach(self) -> None:
        """Close the ports."""
        server, self._server = self._server, None
        if server is not None:
            server.close()

    close = detach

    def serve(self, name: str, device: Any, **values: Any) -> Closeable:
        """Return a server for a device."""
        raise NotImplementedError


class ControlBoard(Wrapper):
    """`controlBoard_nws_yarp`."""

    def serve(self, name: str, device: Any, **values: Any) -> Closeable:
        """Return a server for joints."""
        from yarpy.kits.devices.control_board.server import ControlBoardServer

        return ControlBoardServer(name, device, **values)


class FrameGrabber(Wrapper):
    """`frameGrabber_nws_yarp`."""

    def serve(self, name: str, device: Any, **values: Any) -> Closeable:
        """Return a server for a camera."""
        from yarpy.kits.devices.frame_grabber.server import FrameGrabberServer

        return FrameGrabberServer(name, device, **values)


class MultiSensor(Wrapper):
    """`multipleanalogsensorsserver`."""

    unit = 0.001

    def serve(self, name: str, device: Any, **values: Any) -> Closeable:
        """Return a server for sensors."""
        from yarpy.kits.devices.multi_sensor.server import MultiSensorServer

        return MultiSensorServer(name, device, **values)


class Laser(Wrapper):
    """`rangefinder2D_nws_yarp`."""

    def serve(self, name: str, device: Any, **values: Any) -> Closeable:
        """Return a server for a laser scanner."""
        from yarpy.kits.devices.laser.server import LaserServer

        return LaserServer(name, device, **values)


class Battery(Wrapper):
    """`battery_nws_yarp`."""

    def serve(self, name: str, device: Any, **values: Any) -> Closeable:
        """Return a server for a battery."""
        from yarpy.kits.devices.battery.server import BatteryServer

        return BatteryServer(name, device, **values)
