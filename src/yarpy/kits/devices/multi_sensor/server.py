"""MultiSensorServer: serve your sensors, such as an inertial unit, on YARP ports.

    <name>/measures:o   all values of all sensors, every period, with count and time
    <name>/rpc:o        the names of the sensors, for clients that ask `getMetadata`

Both list the first ten of `KINDS` in that order, or all twelve; kinds without sensors are empty
lists. C++ YARP before 3.11 refuses twelve, later versions refuse ten. Programs of YARP 4, who are
known by asking them, get twelve, with floats as it spells them.

Rules: nothing is read while nobody listens. Names and numbers of values are fixed when the server
starts. A value list is never empty, and all numbers are float64: C++ drops anything else.

Source: multipleanalogsensorsserver of YARP 3.x and 4.0.
"""

from __future__ import annotations

import threading
from collections.abc import Mapping
from contextlib import ExitStack
from typing import Any, Final

from yarpy import clock
from yarpy.data.bottle import Bottle
from yarpy.data.stamp import Stamp
from yarpy.data.yarp4 import to_yarp4
from yarpy.kits.devices.access import Access
from yarpy.kits.devices.closeable import Closeable, prefix
from yarpy.kits.devices.multi_sensor.interface import KINDS, NEWER, OLDER
from yarpy.kits.devices.multi_sensor.metadata import (
    MultipleAnalogSensorsMetadata,
    SensorMetadata,
    metadata,
)
from yarpy.kits.devices.publisher import Publisher
from yarpy.kits.devices.refusal import DeviceErrorLog, Refused
from yarpy.names.base import NameClient
from yarpy.port.dialects import Dialects
from yarpy.port.port import BufferedPort
from yarpy.port.rpc import RpcServer
from yarpy.wire.message import Encoded, Message

#: Kinds without a frame in C++.
_FRAMELESS: Final = frozenset(("contact_loads", "encoder_arrays", "skin_patches"))

_Measurement = tuple[list[float], float]


class MultiSensorServer(Closeable):
    """Serves `device` (see `devices.multi_sensor.interface`) to C++ and Python clients.

    name: prefix of the ports, for example `/robot/imu`.
    period: seconds between messages (C++ uses milliseconds).
    newer: list twelve kinds, for clients of YARP 3.11 and later, even if the device has none of the
    last two.
    names: a name client, None for the default.
    Raises AddressError (a name is in use), NoNameServer; ValueError if the device has no sensors.
    """

    def __init__(
        self,
        name: str,
        device: object,
        period: float = 0.01,
        *,
        newer: bool = False,
        names: NameClient | None = None,
    ) -> None:
        self.name = name = prefix(name)
        self.device = device
        self._sensors = Access(device, 0, DeviceErrorLog(name), threading.Lock())
        self._last: dict[str, dict[str, _Measurement]] = {}
        self._read_first()
        newer = newer or any(self._last.get(kind) for kind in [*KINDS][OLDER:])
        self._count = NEWER if newer else OLDER
        self._stamp = Stamp()
        self._opened = threading.Event()  # a client may be there before this constructor is done
        with ExitStack() as resources:
            self._rpc = resources.enter_context(RpcServer(f"{name}/rpc:o", self._tell, names=names))
            self._measures = resources.enter_context(
                BufferedPort(f"{name}/measures:o", names=names)
            )
            self._rpc.on_page(self._describe(self._count).page)
            self._readers = Dialects(self._measures)
            self._opened.set()
            self._publisher = Publisher(name, period, self._publish)
            resources.callback(self._publisher.close)
            self._resources = resources.pop_all()

    def __repr__(self) -> str:
        listed = ", ".join(f"{len(names)} {kind}" for kind, names in self._last.items())
        return f"<MultiSensorServer {self.name}, {listed}>"

    # -- reading the device -------------------------------------------------------------------

    def _read_first(self) -> None:
        now = clock.now()
        for kind in KINDS:
            if not self._sensors.has(kind):
                continue

            def check(read: Any, kind: str = kind) -> dict[str, list[float]]:
                return _readings(kind, read())

            try:
                found = self._sensors.use(kind, check)
            except Refused as error:
                raise ValueError(
                    f"{self.name}: {error.__cause__ or error}; {kind}() must return its sensors "
                    "as soon as the server starts"
                ) from error
            self._last[kind] = {name: (values, now) for name, values in found.items()}
        if not any(self._last.values()):
            raise ValueError(f"{self.name}: the device needs one of {', '.join(KINDS)}")

    def _tell(self, message: Message) -> object:
        """The answer to a question: it depends on who asks how many kinds there are."""
        self._opened.wait()
        count = self._count
        # C++ listens to the measures first.
        listener = f"{message.source.removesuffix('/rpc:i')}/measures:i"
        if count == OLDER and self._readers.is_yarp4(listener):
            count = NEWER
        return self._describe(count)(message)

    def _describe(self, count: int) -> MultipleAnalogSensorsMetadata:
        frames: Mapping[str, str] = {}
        if self._sensors.has("frames"):
            frames = self._sensors.ask("frames")
        listed = {}
        for kind in [*KINDS][:count]:
            names = [*self._last.get(kind, ())]
            usual = {name: "" if kind in _FRAMELESS else name for name in names}
            listed[kind] = [
                SensorMetadata(name, str(frames.get(name, usual[name]))) for name in names
            ]
        return metadata(listed, count == NEWER)

    def _times(self) -> Mapping[str, float]:
        """Return the times when sensors were read, for those of which the device says so."""
        try:
            found = self._sensors.ask("timestamps")
        except Refused:
            return {}
        return found if isinstance(found, Mapping) else {}

    def _read(self) -> None:
        """Read all sensors, then ask for the times."""
        fresh: dict[str, tuple[dict[str, list[float]], float]] = {}
        for kind, last in self._last.items():

            def check(read: Any, kind: str = kind, last: Any = last) -> dict[str, list[float]]:
                found = _readings(kind, read())
                before = {name: len(values) for name, (values, _) in last.items()}
                if {name: len(values) for name, values in found.items()} != before:
                    raise ValueError("the sensors or their numbers of values have changed")
                return found

            try:
                fresh[kind] = self._sensors.use(kind, check), clock.now()
            except Refused:
                continue  # logged; the last values remain, with their time
        times = self._times()
        for kind, (found, now) in fresh.items():
            for name, values in found.items():
                self._last[kind][name] = values, float(times.get(name, now))

    # -- ports --------------------------------------------------------------------------------

    def _publish(self) -> None:
        if not self._readers:
            return
        self._read()
        self._stamp = self._stamp.next(clock.now())
        self._readers.write(
            lambda: self._message(self._count),
            lambda: Encoded(to_yarp4(self._message(NEWER).to_bytes())),
            self._stamp,
        )

    def _message(self, count: int) -> Bottle:
        message = Bottle()
        for kind in [*KINDS][:count]:
            sensors = self._last.get(kind, {}).values()
            message.append(Bottle(Bottle([Bottle(values), at]) for values, at in sensors))
        return message


def _readings(kind: str, found: Any) -> dict[str, list[float]]:
    """A method's result, checked. Raises TypeError, ValueError."""
    if not isinstance(found, Mapping):
        raise TypeError(
            f"{kind}() must return a dict (sensor name -> values), not {type(found).__name__}"
        )
    checked = {}
    for name, values in found.items():
        numbers = [float(value) for value in (values if hasattr(values, "__len__") else [values])]
        if not numbers or (KINDS[kind] and len(numbers) != KINDS[kind]):
            raise ValueError(
                f"{kind}: {name} has {len(numbers)} values, not {KINDS[kind] or 'any'}"
            )
        checked[str(name)] = numbers
    return checked
