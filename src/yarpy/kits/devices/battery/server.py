"""BatteryServer: serve your battery on YARP ports.

    <name>/data:o   voltage, current, charge, temperature and status, every period
    <name>/rpc:i    what it is: [ibat] [btnf], or getBatteryInfoRPC of YARP 3.12 and later

Rules: nothing is read while nobody listens. YARP 3.12 and later have the charge in front; YARP 4 is
known by asking, 3.12 is not: `newer` is for its programs. Who asks for the version is told 3.11 or
3.12, by what is sent.

Source: battery_nws_yarp of YARP 3.x and 4.0.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import ExitStack
from typing import Final

from yarpy import clock
from yarpy.data.bottle import Bottle
from yarpy.data.stamp import Stamp
from yarpy.data.value import Vocab
from yarpy.data.yarp4 import to_yarp4
from yarpy.errors import DecodeError
from yarpy.kits.devices.access import Access
from yarpy.kits.devices.battery.functions import BatteryData, IBatteryMsgs, Info
from yarpy.kits.devices.battery.interface import BATTERY
from yarpy.kits.devices.closeable import Closeable, prefix
from yarpy.kits.devices.declared import Status
from yarpy.kits.devices.kind import word
from yarpy.kits.devices.publisher import Publisher
from yarpy.kits.devices.refusal import DeviceErrorLog, Refused
from yarpy.kits.devices.service import DeviceService
from yarpy.kits.devices.status import OK
from yarpy.names.base import NameClient
from yarpy.port.dialects import Dialects
from yarpy.port.port import BufferedPort
from yarpy.port.rpc import RpcServer
from yarpy.wire.message import Encoded, Message

_NUMBERS: Final = ("charge", "voltage", "current", "temperature")


class BatteryServer(Closeable):
    """Serves `device` (see `devices.battery.interface`) to C++ and Python clients.

    name: prefix of the ports, for example `/robot/battery`.
    period: seconds between messages.
    newer: send to programs of YARP 3 what those of 3.12 read.
    names: a name client, None for the default.
    Raises AddressError (a name is in use), NoNameServer; ValueError if the device has no charge().
    """

    def __init__(
        self,
        name: str,
        device: object,
        period: float = 1.0,
        *,
        newer: bool = False,
        names: NameClient | None = None,
    ) -> None:
        self.name = name = prefix(name)
        self.device = device
        self._newer = newer
        self._battery = Access(device, 0, DeviceErrorLog(name), threading.Lock())
        if not self._battery.has("charge"):
            raise ValueError(f"{name}: the device needs charge(), in percent")
        self._functions = Functions(self.info, newer)
        self._stamp = Stamp()
        with ExitStack() as resources:
            resources.enter_context(RpcServer(f"{name}/rpc:i", self._answer, names=names))
            data = resources.enter_context(BufferedPort(f"{name}/data:o", names=names))
            self._readers = Dialects(data)
            publisher = Publisher(name, period, self._publish)
            resources.callback(publisher.close)
            self._resources = resources.pop_all()

    def __repr__(self) -> str:
        return f"<BatteryServer {self.name}>"

    def info(self) -> str:
        """Return the description of the battery."""
        return str(self._battery.ask("info")) if self._battery.has("info") else "a battery"

    def _answer(self, message: Message) -> object:
        try:
            request = message.as_(Bottle)
        except DecodeError:
            return Bottle([Vocab("fail")])
        if [word(each) for each in request[:2]] == ["ibat", "btnf"]:
            return Bottle([Vocab("is"), request[1], self.info()])
        return self._functions(message)

    def _publish(self) -> None:
        if not self._readers:
            return
        has = self._battery.has
        read = {name: float(self._battery.ask(name)) for name in _NUMBERS if has(name)}
        status = self._battery.ask("status") if has("status") else "in use"
        if status not in BATTERY:
            raise Refused(f"status() is one of {', '.join(BATTERY)}, not {status!r}")
        data = BatteryData(**read, status=BATTERY.index(status))
        self._stamp = self._stamp.next(clock.now())
        fields = [data.voltage, data.current, data.charge, data.temperature, data.status]
        self._readers.write(
            lambda: data if self._newer else Bottle(fields),
            lambda: Encoded(to_yarp4(data.to_wire()[0])),
            self._stamp,
        )


class Functions(IBatteryMsgs, DeviceService):
    """The functions that programs of YARP 3.12 and later call. Those of 4.0 also ask for the
    version."""

    def __init__(self, info: Callable[[], str], newer: bool) -> None:
        self._info = info
        self._yarp = (3, 12, 0) if newer else (3, 11, 0)  # type: ignore[misc]

    def getBatteryInfoRPC(self) -> Info:
        """Return the description of the battery."""
        return Info(Status(OK), self._info())
