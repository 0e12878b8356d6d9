"""AnalogSensorServer: serve a sensor with channels on YARP ports, as older robots do.

    <name>          its values, a Vector, every period
    <name>/rpc:i    [iana] [cal], [iana] [cal] 1.5 2.5, [iana] [calc] 0, [iana] [calc] 0 1.5

Rules: nothing is read while nobody listens. Answers are a number: 0 when it is done, 1 when not.
With `parts` there are such ports for each part of the channels, <name>/<part>. Readers of YARP 4
get vectors as it spells them. C++ clients send the values of a calibration in a list of their own,
which C++ servers do not read; here both forms count.

Source: analogServer of YARP 3.x (AnalogWrapper).
"""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from functools import partial
from typing import TYPE_CHECKING, Any

from yarpy import clock
from yarpy.data.bottle import Bottle
from yarpy.data.sig.vector import Vector
from yarpy.data.stamp import Stamp
from yarpy.data.value import Vocab
from yarpy.data.yarp4 import to_yarp4
from yarpy.errors import DecodeError
from yarpy.kits.devices.access import Access
from yarpy.kits.devices.closeable import Closeable, prefix
from yarpy.kits.devices.kind import items, number, whole, word
from yarpy.kits.devices.publisher import Publisher
from yarpy.kits.devices.refusal import DeviceErrorLog, Refused
from yarpy.log import logger
from yarpy.names.base import NameClient
from yarpy.port.dialects import Dialects
from yarpy.port.port import BufferedPort
from yarpy.port.rpc import RpcServer
from yarpy.wire.message import Encoded, Message

if TYPE_CHECKING:
    from numpy.typing import NDArray

log = logger("yarpy.devices")


class AnalogSensorServer(Closeable):
    """Serves `device` (see `devices.analog.interface`) to C++ and Python clients.

    name: the port of the values, for example `/robot/left_arm/analog:o`.
    period: seconds between messages.
    parts: the channels of each part, by its name; without any, one port has them all.
    names: a name client, None for the default.
    Raises AddressError (a name is in use), NoNameServer; ValueError if the device has no
    channels().
    """

    def __init__(
        self,
        name: str,
        device: object,
        period: float = 0.02,
        *,
        parts: Mapping[str, range] | None = None,
        names: NameClient | None = None,
    ) -> None:
        self.name = name = prefix(name)
        self.device = device
        self._sensor = Access(device, 0, DeviceErrorLog(name), threading.Lock())
        if not self._sensor.has("channels"):
            raise ValueError(f"{name}: the device needs channels(), a number for each")
        self._stamp = Stamp()
        self._readers: list[tuple[Dialects, range | None]] = []
        with ExitStack() as resources:
            wanted: Mapping[str, range | None] = parts or {"": None}
            for part, channels in wanted.items():
                called = f"{name}/{part}" if part else name
                answer = RpcServer(f"{called}/rpc:i", self._answer, names=names)
                resources.enter_context(answer)
                port = resources.enter_context(BufferedPort(called, names=names))
                self._readers.append((Dialects(port), channels))
            publisher = Publisher(name, period, self._publish)
            resources.callback(publisher.close)
            self._resources = resources.pop_all()

    def __repr__(self) -> str:
        return f"<AnalogSensorServer {self.name}>"

    def _answer(self, message: Message) -> object:
        try:
            request = message.as_(Bottle)
        except DecodeError:
            return Bottle([Vocab("fail")])
        asked = [word(each) for each in request[:2]]
        if asked not in (["iana", "cal"], ["iana", "calc"]):
            return Bottle([Vocab("fail")])
        try:
            given: Sequence[Any] = request[2:]
            if asked[1] == "calc":
                if len(given) not in (1, 2):
                    raise Refused("a calibration needs a channel, and may have a value")
                value = number(given[1]) if len(given) == 2 else None
                self._sensor.ask("calibrate_channel", whole(given[0]), value)
            else:
                given = items(given[0]) if len(given) == 1 and isinstance(given[0], list) else given
                self._sensor.ask("calibrate", [number(each) for each in given] or None)
        except Refused as refusal:
            log.info("%s: %s", self.name, refusal)
            return Bottle([1])
        return Bottle([0])

    def _publish(self) -> None:
        listening = [(readers, channels) for readers, channels in self._readers if readers]
        if not listening:
            return
        values = self._sensor.use("channels", _numbers)
        self._stamp = self._stamp.next(clock.now())
        for readers, channels in listening:
            if channels is not None and channels.stop > len(values):
                raise Refused(f"there are {len(values)} channels, not {channels.stop}")
            mine = values if channels is None else values[channels.start : channels.stop]
            data = b"".join(bytes(each) for each in Vector(mine).to_wire())
            older, newer = partial(Encoded, data), partial(_newer, data)
            readers.write(older, newer, self._stamp)


def _newer(data: bytes) -> Encoded:
    """Return a vector as YARP 4 spells it."""
    return Encoded(to_yarp4(data))


def _numbers(found: Any) -> NDArray[Any]:
    """Return the values of all channels. Raises ValueError, TypeError."""
    import numpy as np

    return np.array(found() if callable(found) else found, "<f8").ravel()
