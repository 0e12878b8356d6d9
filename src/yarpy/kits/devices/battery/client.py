"""Battery: a remote battery, C++ or Python, used like a local one.

    with Battery("/robot/battery") as battery:
        print(battery.charge(), battery.status())     # 80.0 in use

Rules: it has every member listed in `devices.battery.interface`, so it can be served again.

Source: battery_nwc_yarp of YARP 3.x and 4.0.
"""

from __future__ import annotations

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError, LocalProtocolError
from yarpy.kits.devices.battery.functions import BatteryData, IBatteryMsgs
from yarpy.kits.devices.battery.interface import BATTERY
from yarpy.kits.devices.remote_device import TIMEOUT, RemoteDevice
from yarpy.kits.devices.status import OK, reason, split
from yarpy.kits.thrift.client import client_class
from yarpy.wire.message import Message


class Battery(RemoteDevice[BatteryData]):
    """The battery whose ports begin with `remote`."""

    DATA = "/data:o", "/data:i"
    FRESH = 5.0

    def charge(self) -> float:
        """Percent."""
        return self._latest.value().charge

    def voltage(self) -> float:
        """V."""
        return self._latest.value().voltage

    def current(self) -> float:
        """A."""
        return self._latest.value().current

    def temperature(self) -> float:
        """Degrees Celsius."""
        return self._latest.value().temperature

    def status(self) -> str:
        """One of `BATTERY`."""
        number = self._latest.value().status
        return BATTERY[number] if number in range(len(BATTERY)) else "error"

    def timestamp(self) -> float:
        """Return the time when it was measured, seconds (of the sender's clock)."""
        return self._latest.time()

    @property
    def info(self) -> str:
        """Return the description of the battery, for people."""
        asked = ["getBatteryInfoRPC"] if self._newer else [Vocab("ibat"), Vocab("btnf")]
        answer = self._rpc.call(Bottle(asked), timeout=TIMEOUT)
        found = answer if isinstance(answer, list) else [answer]
        if not self._newer and len(found) == 3 and found[0] == "is":
            return str(found[2])
        code, rest = split(found)
        if code != OK or not rest:
            raise LocalProtocolError(f'"{self.remote}" does not say what it is: {reason(code)}')
        return str(rest[0])

    def _learn(self) -> None:
        # What 3.11 and 3.12 send looks alike, with other things in front.
        version = client_class(IBatteryMsgs)(self._rpc, TIMEOUT).remote_version()
        self._newer = version is not None and version[1:] >= (3, 12)

    def _decode(self, message: Message) -> BatteryData:
        found = message.as_(Bottle)
        if len(found) != 5 or not all(isinstance(each, (int, float)) for each in found):
            raise DecodeError(f'"{self.remote}" sends no state of a battery')
        first, second, third, fourth = map(float, found[:4])
        if self._newer:
            return BatteryData(first, second, third, fourth, int(found[4]))
        return BatteryData(third, first, second, fourth, int(found[4]))
