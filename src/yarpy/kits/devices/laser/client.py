"""Laser: a remote laser scanner, C++ or Python, used like a local one.

    with Laser("/robot/laser") as laser:
        scan = laser.scan()
        print(scan.angles, scan.ranges.min())

Rules: it has every member listed in `devices.laser.interface`, so it can be served again.

Source: rangefinder2D_nwc_yarp of YARP 3.x and 4.0.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.data.yarp4 import to_yarp4
from yarpy.errors import DecodeError, LocalProtocolError, RemoteProtocolError
from yarpy.kits.devices.laser.functions import IRangefinder2DMsgs, LaserScan2D
from yarpy.kits.devices.laser.interface import CONDITIONS, Scan
from yarpy.kits.devices.remote_device import TIMEOUT, RemoteDevice
from yarpy.kits.devices.status import OK, reason, split
from yarpy.kits.thrift.client import client_class
from yarpy.kits.thrift.payload import Payload
from yarpy.wire.message import Message

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: Member -> the word of YARP 3.9 and earlier, and what the functions of later ones are called.
_NAMES: Final = {
    "distances": ("lsdr", "DistanceRange"),
    "angles": ("lsar", "ScanLimits"),
    "step": ("lsas", "HorizontalResolution"),
    "rate": ("lssr", "ScanRate"),
    "info": ("lsnf", "DeviceInfo"),
}


class Laser(RemoteDevice[Scan]):
    """The scanner whose scans come from the port `remote`."""

    DATA = "", "/scans:i"
    FRESH = 1.0

    def scan(self) -> Scan:
        """The latest scan. Raises Timeout if there is none, DecodeError."""
        return self._latest.value()._replace(time=self._latest.time())

    def ranges(self) -> NDArray[Any]:
        """Metres; infinite where nothing was hit."""
        return self._latest.value().ranges

    def condition(self) -> str:
        """One of `CONDITIONS`."""
        return self._latest.value().condition

    @property
    def angles(self) -> tuple[float, float]:
        """The angles of the first and the last range, degrees."""
        low, high = self._get("angles", 2)
        return float(low), float(high)

    @angles.setter
    def angles(self, values: tuple[float, float]) -> None:
        self._set("angles", *map(float, values))

    @property
    def distances(self) -> tuple[float, float]:
        """Nearest and farthest, metres."""
        low, high = self._get("distances", 2)
        return float(low), float(high)

    @distances.setter
    def distances(self, values: tuple[float, float]) -> None:
        self._set("distances", *map(float, values))

    @property
    def step(self) -> float:
        """Degrees between two ranges."""
        return float(self._get("step", 1)[0])

    @step.setter
    def step(self, value: float) -> None:
        self._set("step", float(value))

    @property
    def rate(self) -> float:
        """Turns per second."""
        return float(self._get("rate", 1)[0])

    @rate.setter
    def rate(self, value: float) -> None:
        self._set("rate", float(value))

    @property
    def info(self) -> str:
        """Return the description of the laser, for people."""
        return str(self._get("info", 1)[0])

    # -- within -------------------------------------------------------------------------------

    def _learn(self) -> None:
        self._version = client_class(IRangefinder2DMsgs)(self._rpc, TIMEOUT).remote_version()

    def _get(self, member: str, count: int) -> list[Any]:
        item, function = _NAMES[member]
        if self._version is None:
            answer = self._ask([Vocab("get"), Vocab("ilas"), Vocab(item)])
            if answer[:1] == ["is"]:
                return self._counted(member, answer[2:], count)
        # YARP 3.10 and 3.11 have functions, but do not tell their version.
        code, rest = split(self._ask([f"get{function}", Vocab("RPC")]))
        if code != OK:
            raise LocalProtocolError(f'"{self.remote}" refuses {member}: {reason(code)}')
        return self._counted(member, rest, count)

    def _set(self, member: str, *values: float) -> None:
        item, function = _NAMES[member]
        if self._version is None:
            words = [Vocab("set"), Vocab("ilas"), Vocab(item)]
            # C++ of 3.9 and earlier says nothing once it is done.
            if self._ask([*words, *values])[:1] in (["ok"], []):
                return
        code, _ = split(self._ask([f"set{function}", Vocab("RPC"), *values]))
        if code != OK:
            raise LocalProtocolError(f'"{self.remote}" refuses {member}: {reason(code)}')

    def _ask(self, words: list[Any]) -> list[Any]:
        data = Bottle(words).to_bytes()
        if self._version is not None and self._version[1] >= 4:
            data = bytes(to_yarp4(data))
        message = self._rpc.ask(Payload(data), TIMEOUT)
        return [] if message is None else message.as_(Bottle)

    def _counted(self, member: str, values: list[Any], count: int) -> list[Any]:
        if len(values) < count:
            raise RemoteProtocolError(f'"{self.remote}" does not tell {member}')
        return values[:count]

    def _decode(self, message: Message) -> Scan:
        scan = message.as_(LaserScan2D)
        number = scan.status
        condition = CONDITIONS[number] if number in range(len(CONDITIONS)) else "error"
        angles, distances = (scan.angle_min, scan.angle_max), (scan.range_min, scan.range_max)
        if scan.scans.kind not in ("float64", "float32"):
            raise DecodeError(f'"{self.remote}" sends no distances')
        return Scan(angles, distances, scan.scans.array, condition)
