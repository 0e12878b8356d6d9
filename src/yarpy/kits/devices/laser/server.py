"""LaserServer: serve your laser scanner on YARP ports.

    <name>          its scans, every period
    <name>/rpc:i    [get] [ilas] [lsdr] of YARP 3.9 and earlier, getDistanceRange_RPC of later ones

Rules: nothing is read while nobody listens. Readers of YARP 4 get scans as it spells them. What
cannot be done is answered with `[fail]`, or with a status, and the log says why.

Source: rangefinder2D_nws_yarp of YARP 3.x and 4.0.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from typing import Any, Final

from yarpy import clock
from yarpy.data.bottle import Bottle
from yarpy.data.sig.vector import Vector
from yarpy.data.stamp import Stamp
from yarpy.data.value import Vocab
from yarpy.data.yarp4 import to_yarp4
from yarpy.errors import DecodeError
from yarpy.kits.devices.access import Access
from yarpy.kits.devices.closeable import Closeable, prefix
from yarpy.kits.devices.declared import Status
from yarpy.kits.devices.kind import number, word
from yarpy.kits.devices.laser.functions import (
    Condition,
    Info,
    IRangefinder2DMsgs,
    LaserScan2D,
    Limits,
    Number,
)
from yarpy.kits.devices.laser.interface import CONDITIONS
from yarpy.kits.devices.publisher import Publisher
from yarpy.kits.devices.refusal import DeviceErrorLog, Refused
from yarpy.kits.devices.service import DeviceService
from yarpy.kits.devices.status import FAILED, OK
from yarpy.log import logger
from yarpy.names.base import NameClient
from yarpy.port.dialects import Dialects
from yarpy.port.port import BufferedPort
from yarpy.port.rpc import RpcServer
from yarpy.wire.message import Encoded, Message

log = logger("yarpy.devices")

#: Words of YARP 3.9 and earlier -> members.
WORDS: Final = {
    "lsdr": "distances",
    "lsar": "angles",
    "lsas": "step",
    "lssr": "rate",
    "lsnf": "info",
}
#: Members that are two numbers.
_PAIRS: Final = ("distances", "angles")


class LaserServer(Closeable):
    """Serves `device` (see `devices.laser.interface`) to C++ and Python clients.

    name: the port of the scans, for example `/robot/laser`.
    period: seconds between scans.
    names: a name client, None for the default.
    Raises AddressError (a name is in use), NoNameServer; ValueError if the device has no ranges().
    """

    def __init__(
        self, name: str, device: object, period: float = 0.1, *, names: NameClient | None = None
    ) -> None:
        self.name = name = prefix(name)
        self.device = device
        self._laser = Access(device, 0, DeviceErrorLog(name), threading.Lock())
        if not self._laser.has("ranges"):
            raise ValueError(f"{name}: the device needs ranges(), in metres")
        self._functions = Functions(self.read, self.change, name)
        self._stamp = Stamp()
        self._count = 0  # of the ranges in the last scan
        with ExitStack() as resources:
            resources.enter_context(RpcServer(f"{name}/rpc:i", self._answer, names=names))
            scans = resources.enter_context(BufferedPort(name, names=names))
            self._readers = Dialects(scans)
            publisher = Publisher(name, period, self._publish)
            resources.callback(publisher.close)
            self._resources = resources.pop_all()

    def __repr__(self) -> str:
        return f"<LaserServer {self.name}>"

    def read(self, member: str) -> Any:
        """A member of the device, or what stands in for it. Raises Refused."""
        if self._laser.has(member):
            found = self._laser.ask(member)
            if member in _PAIRS:
                low, high = found
                return float(low), float(high)
            return str(found) if member in ("info", "condition") else float(found)
        if member == "step":
            low, high = self.read("angles")
            return (high - low) / max(self._count or len(self._laser.ask("ranges")), 1)
        defaults = {"angles": (0.0, 360.0), "distances": (0.0, 100.0), "info": "a laser"}
        defaults["condition"] = "in use"
        if member not in defaults:
            raise Refused(f"the device has no {member}")
        return defaults[member]

    def change(self, member: str, values: Sequence[Any]) -> None:
        """Change a setting. Raises Refused."""
        numbers = [number(value) for value in values]
        if len(numbers) != (2 if member in _PAIRS else 1):
            raise Refused(f"{len(numbers)} numbers for {member}")
        self._laser.store(member, tuple(numbers) if member in _PAIRS else numbers[0])

    def _answer(self, message: Message) -> object:
        try:
            request = message.as_(Bottle)
        except DecodeError:
            return Bottle([Vocab("fail")])
        verb, group, item = [*map(word, request[:3]), "", "", ""][:3]
        if group != "ilas":
            source = message.source
            # C++ listens to the scans first, and asks for the version later than for the angles.
            listener = source.removesuffix("/rpc:o")
            if not self._functions.knows(source) and self._readers.is_yarp4(listener):
                self._functions.speaks_yarp4(source)
            return self._functions(message)
        try:
            member = WORDS.get(item, "")
            if verb == "set" and member != "info" and member:
                self.change(member, request[3:])
                return Bottle([Vocab("ok")])
            if verb != "get" or not member:
                raise Refused(f"there are get and set of {', '.join(WORDS)}")
            found = self.read(member)
            values = found if member in _PAIRS else (found,)
            return Bottle([Vocab("is"), Vocab(item), *values])
        except Refused as refusal:
            log.info("%s: %s", self.name, refusal)
            return Bottle([Vocab("fail")])

    def _publish(self) -> None:
        if not self._readers:
            return
        import numpy as np

        ranges = self._laser.use("ranges", lambda found: np.array(found(), "<f8").ravel())
        self._count = len(ranges)
        (first, last), (near, far) = self.read("angles"), self.read("distances")
        condition = self.read("condition")
        if condition not in CONDITIONS:
            raise Refused(f"condition() is one of {', '.join(CONDITIONS)}, not {condition!r}")
        scan = LaserScan2D(first, last, near, far, Vector(ranges), CONDITIONS.index(condition))
        self._stamp = self._stamp.next(clock.now())
        data = scan.to_wire()[0]
        self._readers.write(lambda: Encoded(data), lambda: Encoded(to_yarp4(data)), self._stamp)


class Functions(IRangefinder2DMsgs, DeviceService):
    """The functions that programs of YARP 3.10 and later call. Those of 4.0 also ask for the
    version."""

    def __init__(
        self,
        read: Callable[[str], Any],
        change: Callable[[str, Sequence[float]], None],
        name: str,
    ) -> None:
        self._read = read
        self._change = change
        self._name = name

    def _told(self, make: Any, member: str, spread: Callable[[Any], tuple[Any, ...]]) -> Any:
        try:
            return make(Status(OK), *spread(self._read(member)))
        except Refused as refusal:
            log.info("%s: %s", self._name, refusal)
            return make(Status(FAILED))

    def _set(self, member: str, *values: float) -> Status:
        try:
            self._change(member, values)
        except Refused as refusal:
            log.info("%s: %s", self._name, refusal)
            return Status(FAILED)
        return Status(OK)

    def getDeviceStatus_RPC(self) -> Condition:
        """Return the condition of the laser."""
        found: Condition = self._told(
            Condition, "condition", lambda word: (Vocab.from_code(CONDITIONS.index(word)),)
        )
        return found

    def getDistanceRange_RPC(self) -> Limits:
        """Return the distances that it can measure."""
        found: Limits = self._told(Limits, "distances", tuple)
        return found

    def getScanLimits_RPC(self) -> Limits:
        """The first angle and the last."""
        found: Limits = self._told(Limits, "angles", tuple)
        return found

    def getHorizontalResolution_RPC(self) -> Number:
        """Degrees between two ranges."""
        found: Number = self._told(Number, "step", lambda value: (value,))
        return found

    def getScanRate_RPC(self) -> Number:
        """Turns per second."""
        found: Number = self._told(Number, "rate", lambda value: (value,))
        return found

    def getDeviceInfo_RPC(self) -> Info:
        """Return the description of the laser, for people."""
        found: Info = self._told(Info, "info", lambda value: (value,))
        return found

    def setDistanceRange_RPC(self, low: float, high: float) -> Status:
        """Measure within these."""
        return self._set("distances", low, high)

    def setScanLimits_RPC(self, low: float, high: float) -> Status:
        """Measure between these angles."""
        return self._set("angles", low, high)

    def setHorizontalResolution_RPC(self, step: float) -> Status:
        """Degrees between two ranges."""
        return self._set("step", step)

    def setScanRate_RPC(self, rate: float) -> Status:
        """Turns per second."""
        return self._set("rate", rate)
