"""Servers of devices as devices of a robot's file, under the names that they have in C++ YARP.

    <device name="head_nws" type="controlBoard_nws_yarp">
      <param name="name">/robot/head</param>
      <action phase="startup" level="10" type="attach"><param name="device">head</param></action>
      <action phase="shutdown" level="15" type="detach"/>
    </device>

Rules: `name` is that of the ports, `period` the seconds between messages (milliseconds for
`multipleanalogsensorsserver` and `analogServer`, as in C++). The ports are open while a device is
attached; whatever has the interface of its kind can be, one at a time. Those of `interfaces` are
all `Served`, which is told by the type that is opened.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Final

from yarpy.data.bottle import Property
from yarpy.kits.devices.closeable import Closeable
from yarpy.names.base import NameClient

if TYPE_CHECKING:
    from yarpy.kits.devices.network.model import Interface

#: What some servers were called before.
_OLDER: Final = {
    "JoypadControlServer": "JoypadControl_nws_yarp",
    "rgbdSensor_nws_yarp": "RGBDSensor_nws_yarp",
}


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


class FrameWriter(Wrapper):
    """`frameWriter_nws_yarp`; its ports are called /writer where no name is given."""

    def __init__(self, options: Property, *, names: NameClient | None = None) -> None:
        named = Property(name=options.find("name", "") or "/writer")
        super().__init__(named, names=names)

    def serve(self, name: str, device: Any, **values: Any) -> Closeable:
        """Return a server for a screen."""
        from yarpy.kits.devices.frame_grabber.writer import FrameWriterServer

        return FrameWriterServer(name, device, **values)


class Analog(Wrapper):
    """`analogServer`. The list `ports` names parts, each with four numbers: its first and last
    channel, and what these are within the part. Raises ValueError for parts that are none."""

    unit = 0.001

    def __init__(self, options: Property, *, names: NameClient | None = None) -> None:
        from yarpy.kits.devices.analog.plugin import network_of
        from yarpy.kits.devices.simulated.plugin import values

        super().__init__(options, names=names)
        parts = {}
        for key in map(str, values(options, "ports")):
            first, last, base, top = network_of(key, values(options, key))
            if last - first != top - base:
                raise ValueError(f"the part {key} has not as many channels here as there")
            parts[key] = range(first, last + 1)
        if parts:
            self._values["parts"] = parts

    def serve(self, name: str, device: Any, **values: Any) -> Closeable:
        """Return a server for a sensor with channels."""
        from yarpy.kits.devices.analog.server import AnalogSensorServer

        return AnalogSensorServer(name, device, **values)


class Served(Wrapper):
    """The servers of `interfaces`, such as `speechSynthesizer_nws_yarp`. Raises LookupError for a
    type that is none of them."""

    def __init__(self, options: Property, *, names: NameClient | None = None) -> None:
        super().__init__(options, names=names)
        self._kind = served(str(options.find("device", "")))
        # A server of maps is named by its port.
        if self._kind.__name__ == "Map2D":
            self._name = self._name.removesuffix("/rpc")

    def serve(self, name: str, device: Any, **values: Any) -> Closeable:
        """Return a server for a device."""
        return self._kind.serve(name, device, **values)


def served(kind: str) -> type[Interface]:
    """Return the interface that a type of servers serves. Raises LookupError."""
    from yarpy.kits.devices.interfaces import interfaces

    names = {each.NWS: each for each in interfaces().values()}
    return names[_OLDER.get(kind, kind)]


def server_of(device: object, kind: str = "") -> str:
    """Return the type of the server that a device wants, by its own type or its members; "" where
    none fits, or several do."""
    from yarpy.kits.devices.interfaces import interfaces
    from yarpy.kits.devices.multi_sensor.interface import KINDS

    known = [*interfaces().values()]
    # What each needs; a class may be more than that.
    for server, members in (
        ("frameWriter_nws_yarp", ("show",)),
        ("analogServer", ("channels",)),
        ("controlBoard_nws_yarp", ("axis_names",)),
        ("frameGrabber_nws_yarp", ("image",)),
        ("RGBDSensor_nws_yarp", ("depth",)),
        ("rangefinder2D_nws_yarp", ("ranges",)),
        ("battery_nws_yarp", ("charge",)),
        ("multipleanalogsensorsserver", KINDS),
        *((each.NWS, ()) for each in known if kind and kind == each.FAKE),
    ):
        if not members or any(hasattr(device, one) for one in members):
            return server
    fitting = [each.NWS for each in known if all(hasattr(device, one) for one in each.members)]
    return fitting[0] if len(fitting) == 1 else ""
